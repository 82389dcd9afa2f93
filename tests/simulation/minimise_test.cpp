// Minima against those that are known: clusters of Lennard-Jones atoms, what lies on a wall, loads that overlap.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <limits>
#include <memory>
#include <numbers>
#include <vector>

namespace boltzmann::minimise_test {
namespace {

template <int D>
Box space(double half, Boundary boundary = Boundary::open) {
  Vector<D> low, high;
  for (int a = 0; a < D; ++a) low[a] = -half, high[a] = half;
  return Box(low, high, boundary);
}

/// Atoms of mass 1 with depth 1 and r0 = 1, in steps of 0.01.
template <int D>
struct Cluster {
  Ensemble<Newton<D>> atoms;
  PairScheme scheme;
  Simulation simulation;

  explicit Cluster(std::size_t size, Box const& box = space<D>(9),
                   double cutoff = std::numeric_limits<double>::infinity())
      : atoms("atoms", size), scheme(box, cutoff), simulation(scheme, 0.01) {
    scheme.internal(atoms, LennardJones{1, 1});
  }
  /// At random, no nearer than that.
  void scatter(double distance, std::uint64_t seed) {
    random_load(atoms, scheme.box(), {.minimum_distance = distance, .seed = seed});
  }
};

template <int D>
void expect_a_dimer() {
  Cluster<D> pair(2);
  pair.atoms[1].position = pair.atoms[0].position;
  pair.atoms[1].position[D - 1] = 1.7;
  pair.atoms[0].velocity[0] = 3;
  auto const found = minimise(pair.simulation, {.force = 1e-9});
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(magnitude(pair.atoms[1].position - pair.atoms[0].position), 1, 1e-9) << D;
  EXPECT_NEAR(*found.energy_after, -1, 1e-15);
  double const s6 = std::pow(1.7, -6);
  EXPECT_NEAR(*found.energy_before, s6 * (s6 - 2), 1e-12);
  EXPECT_LT(found.force_after, 1e-9);
  EXPECT_GT(found.force_before, 0.1);
  EXPECT_EQ(pair.atoms[0].velocity[0], 3) << "velocities stay";
  EXPECT_LT(found.steps, 1000);
}

TEST(Minimise, FindsTheDimerInEveryDimension) {
  expect_a_dimer<1>();
  expect_a_dimer<2>();
  expect_a_dimer<3>();
}

TEST(Minimise, FindsTheTriangleAndTheTetrahedron) {
  Cluster<2> three(3);
  three.atoms[1].position = {1.3, 0.1}, three.atoms[2].position = {0.2, 0.8};
  EXPECT_NEAR(*minimise(three.simulation, {.force = 1e-8}).energy_after, -3, 1e-12);
  Cluster<3> four(4);
  four.atoms[1].position = {1.3, 0.1, 0}, four.atoms[2].position = {0.2, 0.8, 0.1};
  four.atoms[3].position = {0.3, 0.2, 1.1};
  four.atoms[2].mass = 50;  // masses change the way there, and no minimum
  EXPECT_NEAR(*minimise(four.simulation, {.force = 1e-8}).energy_after, -6, 1e-12);
}

// D. J. Wales and J. P. K. Doye, J. Phys. Chem. A 101, 5111 (1997): -44.326801 epsilon for 13 atoms.
TEST(Minimise, FindsTheIcosahedronOf13Atoms) {
  Cluster<3> icosahedron(13);
  double const golden = std::numbers::phi;
  std::size_t i = 1;
  for (double const a : {-1., 1.})
    for (double const b : {-golden, golden})
      for (int turn = 0; turn < 3; ++turn) {
        auto& position = icosahedron.atoms[i++].position;
        position[turn] = 0, position[(turn + 1) % 3] = 0.5 * a, position[(turn + 2) % 3] = 0.5 * b;
      }
  Stream stream(test_seed(3), 0, 0, user_purpose(0));
  for (auto& atom : icosahedron.atoms)
    for (int a = 0; a < 3; ++a) atom.position[a] += 0.1 * stream.normal();
  auto const found = minimise(icosahedron.simulation, {.force = 1e-9});
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(*found.energy_after, -44.326801, 1e-6);
  std::printf("[ MINIMUM  ] 13 atoms: %.9f in %d steps\n", *found.energy_after, static_cast<int>(found.steps));
}

TEST(Minimise, PushesOverlapsOfARandomLoadApart) {
  for (auto const boundary : {Boundary::periodic, Boundary::reflecting}) {
    Cluster<2> liquid(120, space<2>(5.7, boundary), 2.5);
    liquid.scatter(0, test_seed(5));
    liquid.atoms[7].position = liquid.atoms[8].position = liquid.atoms[9].position;
    EXPECT_NE(message([&] { liquid.simulation.check(); }), "no error");
    auto const found = minimise(liquid.simulation, {.force = 0.05});
    EXPECT_TRUE(found.converged) << found.force_after << " after " << found.steps;
    EXPECT_GE(found.separated, 2U);
    EXPECT_LT(*found.energy_after, -2 * 120.) << "each has some six neighbours, half of which it shares";
    EXPECT_LE(found.force_after, 0.05);
    liquid.simulation.run(100);
    EXPECT_NEAR(liquid.simulation.measure().potential, *found.energy_after, 0.5) << "it stays there";
    std::printf("[ MINIMUM  ] overlaps: %d steps\n", static_cast<int>(found.steps));
  }
}

TEST(Minimise, BeforeARunIsTheSame) {
  auto const rows = [](auto const& ensemble) {
    return std::vector<double>(ensemble.row(0), ensemble.row(0) + ensemble.size() * ensemble.stride());
  };
  auto const run = [&](int threads, bool first) {
    Cluster<2> liquid(300, space<2>(9, Boundary::periodic), 2.5);
    liquid.scatter(0.3, test_seed(6));
    liquid.simulation.threads(threads);
    if (first)
      liquid.simulation.minimise_first({.steps = 200});
    else
      minimise(liquid.simulation, {.steps = 200});
    std::vector<double> at_start;
    liquid.simulation.observe_when([](std::int64_t step) { return step == 0; },
                                   [&](Simulation const&) { at_start = rows(liquid.atoms); });
    liquid.simulation.run(20);
    EXPECT_TRUE(liquid.simulation.minimised());
    auto all = rows(liquid.atoms);
    all.insert(all.end(), at_start.begin(), at_start.end());
    return all;
  };
  auto const one = run(1, true);
  EXPECT_EQ(run(1, false), one);
  for (int const threads : {2, 3}) EXPECT_EQ(run(threads, true), one) << threads;
}

TEST(Minimise, AResumedRunIsNotMinimisedAgain) {
  Cluster<2> whole(60, space<2>(4, Boundary::periodic), 2), resumed(60, space<2>(4, Boundary::periodic), 2);
  for (auto* one : {&whole, &resumed}) {
    one->scatter(0.5, test_seed(6));
    one->simulation.minimise_first({.steps = 50});
  }
  whole.simulation.run(7);
  std::memcpy(resumed.atoms.row(0), whole.atoms.row(0), 60 * whole.atoms.stride() * sizeof(double));
  resumed.simulation.restore(7, 0.01, whole.simulation.seed(), whole.simulation.state());
  whole.simulation.run(5);
  resumed.simulation.run(5);
  EXPECT_FALSE(resumed.simulation.minimised());
  for (std::size_t i = 0; i < 60; ++i) EXPECT_EQ(resumed.atoms[i].position[0], whole.atoms[i].position[0]);
}

TEST(Minimise, WhatAWallStopsLiesOnIt) {
  Ensemble<Newton<2>> balls("balls", 2);
  balls[0].position = {1, 3}, balls[1].position = {1.5, 7};
  balls[1].mass = 2;
  PairScheme scheme(Box({0, 0}, {10, 10}, Boundary::reflecting));
  scheme.box().wall(1, Box::End::high, Wall{.velocity = {0, -0.1, 0}});
  scheme.internal(balls, [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    return Interaction{r * 1.0, 0.5 * dot(r, r)};  // a spring of stiffness 1 and no length
  });
  scheme.external(balls, [](auto const& p) { return Interaction{p.mass * Vector{0.0, -1.0}, p.mass * p.position[1]}; });
  Simulation simulation(scheme, 0.01);
  auto const found = minimise(simulation, {.force = 1e-10});
  EXPECT_TRUE(found.converged) << text(found, UnitSystem::reduced());
  for (auto const& ball : balls) EXPECT_EQ(ball.position[1], 0);
  EXPECT_LT(std::abs(balls[0].position[0] - balls[1].position[0]), 1e-9);
  EXPECT_NEAR(*found.energy_after, 0, 1e-12);
  EXPECT_EQ(scheme.box().high(1), 10) << "walls stand still meanwhile";
  simulation.run(1);
}

TEST(Minimise, DeactivatedEnsemblesStayAndOthersFollow) {
  // An ion beside two that are held: k q q' (1/x^2 - 4/(3 - x)^2) = 0 at x = 1.
  Ensemble<Coulomb<1>> ions("ions", 1), held("held", 2);
  ions[0].position = {1.4}, ions[0].charge = 1;
  held[0].position = {0.}, held[1].position = {3.};
  held[0].charge = 1, held[1].charge = 4;
  PairScheme scheme(Box(Vector{-9.}, Vector{9.}));
  scheme.between(ions, held, [](auto const& p, auto const& q) {
    auto const r = q.position - p.position;
    auto const inverse = rsqrt(dot(r, r));
    return Interaction{r * (-1.0 * p.charge * q.charge * cube(inverse)), p.charge * q.charge * inverse};
  });
  Simulation simulation(scheme, 0.01);
  simulation.integrate(held, Method::deactivate);
  simulation.integrate(ions, Method::reversible_leap_frog);
  auto const found = minimise(simulation, {.force = 1e-9});
  EXPECT_TRUE(found.converged);
  EXPECT_NEAR(ions[0].position[0], 1, 1e-9);
  EXPECT_NEAR(*found.energy_after, 3, 1e-12);
  EXPECT_EQ(held[1].position[0], 3);
}

TEST(Minimise, EndsWhereTheEnergyHardlyChanges) {
  Cluster<2> liquid(100, space<2>(6, Boundary::periodic), 2.5);
  liquid.scatter(0.7, test_seed(8));
  auto const coarse = minimise(liquid.simulation, {.energy = 1e-2});
  auto const fine = minimise(liquid.simulation, {.energy = 1e-9});
  EXPECT_TRUE(coarse.converged && fine.converged);
  EXPECT_LT(*fine.energy_after, *coarse.energy_after);
  EXPECT_LT(fine.force_after, 1e-2);
  auto const cut_short = minimise(liquid.simulation, {.force = 1e-12, .steps = 3});
  EXPECT_FALSE(cut_short.converged);
  EXPECT_EQ(cut_short.steps, 3);
  EXPECT_NE(text(cut_short, UnitSystem::reduced()).find("of 'atoms'), 3 steps, not converged"), std::string::npos)
      << text(cut_short, UnitSystem::reduced());
}

TEST(Minimise, RefusesWhatHasNoMinimum) {
  Cluster<2> none(0);
  EXPECT_NE(message([&] { minimise(none.simulation); }).find("there is nothing that a force moves"), std::string::npos);
  Cluster<2> held(2);
  held.atoms[1].position = {1, 0};
  held.simulation.integrate(held.atoms, Method::deactivate);
  EXPECT_NE(message([&] { minimise(held.simulation); }).find("there is nothing that a force moves"), std::string::npos);
  Cluster<2> pair(2);
  pair.atoms[1].position = {1, 0};
  EXPECT_EQ(message([&] { minimise(pair.simulation, {.force = -1}); }), "minimise: force is -1; it must be positive");
  EXPECT_EQ(message([&] { minimise(pair.simulation, {.steps = 0}); }), "minimise: at least one step is needed, not 0");
  PairScheme silent(space<2>(9));
  Ensemble<Newton<2>> atoms("atoms", 2);
  atoms[1].position = {1, 0};
  silent.internal(atoms, [](auto const& p, auto const& q) { return (q.position - p.position) * 0.1; });
  Simulation simulation(silent, 0.01);
  EXPECT_NE(message([&] { minimise(simulation, {.energy = 1}); }).find("energy is no measure here"), std::string::npos);
  EXPECT_FALSE(minimise(simulation, {.force = 1e-9}).energy_after);
  EXPECT_LT(magnitude(atoms[1].position - atoms[0].position), 1e-8);
}

}  // namespace
}  // namespace boltzmann::minimise_test
