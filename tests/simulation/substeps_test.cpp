// Steps that are divided: they follow the motion, hit their ends, and go back alike.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>

namespace boltzmann::substeps_test {
namespace {

/// A body of eccentricity 0.9 about a heavy one: a = 1, a period of 2 pi.
struct Comet {
  Ensemble<Kepler<3>> sun{"sun", 1}, comet{"comet", 1};
  PairScheme scheme{Box(Vector{-9., -9., -9.}, Vector{9., 9., 9.})};
  Simulation simulation;

  explicit Comet(double step, Method method = Method::leap_frog) : simulation(scheme, step) {
    sun[0].mass = 1, comet[0].mass = 1e-3;
    comet[0].position = {1.9, 0, 0};
    comet[0].velocity = {0, std::sqrt(0.1 / 1.9), 0};
    scheme.between(sun, comet, gravity(1.0));
    simulation.integrate(sun, Method::deactivate);
    simulation.integrate(comet, method);
  }
  /// Of the comet per mass; -1/2.
  double energy() const { return 0.5 * norm2(comet[0].velocity) - 1 / magnitude(comet[0].position - sun[0].position); }
};

constexpr double step = 0.25;

TEST(Substeps, FollowAnEccentricOrbitWithoutADrift) {
  // Whole steps of as many in all, for comparison.
  Comet divided(step);
  divided.simulation.divide_steps({.distance = 0.005});
  double worst = 0, early = 0, late = 0;
  int const looks = 4000;  // in 400 orbits; at all phases of them
  for (int k = 0; k < looks; ++k) {
    divided.simulation.run(static_cast<std::uint64_t>(2 * pi / step / 10) + (k % 2));
    double const error = divided.energy() + 0.5;
    worst = std::max(worst, std::abs(error));
    if (k < looks / 4) early += error / (looks / 4);
    if (k >= looks - looks / 4) late += error / (looks / 4);
  }
  auto const& counts = divided.simulation.substeps();
  double const substeps = static_cast<double>(counts.done) / static_cast<double>(divided.simulation.step());
  Comet whole(step / std::ceil(substeps));
  double error = 0;
  for (int k = 0; k < 1000; ++k) {
    whole.simulation.run(static_cast<std::uint64_t>(std::ceil(substeps) * 2 * pi / step / 25));
    error = std::max(error, std::abs(whole.energy() + 0.5));
  }
  std::printf(
      "[ SUBSTEPS ] %.1f a step, %.2f %% repeated; energy wrong by up to %.3g, on the average by %.3g in the first "
      "quarter and %.3g in the last; by up to %.3g with as many even steps\n",
      substeps, 100. * static_cast<double>(counts.repeated) / static_cast<double>(counts.done), worst, early, late,
      error);
  EXPECT_LT(std::abs(late - early), 0.1 * worst);
  EXPECT_LT(worst, 0.05 * error);
  EXPECT_LT(static_cast<double>(counts.repeated), 0.05 * static_cast<double>(counts.done));
}

TEST(Substeps, GoBackToTheStart) {
  for (auto const method : {Method::leap_frog, Method::symplectic_4}) {
    Comet there(step, method);
    there.simulation.divide_steps({.distance = 0.01});
    auto const start = there.comet[0].position;
    there.simulation.run(100);
    EXPECT_GT(magnitude(there.comet[0].position - start), 0.01);
    auto const forward = there.simulation.substeps().done;
    there.simulation.rewind(100);
    EXPECT_EQ(there.simulation.step(), 0);
    EXPECT_EQ(there.simulation.substeps().done, 2 * forward) << to_string(method);
    EXPECT_LT(magnitude(there.comet[0].position - start), 1e-10) << to_string(method);
  }
}

TEST(Substeps, HitTheEndsOfSteps) {
  Comet comet(step);
  comet.simulation.divide_steps({.distance = 0.02});
  std::vector<double> times;
  comet.simulation.observe(2, [&](Simulation const& now) { times.push_back(now.time()); });
  comet.simulation.run(8);
  EXPECT_EQ(times, (std::vector<double>{0, 0.5, 1, 1.5, 2}));
}

TEST(Substeps, WithoutNeedAreWholeSteps) {
  Comet divided(0.001), whole(0.001);
  divided.simulation.divide_steps({.distance = 10, .energy = 10});
  divided.simulation.run(500);
  whole.simulation.run(500);
  EXPECT_EQ(divided.simulation.substeps().done, 500U);
  EXPECT_EQ(std::memcmp(divided.comet.row(0), whole.comet.row(0), divided.comet.doubles() * sizeof(double)), 0);
}

TEST(Substeps, OfEnergyLimitTheWorkOnAParticle) {
  // |F| |v| h at the start and at the end of a step is below the limit where a step is not divided.
  double const limit = 2e-7;
  Comet comet(1e-3);
  comet.simulation.divide_steps({.energy = limit});
  double largest = 0, largest_whole = 0;
  for (int k = 0; k < 4000; ++k) {
    double const before = norm2(comet.comet[0].velocity);
    auto const done = comet.simulation.substeps().done;
    comet.simulation.run(1);
    double const work = 0.5 * comet.comet[0].mass * std::abs(norm2(comet.comet[0].velocity) - before);
    largest = std::max(largest, work);
    if (comet.simulation.substeps().done == done + 1) largest_whole = std::max(largest_whole, work);
  }
  EXPECT_GT(largest, 2 * limit);
  EXPECT_LT(largest_whole, limit);
  EXPECT_GT(largest_whole, 0.3 * limit);
}

/// A gas in which sound runs; influences of smooth particles depend on velocities.
struct Gas {
  Ensemble<Smooth<1>> gas{"gas", 100};
  SmoothScheme scheme{Box(Vector{0.}, Vector{100.}, Boundary::periodic)};
  Simulation simulation;

