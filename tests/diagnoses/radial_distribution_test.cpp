// Radial distributions and structure factors: particles that know nothing of each other, and perfect lattices.
#include <boltzmann/core/random.hpp>
#include <boltzmann/diagnoses/radial_distribution.hpp>
#include <boltzmann/diagnoses/statistics.hpp>
#include <boltzmann/diagnoses/structure_factor.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/diagnoses/look.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <array>
#include <cmath>
#include <numbers>
#include <random>
#include <vector>

namespace boltzmann::radial_distribution_test {
namespace {

using Names = std::vector<std::string>;

using test::look;

template <int D>
void place_anywhere(Ensemble<Newton<D>>& particles, Box const& box, std::mt19937_64& random) {
  for (auto& p : particles)
    for (int a = 0; a < D; ++a) p.position[a] = std::uniform_real_distribution(box.low(a), box.high(a))(random);
}

// An ideal gas has g = 1 at every distance, whatever its boundaries: also where half of a shell is beyond a wall.
template <int D>
void expect_one(std::array<Boundary, D> const& boundaries, double reach) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) low[a] = -1.0 - a, high[a] = 1.0 + 0.5 * a;
  Box const box(low, high, boundaries);
  std::mt19937_64 random(test_seed(17 + D));
  Ensemble<Newton<D>> one("one", 15), two("two", 12);
  constexpr std::size_t bins = 8, batches = 60;
  std::array<std::vector<double>, 3 * bins> g;
  for (std::size_t batch = 0; batch < batches; ++batch) {
    RadialDistribution all({&one, &two}, {.to = reach, .count = bins}),
        within({&one, &two}, {.ensembles = {"one"}, .to = reach, .count = bins}),
        between({&one, &two}, {.ensembles = {"one", "two"}, .to = reach, .count = bins});
    for (int n = 0; n < 60; ++n) {
      place_anywhere(one, box, random);
      place_anywhere(two, box, random);
      for (auto* diagnosis : {&all, &within, &between}) look(*diagnosis, {&one, &two}, box);
    }
    std::size_t k = 0;
    for (auto* diagnosis : {&all, &within, &between})
      for (double const x : diagnosis->g()) g[k++].push_back(x);
  }
  for (std::size_t k = 0; k < g.size(); ++k) {
    auto const mean = mean_with_error(g[k]);
    EXPECT_NEAR(mean.mean, 1, 5.5 * mean.error) << D << "D, bin " << k;
    EXPECT_LT(mean.error, k % bins < 3 ? 0.2 : 0.035) << D << "D, bin " << k;
  }
}

TEST(RadialDistribution, OfAnIdealGasIsOneBetweenAllBoundaries) {
  using enum Boundary;
  expect_one<1>({periodic}, 1.0);
  expect_one<1>({reflecting}, 2.0);
  expect_one<2>({periodic, periodic}, 1.0);
  expect_one<2>({mirror, periodic}, 1.7);
  expect_one<2>({reflecting, mirror}, 2.0);
  expect_one<3>({periodic, periodic, periodic}, 1.0);
  expect_one<3>({reflecting, periodic, periodic}, 1.75);
  expect_one<3>({reflecting, periodic, mirror}, 1.75);
  expect_one<3>({reflecting, reflecting, reflecting}, 2.0);
}

/// The running coordination number at a distance.
double partners_within(RadialDistribution const& diagnosis, double distance) {
  auto const r = diagnosis.distances(), n = diagnosis.coordination();
  for (std::size_t k = 0; k < r.size(); ++k)
    if (r[k] >= distance) return n[k];
  return std::nan("");
}

