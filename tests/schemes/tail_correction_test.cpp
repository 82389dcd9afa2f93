// Tail corrections against the closed formulas of powers, in every space; laws that are ended at the cut-off.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/pair/tail_correction.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace boltzmann::tail_correction_test {
namespace {

using std::numbers::pi;

FormulaLaw const lennard_jones = FormulaLaw::energy("4*((1/r)^12 - (1/r)^6)");

template <int D>
Box cube(double length, Boundary boundary = Boundary::periodic) {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = 0, high[a] = length;
  return Box(low, high, boundary);
}

// 4 (r^-12 - r^-6) beyond R in D dimensions: S R^D 4 (R^-12 / (12 - D) - R^-6 / (6 - D)); its virial has 12 and 6 in
// front of the terms.
template <int D>
void expect_closed_formula() {
  double const R = 2.5, surface = D == 1 ? 2 : D == 2 ? 2 * pi : 4 * pi, length = 7, n = 20;
  double const twelve = std::pow(R, D - 12) / (12 - D), six = std::pow(R, D - 6) / (6 - D);
  double const pairs = 0.5 * n * n / std::pow(length, D);
  Ensemble<Newton<D>> atoms("atoms", 20);
  TailCorrection tail(cube<D>(length));
  tail.internal(atoms, lennard_jones, R);
  auto const measured = tail.measure();
  double const energy = pairs * surface * 4 * (twelve - six), virial = pairs * surface * 4 * (12 * twelve - 6 * six);
  EXPECT_NEAR(measured.potential / energy, 1, 1e-12) << D;
  double trace = 0, of_particles = 0, of_energies = 0;
  for (std::size_t a = 0; a < 3; ++a) trace += measured.virial[a][a];
  EXPECT_NEAR(trace / virial, 1, 1e-12) << D;
  for (std::size_t i = 0; i < 20; ++i) {
    of_energies += measured.per_particle[0][i];
    for (std::size_t a = 0; a < 3; ++a) of_particles += measured.virial_per_particle[0][9 * i + 4 * a];
  }
  EXPECT_NEAR(of_energies / energy, 1, 1e-12);
  EXPECT_NEAR(of_particles / virial, 1, 1e-12);
  // The virial is minus the energy's slope with the size of the box: - D V dU/dV at fixed numbers.
  auto const at = [&](double factor) {
    TailCorrection scaled(cube<D>(length * factor));
    scaled.internal(atoms, lennard_jones, R * factor);
    return scaled.measure().potential;
  };
  EXPECT_NEAR(-(at(1.0001) - at(0.9999)) / 0.0002 / virial, 1, 1e-6) << D;
}

TEST(TailCorrection, IsThatOfPowersInEverySpace) {
  expect_closed_formula<1>();
  expect_closed_formula<2>();
  expect_closed_formula<3>();
}

TEST(TailCorrection, OfTwoEnsemblesCountsEachPairOnce) {
  Ensemble<Newton<3>> a("a", 3), b("b", 5);
  TailCorrection mixed(cube<3>(8)), one(cube<3>(8));
  mixed.internal(a, lennard_jones, 3);
  mixed.internal(b, lennard_jones, 3);
  mixed.between(a, b, lennard_jones, 3);
  Ensemble<Newton<3>> all("all", 8);
  one.internal(all, lennard_jones, 3);
  EXPECT_NEAR(mixed.measure().potential / one.measure().potential, 1, 1e-13);
  EXPECT_NEAR(mixed.measure().virial[1][1] / one.measure().virial[1][1], 1, 1e-13);
}

TEST(TailCorrection, OfParticlesThatDifferIsThatOfEnsemblesOfEqualOnes) {
  // p is not q: a law of an ensemble by itself is symmetric, one between two need not be.
  Ensemble<Newton<3>> a("a", 3), b("b", 5), all("all", 8), others("others", 4);
  for (std::size_t i = 0; i < 8; ++i) all[i].mass = i % 2 == 0 || i == 7 ? 2 : 0.5;
  for (auto& p : a) p.mass = 0.5;
  for (auto& p : b) p.mass = 2;
  for (std::size_t i = 0; i < 4; ++i) others[i].mass = i == 2 ? 3 : 1;
  auto const law = FormulaLaw::energy("4*p.mass*q.mass*((1/r)^12 - q.mass*p.mass*(1/r)^6)");
  auto const skew = FormulaLaw::energy("p.mass*q.mass^2/r^5");
  TailCorrection mixed(cube<3>(8)), one(cube<3>(8));
  mixed.internal(a, law, 2);
  mixed.internal(b, law, 2);
  mixed.between(a, b, law, 2);
  mixed.between(a, others, skew, 2);
  mixed.between(b, others, skew, 2);
  one.internal(all, law, 2);
  one.between(all, others, skew, 2);
  auto const apart = mixed.measure(), together = one.measure();
  EXPECT_NEAR(apart.potential / together.potential, 1, 1e-13);
  EXPECT_NEAR(apart.virial[1][1] / together.virial[1][1], 1, 1e-13);
  EXPECT_NEAR(apart.per_particle[0][0] / together.per_particle[0][1], 1, 1e-13);
  EXPECT_NEAR(apart.per_particle[1][0] / together.per_particle[0][0], 1, 1e-13);
  EXPECT_NEAR(apart.per_particle[2][2] / together.per_particle[1][2], 1, 1e-13);
  // Against the closed formula, of the skew law: sum of m_p m_q^2 over pairs times 4 pi / (2 R^2) / V.
  TailCorrection alone(cube<3>(8));
  alone.between(all, others, skew, 2);
  EXPECT_NEAR(alone.measure().potential, (3 * 0.5 + 5 * 2) * (3 + 9) * 4 * pi / (2 * 4) / 512, 1e-13);
}

// exp(-r) in 3D: 4 pi (R^2 + 2 R + 2) exp(-R).
TEST(TailCorrection, OfExponentials) {
  for (double const R : {1.0, 5.0, 12.0})
    EXPECT_NEAR(
        integral_beyond(R, 3, [](double r) { return std::exp(-r); }) / (4 * pi * (R * R + 2 * R + 2) * std::exp(-R)), 1,
        1e-11)
        << R;
  EXPECT_NEAR(integral_beyond(2, 3, [](double r) { return std::pow(r, -3.5); }) / (4 * pi * 2 / std::sqrt(2.0)), 1,
              1e-9);
}

TEST(TailCorrection, RefusesWhatHasNone) {
  Ensemble<Newton<3>> atoms("atoms", 2);
  Ensemble<Newton<1>> line("line", 2);
  TailCorrection tail(cube<3>(8)), of_line(cube<1>(8));
  auto const refused = [&](FormulaLaw const& law, double cutoff = 3) {
    return message([&] { tail.internal(atoms, law, cutoff); });
  };
  EXPECT_EQ(refused(FormulaLaw::energy("1/r^3")),
            "its tail has no end: in 3D an energy must fall off faster than 1/r^3, from the cut-off 3 on it does not");
  for (char const* law : {"dot(p.velocity, q.velocity)/r^6", "dot(separation, [1, 0, 0])^2/r^9"})
    EXPECT_EQ(refused(FormulaLaw::energy(law)),
              "a tail is that of an energy which knows the distance of two particles and fields of them that do not "
              "change, and nothing else");
  Ensemble<Newton<3>> many("many", 65);
  for (std::size_t i = 0; i < 65; ++i) many[i].mass = 1 + static_cast<double>(i);
  EXPECT_EQ(message([&] { tail.internal(many, FormulaLaw::energy("p.mass*q.mass/r^6"), 3); }),
            "a tail is that of at most 64 kinds of particles; the fields that the law reads make more of 'many'");
  EXPECT_EQ(refused(FormulaLaw::influence("1/r^6")), "a tail needs the energy of the law; it has none");
  EXPECT_EQ(refused(lennard_jones, no_cutoff), "a tail begins at a cut-off; there is none");
  EXPECT_EQ(message([] { TailCorrection open(cube<2>(8, Boundary::open)); }),
            "a tail is that of surroundings without end; axis x is not periodic");
  EXPECT_NE(refused(FormulaLaw::energy("1/r")).find("has no end"), std::string::npos);
  of_line.internal(line, FormulaLaw::energy("1/r^3"), 3);  // in 1D it has an end
  EXPECT_NEAR(of_line.measure().potential, 0.5 * 2 * 2 / 8. * 2 / (2 * 9.), 1e-13);
}

// ---- Scenarios ----

std::string scenario_of(std::string const& run, std::string const& influence) {
  return "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [6, 6, 6]\nboundary = \"periodic\"\n[run]\nstep "
         "= 0.002\n"
         "steps = 10\ncutoff = 2.5\n" +
         run +
         "\n[[ensembles]]\nname = \"atoms\"\nclass = \"Newton\"\nload = { kind = \"block\", lattice = \"fcc\", spacing "
         "= "
         "1.06, counts = [4, 4, 4], jitter = 0.05 }\n[[influences]]\non = \"atoms\"\n" +
         influence;
}
std::string const shipped = "law = \"lennard-jones\"\ndepth = 1\nr0 = 1.122462048309373\n";
std::string const typed = "energy = \"4*(1/r^12 - 1/r^6)\"\n";

struct Measured {
  double potential, virial;
};
Measured measured(std::string const& run, std::string const& influence) {
  auto const scenario = parse_scenario(scenario_of(run, influence), "tail.toml");
  scenario->simulation->run(0);
  auto const of = scenario->simulation->measure();
  return {of.potential, of.virial[0][0] + of.virial[1][1] + of.virial[2][2]};
}

TEST(TailCorrection, IsAKeyOfScenarios) {
  for (auto const& law : {shipped, typed}) {
    auto const cut = measured("shifted = false", law), whole = measured("shifted = false", law + "tail = true");
    double const n = 256, pairs = 0.5 * n * n / 216, R = 2.5;
    EXPECT_NEAR(whole.potential - cut.potential, pairs * 4 * pi * 4 * (std::pow(R, -9) / 9 - std::pow(R, -3) / 3),
                1e-9);
    EXPECT_NEAR(whole.virial - cut.virial, pairs * 4 * pi * 4 * (12 * std::pow(R, -9) / 9 - 6 * std::pow(R, -3) / 3),
                1e-9);
    // The run is the same.
    auto const a = parse_scenario(scenario_of("", law), "a.toml"),
               b = parse_scenario(scenario_of("shifted = false", law + "tail = true"), "b.toml");
    a->simulation->run(10), b->simulation->run(10);
    for (std::size_t i = 0; i < 256; ++i)
      for (int c = 0; c < 3; ++c) ASSERT_EQ(a->ensembles[0]->row(i)[c], b->ensembles[0]->row(i)[c]);
  }
}

// The same bits for any number of threads, and where a run goes on.
TEST(TailCorrection, ChangesNoBit) {
  auto const at_end = [&](int threads, bool in_two_parts) {
    auto const text = scenario_of("shifted = false\nthreads = " + std::to_string(threads), shipped + "tail = true");
    auto first = parse_scenario(text, "t.toml");
    first->simulation->run(in_two_parts ? 4 : 10);
    if (in_two_parts) {
      auto next = parse_scenario(text, "t.toml");
      auto const &from = *first->ensembles[0], &to = *next->ensembles[0];
      for (std::size_t i = 0; i < from.size(); ++i) std::copy_n(from.row(i), from.stride(), next->ensembles[0]->row(i));
      EXPECT_EQ(from.size(), to.size());
      next->simulation->restore(4, 0.002, 1, first->simulation->state());
      next->simulation->run(6);
      std::swap(first, next);
    }
    auto const measured = first->simulation->measure();
    return std::pair(measured.potential, measured.virial[1][2]);
  };
  auto const one = at_end(1, false);
  EXPECT_EQ(at_end(2, false), one);
  EXPECT_EQ(at_end(3, false), one);
  EXPECT_EQ(at_end(2, true), one);
}

TEST(TailCorrection, ShippedLawsEndAtTheCutOffAsTypedOnesDo) {
  for (std::string const end : {"at_cutoff = \"cut\"\n", "at_cutoff = \"shift\"\n", "at_cutoff = \"switch\"\n",
                                "at_cutoff = \"switch\"\nswitch_from = 2\n"}) {
    auto const one = measured("", shipped + end), other = measured("", typed + end);
    EXPECT_NEAR(one.potential / other.potential, 1, 1e-12) << end;
    EXPECT_NEAR(one.virial / other.virial, 1, 1e-11) << end;
  }
  EXPECT_GT(std::abs(measured("", shipped + "at_cutoff = \"shift\"\n").virial - measured("", shipped).virial), 1);
}

TEST(TailCorrection, MistakesAreToldInOneLine) {
  auto const told = [](std::string const& run, std::string const& influence) {
    return message([&] { parse_scenario(scenario_of(run, influence), "t.toml"); });
  };
  EXPECT_NE(told("", shipped + "tail = true\n").find("with a tail write shifted = false in [run]"), std::string::npos);
  EXPECT_NE(told("shifted = false", shipped + "tail = true\nat_cutoff = \"shift\"\n").find("leave out one of the two"),
            std::string::npos);
  EXPECT_NE(told("shifted = false", "energy = \"1/r\"\ntail = true\n").find("its tail has no end"), std::string::npos);
  EXPECT_NE(told("", shipped + "at_cutoff = \"shfit\"\n").find("did you mean 'shift'?"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::tail_correction_test
