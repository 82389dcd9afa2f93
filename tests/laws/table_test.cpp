// Tables: their stated error against the real one, its order, the force against the energy, ends, packs, files.
#include "energy_change.hpp"

#include <boltzmann/boltzmann.hpp>

#include <gtest/gtest.h>
#include <unistd.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <random>
#include <string>
#include <vector>

namespace boltzmann::table_test {
namespace {

double lennard_jones(double r) { return std::pow(r, -12) - 2 * std::pow(r, -6); }
double lennard_jones_slope(double r) { return -12 * (std::pow(r, -13) - std::pow(r, -7)); }
double yukawa(double r) { return 5 * std::exp(-1.3 * r) / r; }
double yukawa_slope(double r) { return -yukawa(r) * (1.3 + 1 / r); }
double harmonic(double r) { return 1.5 * (r - 1) * (r - 1); }
double harmonic_slope(double r) { return 3 * (r - 1); }

struct Known {
  double (*energy)(double);
  double (*slope)(double);
  double first, last;
};
Known const known[] = {
    {lennard_jones, lennard_jones_slope, 0.7, 3}, {yukawa, yukawa_slope, 0.1, 6}, {harmonic, harmonic_slope, 0.5, 2}};

/// The real errors at random distances, with the derivatives by hand.
TableError real_error(Table const& table, Known const& law, double from, double to, int trials = 100000) {
  std::mt19937_64 random(test_seed(3));
  std::uniform_real_distribution<double> uniform(from, to);
  TableError worst;
  for (int trial = 0; trial < trials; ++trial) {
    double const r = uniform(random);
    auto const value = table.at(r * r);
    worst.energy = std::max(worst.energy, std::fabs(value.energy - law.energy(r)));
    worst.force = std::max(worst.force, std::fabs(2 * r * value.slope - law.slope(r)));
  }
  return worst;
}

TEST(Table, StatesAnErrorThatIsNotExceeded) {
  for (auto const& law : known)
    for (std::size_t const fineness : {16, 64, 256}) {
      Table const table(law.energy, law.first, law.last, PerOctave{fineness});
      auto const real = real_error(table, law, law.first, law.last), stated = table.error();
      EXPECT_LE(real.energy, stated.energy);
      EXPECT_LE(real.force, stated.force);
      EXPECT_LT(stated.energy, 3 * real.energy) << "and it is not far above";
      EXPECT_LT(stated.force, 3 * real.force);
    }
}

TEST(Table, ConvergesWithFourthOrder) {
  for (auto const& law : known) {
    auto const error = [&](std::size_t fineness) {
      return real_error(Table(law.energy, law.first, law.last, PerOctave{fineness}), law, law.first, law.last);
    };
    auto const coarse = error(64), fine = error(256);
    EXPECT_NEAR(std::log2(coarse.energy / fine.energy) / 2, 4, 0.3);
    EXPECT_NEAR(std::log2(coarse.force / fine.force) / 2, 3, 0.3);
  }
}

TEST(Table, KeepsTheToleranceThatIsAskedFor) {
  for (auto const& law : known)
    for (double const tolerance : {1e-3, 1e-5, 1e-7}) {
      Table const table(law.energy, law.first, law.last, Tolerance{tolerance});
      EXPECT_LE(table.error().relative, tolerance);
      EXPECT_GT(table.error().relative, tolerance / 1000) << table.intervals() << " intervals are too many";
    }
  // Relative to the law where it is strong.
  Table const table(lennard_jones, 0.7, 3, Tolerance{1e-5});
  for (double r = 0.7; r < 0.9; r += 0.0013) {
    EXPECT_NEAR(table.at(r * r).energy, lennard_jones(r), 1e-5 * (std::fabs(lennard_jones(r)) + 1));
    EXPECT_NEAR(2 * r * table.at(r * r).slope, lennard_jones_slope(r), 1e-5 * (std::fabs(lennard_jones_slope(r)) + 1));
  }
}

TEST(Table, TheForceIsTheDerivativeOfItsOwnEnergy) {
  // However coarse the table is: across knots, ends and octaves.
  Table const table(lennard_jones, 0.8, 3, PerOctave{4});
  for (double r = 0.3; r < 3.3; r += 0.00517) {
    if (std::fabs(r - 3) < 1e-3) continue;  // the force ends there
    double const h = 1e-5, slope = (table.at((r + h) * (r + h)).energy - table.at((r - h) * (r - h)).energy) / (2 * h);
    EXPECT_NEAR(2 * r * table.at(r * r).slope, slope, 1e-6 * (1 + std::fabs(slope))) << r;
  }
}

template <int D>
void expect_it_is_the_law() {
  Table const table([](double r) { return 1.3 * lennard_jones(r / 1.1); }, 0.5, 4, Tolerance{1e-7});
  LennardJones const by_hand{1.3, 1.1};
  std::mt19937_64 random(test_seed(7));
  std::uniform_real_distribution<double> uniform(-2, 2);
  for (int trial = 0; trial < 200; ++trial) {
    Newton<D> p{}, q{};
    for (int k = 0; k < D; ++k) q.position[k] = uniform(random);
    if (magnitude(q.position) < 0.8) continue;
    auto const here = table(p, q), there = by_hand(p, q), back = table(q, p);
    EXPECT_NEAR(here.energy, there.energy, 1e-6 * (1 + std::fabs(there.energy)));
    for (int k = 0; k < D; ++k) {
      EXPECT_NEAR(here.force[k], there.force[k], 1e-6 * (1 + magnitude(there.force)));
      EXPECT_EQ(here.force[k], -back.force[k]);
    }
  }
}
TEST(Table, IsALawIn1D2D3D) {
  expect_it_is_the_law<1>();
  expect_it_is_the_law<2>();
  expect_it_is_the_law<3>();
}

template <int W>
void expect_packs_are_scalars() {
  Table const table(lennard_jones, 0.7, 3, PerOctave{64});
  std::mt19937_64 random(test_seed(11));
  std::uniform_real_distribution<double> uniform(-0.1, 12);
  double const odd[] = {0, 0.49, 9, 9.0000001, 1e300, std::numeric_limits<double>::quiet_NaN()};
  for (int trial = 0; trial < 2000; ++trial) {
    Pack<double, W> square;
    for (int lane = 0; lane < W; ++lane) square.native[lane] = uniform(random);
    if (trial < 6) square.native[trial % W] = odd[trial];
    auto const value = table.at(square);
    for (int lane = 0; lane < W; ++lane) {
      auto const expected = table.at(square[lane]);
      if (std::isnan(square[lane])) continue;  // it must only not read anything else
      EXPECT_NEAR(value.energy[lane], expected.energy, 1e-13 * (1 + std::fabs(expected.energy)));
      EXPECT_NEAR(value.slope[lane], expected.slope, 1e-13 * (1 + std::fabs(expected.slope)));
    }
  }
}
TEST(Table, PacksAreScalars) {
  expect_packs_are_scalars<2>();
  expect_packs_are_scalars<4>();
  expect_packs_are_scalars<8>();
}

TEST(Table, BeyondItsEnds) {
  Table const table(lennard_jones, 0.8, 3, Tolerance{1e-6});
  // Nearer: a straight line in r^2.
  double const edge = 0.64, slope = lennard_jones_slope(0.8) / 1.6;
  for (double const square : {0.0, 0.1, 0.5}) {
    EXPECT_NEAR(table.at(square).slope, slope, 1e-4 * std::fabs(slope));
    EXPECT_NEAR(table.at(square).energy, lennard_jones(0.8) + slope * (square - edge), 1e-4 * std::fabs(slope));
  }
  Newton<3> p{};
  EXPECT_EQ(table(p, p).force, (Vector{0.0, 0.0, 0.0}));
  EXPECT_TRUE(std::isfinite(table(p, p).energy));
  // Farther: nothing.
  for (double const square : {9.01, 100.0, 1e300, __builtin_inf()}) {
    EXPECT_EQ(table.at(square).slope, 0);
    EXPECT_NEAR(table.at(square).energy, lennard_jones(3), 1e-12);
  }
}

TEST(Table, FromZero) {
  Table const table([](double r) { return std::exp(-r * r); }, 0, 3, Tolerance{1e-6});
  for (double r = 0; r < 3; r += 0.01) {
    EXPECT_NEAR(table.at(r * r).energy, std::exp(-r * r), 1e-6);
    EXPECT_NEAR(table.at(r * r).slope, -std::exp(-r * r), 2e-6 / std::max(r, 0.1));
  }
}

TEST(Table, ASplineThroughPointsReproducesACubic) {
  auto const cubic = [](double r) { return 2 - r + 0.5 * r * r - 0.3 * r * r * r; };
  std::vector<TablePoint> points;
  for (double const r : {0.5, 0.7, 1.2, 1.3, 2.0, 2.9}) points.push_back({r, cubic(r)});
  auto const slope = [](double r) { return -1 + r - 0.9 * r * r; };
  Table const clamped(points, {slope(0.5), slope(2.9)}, Tolerance{1e-7});
  Table const natural(points, {}, Tolerance{1e-6});
  for (double r = 0.5; r < 2.9; r += 0.01) EXPECT_NEAR(clamped.at(r * r).energy, cubic(r), 1e-6);
  EXPECT_GT(std::fabs(natural.at(2.5 * 2.5).energy - cubic(2.5)), 1e-3) << "it ends without curvature";
  for (auto const& point : points) EXPECT_NEAR(natural.at(point.distance * point.distance).energy, point.energy, 2e-6);
  // Two points: a straight line.
  Table const line(std::array<TablePoint, 2>{{{1, 5}, {3, 1}}}, {}, Tolerance{1e-7});
  EXPECT_NEAR(line.at(4.0).energy, 3, 1e-6);
  EXPECT_NEAR(2 * 2 * line.at(4.0).slope, -2, 1e-6);
}

TEST(Table, CopiesShareTheirNumbers) {
  Table const table(lennard_jones, 0.7, 3, PerOctave{1024});
  Table const copy = table;  // NOLINT: it is what is tested
  EXPECT_LE(sizeof(Table), 64U);
  EXPECT_EQ(copy.at(1.1).energy, table.at(1.1).energy);
  EXPECT_EQ(copy.intervals(), table.intervals());
  EXPECT_EQ(length_scale_of(copy), 0.7);
}

TEST(Table, RefusesWhatItCantBe) {
  auto const line = [](auto const& make) { return message([&] { make(); }); };
  EXPECT_EQ(line([] { Table(lennard_jones, 2, 1, Tolerance{1e-5}); }),
            "table: from distance 2 to 1; the first must be zero or positive, the last above it");
  EXPECT_EQ(line([] { Table(yukawa, 0, 1, Tolerance{1e-5}); }), "table: the energy at distance 0 is inf");
  EXPECT_EQ(line([] { Table(lennard_jones, 0.5, 1, Tolerance{-1}); }), "table: tolerance -1 must be positive");
  EXPECT_EQ(line([] { Table(lennard_jones, 0.5, 1, PerOctave{100}); }),
            "table: 100 intervals per octave; powers of two from 4 to 65536 are allowed");
  EXPECT_NE(line([] { Table(lennard_jones, 0.5, 1, Tolerance{1e-15}); }).find("still have the relative error"),
            std::string::npos);
  EXPECT_EQ(line([] { Table(std::array<TablePoint, 1>{{{1, 5}}}); }), "table: 1 points; at least 2 are needed");
  EXPECT_EQ(line([] {
              Table(std::array<TablePoint, 2>{{{1, 5}, {1, 4}}});
            }),
            "table: the distance 1 of point 1 must be above 1, the one before");
  EXPECT_EQ(line([] {
              Table(std::array<TablePoint, 2>{{{1, 5}, {2, __builtin_nan("")}}});
            }),
            "table: point 1 (2, nan) must be finite, its distance zero or positive");
}

class TableFile : public testing::Test {
 protected:
  std::string const path_ =
      (std::filesystem::temp_directory_path() / ("boltzmann-table-" + std::to_string(getpid()))).string();
  void write(std::string const& text) const { std::ofstream(path_) << text; }
  std::string complaint() const {
    auto const text = message([&] { Table::from_file(path_); });
    return text.starts_with(path_) ? text.substr(path_.size()) : text;
  }
  void TearDown() override { std::remove(path_.c_str()); }
};

TEST_F(TableFile, IsRead) {
  std::string text = "# r  U\n\n";
  for (int k = 0; k <= 300; ++k) {
    double const r = 0.8 + 0.01 * k;
    char line[100];
    std::snprintf(line, sizeof line, "  %.17g\t%+.17e # point %d\r\n", r, lennard_jones(r), k);
    text += line;
  }
  write(text);
  auto const table = Table::from_file(path_, {lennard_jones_slope(0.8), lennard_jones_slope(3.8)});
  EXPECT_DOUBLE_EQ(table.first(), 0.8);
  EXPECT_DOUBLE_EQ(table.last(), 3.8);
  for (double r = 0.81; r < 3.8; r += 0.0037) EXPECT_NEAR(table.at(r * r).energy, lennard_jones(r), 1e-4);
}

TEST_F(TableFile, EveryMistakeIsOneLine) {
  EXPECT_EQ(complaint(), ": can't open the file");
  write("1 2\n1.5 two\n");
  EXPECT_EQ(complaint(), ":2: 'two' is not a finite number");
  write("1 2\n1.5 nan\n");
  EXPECT_EQ(complaint(), ":2: 'nan' is not a finite number");
  write("1 2 3\n");
  EXPECT_EQ(complaint(), ":1: 3 numbers; a line has two, a distance and an energy");
  write("# only this\n1\n");
  EXPECT_EQ(complaint(), ":2: 1 numbers; a line has two, a distance and an energy");
  write("1 2\n2 1\n1.5 0\n");
  EXPECT_EQ(complaint(), ":3: the distance 1.5 must be above 2, the one before");
  write("-1 2\n");
  EXPECT_EQ(complaint(), ":1: the distance -1 is negative");
  write("# nothing\n");
  EXPECT_EQ(complaint(), ": 0 points; a table needs at least 2");
}

TEST(Table, RunsConserveEnergy) {
  // A coarse table too: its force is the derivative of its own energy.
  Ensemble<Newton<3>> atoms("atoms", 125);
  for (std::size_t const fineness : {8, 512}) {
    block_load(atoms, {Lattice::square, 1.2, {5, 5, 5}});
    maxwellian_load(atoms, {.temperature = 0.5, .seed = test_seed(1)});
    PairScheme space(Box(Vector{-1.0, -1.0, -1.0}, Vector{7.0, 7.0, 7.0}, Boundary::reflecting), 3);
    space.internal(atoms, Table(lennard_jones, 0.6, 3, PerOctave{fineness}));
    Simulation simulation(space, 0.002);
    simulation.integrate(atoms, Method::leap_frog);
    EXPECT_NEAR(energy_change(simulation, atoms, 300), 0, 2e-3);
  }
}

}  // namespace
}  // namespace boltzmann::table_test