TEST(RadialDistribution, OfLatticesHasTheirShells) {
  {
    Ensemble<Newton<3>> atoms("atoms");
    block_load(atoms, {Lattice::fcc, std::sqrt(0.5), {6, 6, 6}});
    ASSERT_EQ(atoms.size(), 864U);
    Box const box(Vector{0.0, 0.0, 0.0}, Vector{6.0, 6.0, 6.0}, Boundary::periodic);
    box.wrap(atoms);
    for (double const reach : {3.0, 1.25}) {  // by all pairs and by cells
      RadialDistribution diagnosis({&atoms}, {.to = reach, .count = 300});
      look(diagnosis, {&atoms}, box);
      EXPECT_NEAR(partners_within(diagnosis, 0.85), 12, 1e-9);
      EXPECT_NEAR(partners_within(diagnosis, 1.1), 18, 1e-9);
      EXPECT_NEAR(partners_within(diagnosis, 1.24), 42, 1e-9);
      if (reach > 2) {
        EXPECT_NEAR(partners_within(diagnosis, 1.5), 54, 1e-9);
      }
    }
  }
  {
    Ensemble<Newton<2>> sodium("sodium"), chloride("chloride");  // a plane of rock salt
    for (int x = 0; x < 10; ++x)
      for (int y = 0; y < 10; ++y) {
        Newton<2> ion{};
        ion.position = {x + 0.5, y + 0.5};
        ((x + y) % 2 == 0 ? sodium : chloride).add(ion);
      }
    Box const box(Vector{0.0, 0.0}, Vector{10.0, 10.0}, Boundary::periodic);
    RadialDistribution like({&sodium, &chloride}, {.ensembles = {"sodium"}}),
        unlike({&sodium, &chloride}, {.ensembles = {"sodium", "chloride"}});
    look(like, {&sodium, &chloride}, box);
    look(unlike, {&sodium, &chloride}, box);
    EXPECT_NEAR(partners_within(like, 1.2), 0, 1e-9);
    EXPECT_NEAR(partners_within(like, 1.7), 4, 1e-9);
    EXPECT_NEAR(partners_within(unlike, 1.2), 4, 1e-9);
    EXPECT_NEAR(partners_within(unlike, 2.6), 12, 1e-9);  // sqrt(5)
    EXPECT_EQ(unlike.columns()[0].name, "sodium chloride g peak");
    EXPECT_EQ(unlike.tables()[0].name, "radial-distribution-sodium-chloride");
  }
  {
    Ensemble<Newton<1>> chain("chain", 20);
    for (std::size_t i = 0; i < 20; ++i) chain[i].position = {0.25 + 0.5 * static_cast<double>(i)};
    Box const box(Vector{0.0}, Vector{10.0}, Boundary::periodic), tube(Vector{0.0}, Vector{10.0}, Boundary::reflecting);
    RadialDistribution ring({&chain}, {}), line({&chain}, {});
    auto const peak = look(ring, {&chain}, box);
    look(line, {&chain}, tube);
    EXPECT_NEAR(partners_within(ring, 0.7), 2, 1e-9);
    EXPECT_NEAR(partners_within(ring, 1.2), 4, 1e-9);
    EXPECT_NEAR(partners_within(line, 0.7), 2 * 19.0 / 20, 1e-9);  // both ends have one
    EXPECT_NEAR(std::fmod(peak[1] + 0.25, 0.5), 0.25, 0.03);
  }
}

// The virial theorem by g(r): the sum over pairs of r F(r) is that over the bins.
TEST(RadialDistribution, CountsPairsOnceInAnyNumberOfThreads) {
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{4.0, 5.0, 6.0},
                {Boundary::periodic, Boundary::reflecting, Boundary::periodic});
  Ensemble<Newton<3>> atoms("atoms", 700);
  std::mt19937_64 random(test_seed(3));
  place_anywhere(atoms, box, random);
  for (double const reach : {0.6, 2.0}) {
    std::vector<double> plain(20, 0.0);
    for (std::size_t i = 0; i < atoms.size(); ++i)
      for (std::size_t j = 0; j < i; ++j) {
        double d[3];
        for (int a = 0; a < 3; ++a) d[a] = atoms[i].position[a] - atoms[j].position[a];
        box.nearest_image(d);
        double const r = std::sqrt(d[0] * d[0] + d[1] * d[1] + d[2] * d[2]);
        if (r < reach) ++plain[static_cast<std::size_t>(r / reach * 20)];
      }
    std::vector<double> first;
    for (int const threads : {1, 2, 3}) {
      RadialDistribution diagnosis({&atoms}, {.to = reach, .count = 20});
      look(diagnosis, {&atoms}, box, threads);
      auto const n = diagnosis.coordination();
      double before = 0;
      for (std::size_t k = 0; k < 20; ++k) {
        EXPECT_NEAR(n[k], 2 * (before + 0.5 * plain[k]) / 700, 1e-12) << reach << ' ' << k;
        before += plain[k];
      }
      auto const state = diagnosis.state();
      if (first.empty()) first = state;
      EXPECT_EQ(state, first) << threads;
      RadialDistribution again({&atoms}, {.to = reach, .count = 20});
      again.restore(state);
      EXPECT_EQ(again.state(), state);
      EXPECT_EQ(look(again, {&atoms}, box), look(diagnosis, {&atoms}, box));
      EXPECT_THROW(again.restore(std::span(state).first(7)), Error);
    }
  }
}

