// What flows of vortices conserve: closed forms of rings and pairs, and what runs keep of them.
#include <boltzmann/boltzmann.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <random>
#include <vector>

namespace boltzmann::vortex_measures_test {
namespace {

/// Adds the elements of a ring about an axis through its centre, along z.
void add_ring(Ensemble<Inviscid<3>>& ring, std::size_t first, std::size_t count, double radius, double z, double gamma,
              double core) {
  for (std::size_t k = 0; k < count; ++k) {
    double const angle = 2 * pi * static_cast<double>(k) / static_cast<double>(count);
    auto row = ring[first + k];
    row.position = {radius * std::cos(angle), radius * std::sin(angle), z};
    row.vorticity =
        Vector<3>{-std::sin(angle), std::cos(angle), 0.0} * (gamma * 2 * pi * radius / static_cast<double>(count));
    row.core = core;
    ring[first + k] = row;
  }
}

// A pair of opposite vortices: impulse Gamma times distance, along the way it goes. A ring: Gamma pi R^2.
TEST(VortexMeasures, AreThoseOfPairsAndRings) {
  Ensemble<Vortex<2>> pair("pair", 2);
  pair[0].position = {1, 2}, pair[0].vorticity[0] = 3;
  pair[1].position = {1, 5}, pair[1].vorticity[0] = -3;
  auto const of_pair = vortex_measures(pair);
  EXPECT_EQ(of_pair.circulation[0], 0);
  EXPECT_DOUBLE_EQ(of_pair.impulse[0], -9);
  EXPECT_DOUBLE_EQ(of_pair.impulse[1], 0);
  EXPECT_DOUBLE_EQ(of_pair.angular_impulse[0], -1.5 * (5 - 26));

  Ensemble<Inviscid<3>> ring("ring", 300);
  add_ring(ring, 0, 300, 0.7, 2, 3, 0.1);
  auto const of_ring = vortex_measures(ring);
  EXPECT_NEAR(of_ring.impulse[2], 3 * pi * 0.49, 1e-12);
  for (std::size_t a = 0; a < 3; ++a) EXPECT_NEAR(of_ring.circulation[a], 0, 1e-12);
  EXPECT_NEAR(of_ring.impulse[0], 0, 1e-12);
  EXPECT_NEAR(of_ring.angular_impulse[2], 0, 1e-12);
}

/// Two rings of circulations 2 and gamma, the second turned about x and moved along it.
double helicity_of_rings(double gamma, double moved) {
  std::size_t const count = 400;
  Ensemble<Inviscid<3>> rings("rings", 2 * count);
  add_ring(rings, 0, count, 1, 0, 2, 0.02);
  add_ring(rings, count, count, 1, 0, gamma, 0.02);
  for (std::size_t k = count; k < 2 * count; ++k) {
    auto row = rings[k];
    auto const x = row.position, w = row.vorticity;
    row.position = {x[0] + moved, -x[2], x[1]}, row.vorticity = {w[0], -w[2], w[1]};
    rings[k] = row;
  }
  PairScheme scheme(Box({-3, -3, -3}, {3, 3, 3}));
  scheme.internal(rings, AlgebraicBiotSavart{});
  scheme.calculate();
  return vortex_measures(rings).helicity;
}

// 2 Gamma1 Gamma2 times the linking number (H. K. Moffatt, J. Fluid Mech. 35, 117 (1969)): the second ring goes through
// the disc of the first once, downwards, or not at all.
TEST(VortexMeasures, CountHowOftenRingsAreLinked) {
  EXPECT_NEAR(helicity_of_rings(5, 1), -20, 0.01);
  EXPECT_NEAR(helicity_of_rings(-5, 1), 20, 0.01);
  EXPECT_NEAR(helicity_of_rings(5, 2.2), 0, 0.01);
}

// A tube without twist along a knot: Gamma^2 times the writhe of its line, which is its self-linking number, -3 of this
// trefoil, less its torsion in turns (G. Calugareanu 1961; H. K. Moffatt and R. L. Ricca, Proc. R. Soc. A 439, 411
// (1992)).
TEST(VortexMeasures, KnowTheWritheOfAKnot) {
  std::size_t const steps = 1000;
  double turns = 0;
  for (std::size_t k = 0; k < steps; ++k) {
    double const t = 2 * pi * static_cast<double>(k) / static_cast<double>(steps), s = std::sin(t), c = std::cos(t),
                 s2 = std::sin(2 * t), c2 = std::cos(2 * t), s3 = std::sin(3 * t), c3 = std::cos(3 * t);
    Vector<3> const first{c + 4 * c2, -s + 4 * s2, -3 * c3}, second{-s - 8 * s2, -c + 8 * c2, 9 * s3},
        third{-c - 16 * c2, s - 16 * s2, 27 * c3}, binormal = cross(first, second);
    turns += dot(binormal, third) / norm2(binormal) * magnitude(first) / static_cast<double>(steps);
  }
  Ensemble<Inviscid<3>> knot("knot");
  vortex_tube_load(
      knot,
      [](double u) {
        double const t = 2 * pi * u;
        return Vector<3>{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
      },
      {.circulation = 1.5, .core_radius = 0.15, .layers = 1});
  PairScheme scheme(Box({-4, -4, -2}, {4, 4, 2}));
  scheme.internal(knot, GaussianBiotSavart{});
  scheme.calculate();
  EXPECT_NEAR(vortex_measures(knot).helicity / (1.5 * 1.5 * (-3 - turns)), 1, 0.01);
}

// RK4, open space: circulation to rounding, impulses as far as the step goes: 1e-8 in a turn.
TEST(VortexMeasures, AreConserved) {
  Ensemble<Vortex<2>> vortices("vortices", 40);
  std::mt19937_64 random(test_seed(3));
  std::normal_distribution<double> normal;
  for (auto& p : vortices) {
    p.position = {normal(random), normal(random)};
    p.vorticity[0] = 0.2 + 0.1 * normal(random);
    p.core = 0.3;
  }
  PairScheme scheme(Box({-9, -9}, {9, 9}));
  scheme.internal(vortices, GaussianBiotSavart{});
  Simulation simulation(scheme, 0.02);
  auto const before = vortex_measures(vortices);
  double const turn = 4 * pi * pi / before.circulation[0];  // of the rim of radius 1
  simulation.run(static_cast<std::uint64_t>(turn / 0.02));
  auto const after = vortex_measures(vortices);
  EXPECT_EQ(after.circulation[0], before.circulation[0]);
  double const scale = std::abs(before.angular_impulse[0]);
  EXPECT_NEAR(after.impulse[0], before.impulse[0], 1e-8 * scale);
  EXPECT_NEAR(after.impulse[1], before.impulse[1], 1e-8 * scale);
  EXPECT_NEAR(after.angular_impulse[0], before.angular_impulse[0], 1e-8 * scale);
}

// Of elements whose vorticity has a divergence: the transposed form keeps the sum of the vorticity, the classic one does
// not.
TEST(VortexMeasures, OfTheTransposedFormKeepTheSumOfTheVorticity) {
  for (double const transposed : {0.0, 1.0}) {
    Ensemble<Inviscid<3>> vortices("vortices", 30);
    std::mt19937_64 random(test_seed(4));
    std::normal_distribution<double> normal;
    for (auto& p : vortices) {
      for (int a = 0; a < 3; ++a) p.position[a] = normal(random), p.vorticity[a] = normal(random);
      p.core = 0.5;
    }
    PairScheme scheme(Box({-9, -9, -9}, {9, 9, 9}));
    scheme.internal(vortices, GaussianBiotSavart{.transposed = transposed});
    Simulation simulation(scheme, 0.05);
    auto const before = vortex_measures(vortices);
    simulation.run(20);
    auto const after = vortex_measures(vortices);
    double change = 0;
    for (std::size_t a = 0; a < 3; ++a) change += std::abs(after.circulation[a] - before.circulation[a]);
    if (transposed == 1) {
      EXPECT_LT(change, 1e-12);
    } else {
      EXPECT_GT(change, 1e-3);
    }
  }
}

TEST(VortexMeasures, AsADiagnosisRefuseWhatHasNoVorticity) {
  Ensemble<Vortex<3>> vortices("vortices", 2);
  Ensemble<Tracer<3>> dust("dust", 2);
  DiagnosisParameters parameters;
  parameters.available = {&dust};
  EXPECT_NE(message([&] { make_diagnosis("vortex-invariants", parameters); }).find("no ensemble has vorticity"),
            std::string::npos);
  parameters.available = {&dust, &vortices};
  EXPECT_EQ(make_diagnosis("vortex-invariants", parameters)->columns().size(), 10U);
  parameters.ensembles = {"dust"};
  EXPECT_NE(message([&] { make_diagnosis("vortex-invariants", parameters); }).find("'dust' is of class Tracer"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::vortex_measures_test