  explicit Gas(double size) : simulation(scheme, size) {
    for (std::size_t i = 0; i < gas.size(); ++i) {
      auto& p = gas[i];
      p.position = {0.5 + static_cast<double>(i)};
      p.velocity = {0.1 * std::sin(2 * pi * p.position[0] / 100)};
      p.specific_energy = i < 50 ? 1 : 20;
      p.range = 4;
    }
    scheme.artificial_viscosity({.alpha = 1, .beta = 2});
    scheme.material(gas, IdealGas{1.4, 1});
    simulation.integrate(gas, Method::leap_frog);
  }
};

TEST(Substeps, FollowSound) {
  Gas divided(4), fine(0.01);
  double const courant = divided.scheme.courant_step();
  EXPECT_LT(courant, 1);
  divided.simulation.divide_steps({.courant = 0.5});
  divided.simulation.run(5);
  fine.simulation.run(2000);
  EXPECT_GE(divided.simulation.substeps().done, 5 * 8U);
  for (std::size_t i = 0; i < 100; ++i) EXPECT_NEAR(divided.gas[i].position[0], fine.gas[i].position[0], 0.02) << i;
}

TEST(Substeps, ThatWereTooLongLeaveNothingBehind) {
  // In pieces, and from the state: the same bits, also where influences are of velocities inside a step.
  Gas whole(2), pieces(2), resumed(2);
  for (auto* one : {&whole, &pieces, &resumed}) one->simulation.divide_steps({.distance = 0.02, .courant = 0.5});
  whole.simulation.run(6);
  EXPECT_GT(whole.simulation.substeps().repeated, 0U);
  pieces.simulation.run(3);
  auto const state = pieces.simulation.state();
  for (std::size_t i = 0; i < 100; ++i) resumed.gas[i] = pieces.gas[i];
  resumed.simulation.restore(3, 2, 1, state);
  pieces.simulation.run(3);
  resumed.simulation.run(3);
  for (std::size_t i = 0; i < 100; ++i) {
    ASSERT_EQ(std::memcmp(whole.gas.row(i), pieces.gas.row(i), whole.gas.doubles() * sizeof(double)), 0) << i;
    ASSERT_EQ(std::memcmp(whole.gas.row(i), resumed.gas.row(i), whole.gas.doubles() * sizeof(double)), 0) << i;
  }
}

TEST(Substeps, WhatIsHeldDoesNotShortenThem) {
  // A heavy comet moves as a light one does, but pulls a million times as hard at the sun, which is held.
  Comet light(step), heavy(step);
  heavy.comet[0].mass = 1e3;
  for (auto* one : {&light, &heavy}) {
    one->simulation.divide_steps({.distance = 0.01});
    one->simulation.run(20);
  }
  EXPECT_GT(light.simulation.substeps().done, 100U);
  EXPECT_NEAR(
      static_cast<double>(heavy.simulation.substeps().done) / static_cast<double>(light.simulation.substeps().done), 1,
      0.02);
}

TEST(Substeps, MistakesAreNamed) {
  Comet comet(step);
  EXPECT_EQ(message([&] { comet.simulation.divide_steps({}); }),
            "substeps: no limit is set; give distance, energy or courant");
  EXPECT_EQ(message([&] { comet.simulation.divide_steps({.distance = -1}); }),
            "substeps: distance is -1; it must be positive");
  comet.simulation.divide_steps({.courant = 0.5});
  EXPECT_EQ(message([&] { comet.simulation.check(); }),
            "substeps: no scheme of the simulation has a Courant step; give distance or energy");
  comet.simulation.divide_steps({.distance = 0.1});
  comet.simulation.integrate(comet.comet, Method::rk4);
  EXPECT_EQ(message([&] { comet.simulation.check(); }),
            "steps are divided into substeps where leap-frog or symplectic-4 advances; ensemble 'comet' moves by rk4");
}

}  // namespace
}  // namespace boltzmann::substeps_test