TEST(RadialDistribution, RefusesWhatHasNoDensity) {
  Ensemble<Newton<2>> atoms("atoms", 10), ions("ions", 2);
  RadialDistribution plain({&atoms}, {}), far({&atoms}, {.to = 2.0});
  Box const half_open(Vector{0.0, 0.0}, Vector{3.0, 3.0}, {Boundary::periodic, Boundary::open});
  EXPECT_NE(message([&] { plain.check(half_open); }).find("axis y is open"), std::string::npos);
  Box tube(Vector{0.0, 0.0}, Vector{3.0, 3.0}, {Boundary::periodic, Boundary::mirror});
  EXPECT_NO_THROW(plain.check(tube));
  EXPECT_NE(message([&] { far.check(tube); }).find("up to 2, and along axis x of the box only up to 1.5"),
            std::string::npos);
  tube.open_end(1, Box::End::high);
  EXPECT_THROW(plain.check(tube), Error);
  Box ringed(Vector{0.0, 0.0}, Vector{3.0, 3.0}, Boundary::periodic);
  ringed.install(Vector{1.0, 1.0}, Vector{2.0, 2.0}, Region::Side::keep_out);
  EXPECT_NE(message([&] { plain.check(ringed); }).find("regions"), std::string::npos);
  EXPECT_THROW(RadialDistribution({&atoms}, {.ensembles = {"atom"}}), Error);
  EXPECT_THROW(RadialDistribution({&atoms, &ions}, {.ensembles = {"atoms", "ions", "atoms"}}), Error);
  EXPECT_THROW(RadialDistribution({&atoms}, {.to = -1.0}), Error);
  StructureFactor waves({&atoms}, {});
  EXPECT_NE(message([&] { waves.check(tube); }).find("axis y is not periodic"), std::string::npos);
  StructureFactor many({&atoms}, {.modes = 2000});
  EXPECT_NE(message([&] { many.check(ringed); }).find("choose fewer 'modes'"), std::string::npos);
}

// ---- Structure factors ----

TEST(StructureFactor, OfAnIdealGasIsOne) {
  Box const box(Vector{0.0, -1.0, 2.0}, Vector{3.0, 2.5, 4.0}, Boundary::periodic);
  Ensemble<Newton<3>> one("one", 30), two("two", 20);
  StructureFactor all({&one, &two}, {.modes = 4}), between({&one, &two}, {.ensembles = {"one", "two"}, .modes = 4});
  std::mt19937_64 random(test_seed(4));
  constexpr int looks = 400;
  for (int n = 0; n < looks; ++n) {
    place_anywhere(one, box, random);
    place_anywhere(two, box, random);
    look(all, {&one, &two}, box);
    look(between, {&one, &two}, box);
  }
  // |rho|^2 / N has an exponential distribution; the part between two has the variance 1/2.
  double const error = 1 / std::sqrt(looks);
  double sum = 0, of_both = 0;
  for (double const s : all.s_of_modes()) {
    EXPECT_NEAR(s, 1, 6 * error);
    sum += s;
  }
  for (double const s : between.s_of_modes()) {
    EXPECT_NEAR(s, 0, 6 * error);
    of_both += s;
  }
  auto const modes = static_cast<double>(all.modes().size());
  EXPECT_GT(modes, 40);
  EXPECT_NEAR(sum / modes, 1, 5 * error / std::sqrt(modes));
  EXPECT_NEAR(of_both / modes, 0, 5 * error / std::sqrt(2 * modes));
  auto const state = all.state();
  StructureFactor again({&one, &two}, {.modes = 4});
  again.restore(state);
  EXPECT_EQ(again.state(), state);
  EXPECT_EQ(look(again, {&one, &two}, box, 3), look(all, {&one, &two}, box, 1));
  EXPECT_THROW(again.restore(std::span(state).first(state.size() - 1)), Error);
}

TEST(StructureFactor, OfLatticesHasBraggsPeaks) {
  Ensemble<Newton<3>> atoms("atoms");
  block_load(atoms, {Lattice::fcc, std::sqrt(0.5), {3, 3, 3}});
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{3.0, 3.0, 3.0}, Boundary::periodic);
  StructureFactor diagnosis({&atoms}, {.modes = 7});
  auto const values = look(diagnosis, {&atoms}, box);
  std::size_t peaks = 0;
  for (std::size_t m = 0; m < diagnosis.modes().size(); ++m) {
    auto const [x, y, z] = diagnosis.modes()[m];
    bool const of_cells = x % 3 == 0 && y % 3 == 0 && z % 3 == 0;
    int const h = std::abs(x / 3) % 2, k = std::abs(y / 3) % 2, l = std::abs(z / 3) % 2;
    bool const bragg = of_cells && h == k && k == l;  // all even or all odd
    peaks += bragg;
    EXPECT_NEAR(diagnosis.s_of_modes()[m], bragg ? 108 : 0, 1e-8) << x << ' ' << y << ' ' << z;
  }
  EXPECT_EQ(peaks, 7U);  // (111) four times, (200) three times
  // (111) has the length sqrt(27) periods, and shares its shell with others.
  EXPECT_NEAR(values[1], 2 * std::numbers::pi / 3 * std::sqrt(27.0), 0.5 * 2 * std::numbers::pi / 3);

  // A line of two kinds, one in the middle between the others: opposite phases at odd multiples.
  Ensemble<Newton<1>> one("one", 8), two("two", 8);
  for (std::size_t i = 0; i < 8; ++i) one[i].position = {1.0 * i}, two[i].position = {1.0 * i + 0.5};
  Box const ring(Vector{0.0}, Vector{8.0}, Boundary::periodic);
  StructureFactor between({&one, &two}, {.ensembles = {"one", "two"}, .modes = 16});
  look(between, {&one, &two}, ring);
  for (std::size_t m = 0; m < 16; ++m)
    EXPECT_NEAR(between.s_of_modes()[m], m == 7 ? -8 : m == 15 ? 8 : 0, 1e-9) << m + 1;
}

// Groups of one ensemble are what ensembles of their own would be.
TEST(RadialDistribution, OfGroupsIsThatOfEnsembles) {
  Box const box(Vector{0.0, 0.0, 0.0}, Vector{3.0, 4.0, 5.0}, Boundary::periodic);
  std::mt19937_64 random(test_seed(5));
  Ensemble<Newton<3>> all("all", 60), one("one", 20), two("two", 30);
  place_anywhere(all, box, random);
  std::vector<std::uint32_t> first, second;
  for (std::uint32_t i = 0; i < 60; ++i) {
    if (i % 3 == 1) one[first.size()].position = all[i].position, first.push_back(i);
    if (i % 2 == 0 && i % 3 != 1 && second.size() < 20)
      two[second.size()].position = all[i].position, second.push_back(i);
  }
  two.resize(second.size());
  auto const expect_same = [&](auto& of_group, auto& of_ensembles) {
    EXPECT_EQ(look(of_group, {&all}, box, 2), look(of_ensembles, {&one, &two}, box, 1));
    EXPECT_EQ(of_group.tables().front().values, of_ensembles.tables().front().values);
    EXPECT_TRUE(of_group.by_number());
  };
  RadialDistribution within({&all}, {.to = 1.5, .particles = first}),
      of_one({&one, &two}, {.ensembles = {"one"}, .to = 1.5}),
      across({&all}, {.ensembles = {"all"}, .to = 1.5, .particles = first, .partners = second}),
      between({&one, &two}, {.ensembles = {"one", "two"}, .to = 1.5});
  expect_same(within, of_one);
  expect_same(across, between);
  StructureFactor waves({&all}, {.modes = 3, .particles = first}),
      of_one_waves({&one, &two}, {.ensembles = {"one"}, .modes = 3}),
      waves_across({&all}, {.modes = 3, .particles = first, .partners = second}),
      waves_between({&one, &two}, {.ensembles = {"one", "two"}, .modes = 3});
  expect_same(waves, of_one_waves);
  expect_same(waves_across, waves_between);

  EXPECT_EQ(message([&] {
              RadialDistribution({&one, &two}, {.particles = {1}});
            }),
            "a group of chosen particles belongs to one ensemble; name one of one, two");
  EXPECT_EQ(message([&] { StructureFactor({&all}, {.particles = {60}}); }),
            "ensemble 'all' has 60 particles, numbered from 0; there is no particle 60");
  EXPECT_EQ(message([&] { StructureFactor({&all}, {.partners = {6}}); }),
            "'partners' belong to a group; choose it with 'particles'");
  EXPECT_EQ(message([&] {
              RadialDistribution({&all}, {.particles = {1, 2}, .partners = {2, 3}});
            }),
            "particle 2 is chosen twice; a group and its 'partners' have none in common");
}

}  // namespace
}  // namespace boltzmann::radial_distribution_test
