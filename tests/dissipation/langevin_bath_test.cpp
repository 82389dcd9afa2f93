// A Langevin bath against the exact Ornstein-Uhlenbeck process, and what leap-frog makes of a harmonic particle in it.
#include "meso_system.hpp"

#include <boltzmann/dissipation/langevin_bath.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <limits>

namespace boltzmann::langevin_flow_test {
namespace {

template <class P>
double mean_of(Ensemble<P> const& ensemble, auto const& quantity) {
  double sum = 0;
  for (std::size_t i = 0; i < ensemble.size(); ++i) sum += quantity(i, ensemble[i]);
  return sum / static_cast<double>(ensemble.size());
}

/// Particles without forces, of masses between 1/2 and 8, that start with one velocity.
Ensemble<Newton<3>>& start(Ensemble<Newton<3>>& gas, std::size_t count, Vector<3> const& velocity) {
  scatter(gas, cube<3>(10), count, Masses::unequal);
  for (auto& p : gas) p.velocity = velocity;
  return gas;
}

TEST(LangevinBath, FreeParticlesForgetTheirVelocities) {
  // Mean v0 exp(-rate t), variance kT/m (1 - exp(-2 rate t)), however long the steps are.
  double const k = 0.5, temperature = 3, rate = 0.8;
  for (double const dt : {0.05, 0.5, 3.0}) {
    Ensemble<Newton<3>> gas("gas");
    start(gas, 40000, {5, -2, 0});
    LangevinBath bath(temperature, rate, k);
    bath.on(gas);
    double const errors = 5 / std::sqrt(40000.0);  // five standard errors of the mean of a variable of variance 1
    for (std::uint64_t step = 0; step < 6; ++step) {
      bath.advance({dt, step, test_seed(17)});
      double const keep = std::exp(-rate * dt * static_cast<double>(step + 1)),
                   variance = k * temperature * (1 - keep * keep);
      for (int a = 0; a < 3; ++a) {
        double const v0 = a == 0 ? 5 : a == 1 ? -2 : 0;
        auto const excess = [&](auto, auto const& p) {
          return (p.velocity[a] - keep * v0) * std::sqrt(p.mass / variance);
        };
        EXPECT_NEAR(mean_of(gas, excess), 0, errors) << dt << " " << step;
        EXPECT_NEAR(mean_of(gas, [&](auto i, auto const& p) { return excess(i, p) * excess(i, p); }), 1,
                    std::sqrt(2) * errors);
      }
      EXPECT_NEAR(
          mean_of(gas, [&](auto, auto const& p) { return p.velocity[2] * (p.velocity[1] + 2 * keep) * p.mass; }), 0,
          errors * variance);
    }
  }
}

TEST(LangevinBath, CorrelationsDecayWithTheRate) {
  double const rate = 0.6, dt = 0.25;
  Ensemble<Newton<3>> gas("gas");
  start(gas, 40000, {0, 0, 0});
  LangevinBath bath(1, rate, 1);
  bath.on(gas);
  for (std::uint64_t step = 0; step < 60; ++step) bath.advance({dt, step, test_seed(3)});
  std::vector<Vector<3>> before;
  for (auto const& p : gas) before.push_back(p.velocity);
  for (std::uint64_t step = 60; step < 72; ++step) {
    bath.advance({dt, step, test_seed(3)});
    double const found =
        mean_of(gas, [&](std::size_t i, auto const& p) { return p.mass * dot(p.velocity, before[i]) / 3; });
    // The product of two normal variables with the correlation c has the variance 1 + c^2.
    double const c = std::exp(-rate * dt * static_cast<double>(step - 59));
    EXPECT_NEAR(found, c, 5 * std::sqrt((1 + c * c) / (3 * 40000.0))) << step;
  }
}

TEST(LangevinBath, ABathOfTemperatureZeroIsFriction) {
  Ensemble<Newton<3>> gas("gas");
  start(gas, 5, {3, 2, 1});
  LangevinBath bath(0, 2, 1);
  bath.on(gas);
  for (std::uint64_t step = 0; step < 10; ++step) bath.advance({0.1, step, test_seed(1)});
  for (auto const& p : gas)
    for (int a = 0; a < 3; ++a) EXPECT_NEAR(p.velocity[a], (3 - a) * std::exp(-2.0), 1e-14);
}

TEST(LangevinBath, HarmonicParticles) {
  // Leap-frog keeps m v^2 / 2 + (K/2)(1 - w^2 dt^2 / 4) x^2, and the bath its exponential: <x^2> is known exactly for
  // any step, <v^2> is right.
  double const stiffness = 3, mass = 0.75, dt = 0.4, temperature = 2;  // w dt = 0.8
  Ensemble<Newton<2>> springs("springs");
  Box const box = cube<2>(1000, Boundary::open);
  scatter(springs, box, 9000, Masses::equal);
  for (auto& p : springs) p.mass = mass, p.position = {0, 0}, p.velocity = {0, 0};
  PairScheme scheme(box);
  scheme.external(springs, [=](auto const& p) { return p.position * -stiffness; });
  LangevinBath bath(temperature, 1.5, 1);
  bath.on(springs);
  Simulation simulation(scheme, dt);
  simulation.integrate(springs, Method::leap_frog);
  simulation.add(bath);
  simulation.seed(test_seed(1));
  simulation.run(30);
  double x2 = 0, v2 = 0;
  int samples = 0;
  simulation.observe(10, [&](Simulation const&) {
    ++samples;
    x2 += mean_of(springs, [](auto, auto const& p) { return 0.5 * norm2(p.position); });
    v2 += mean_of(springs, [](auto, auto const& p) { return 0.5 * norm2(p.velocity); });
  });
  simulation.run(300);
  double const right = temperature / (stiffness * (1 - stiffness / mass * dt * dt / 4));
  EXPECT_NEAR(x2 / samples, right, 0.008 * right);
  EXPECT_NEAR(v2 / samples, temperature / mass, 0.008 * temperature / mass);
}

TEST(LangevinBath, HeatIsWhatTheBathHasGiven) {
  Ensemble<Newton<3>> gas("gas"), more("more");
  start(gas, 5000, {1, 2, 3});
  start(more, 100, {0, 0, 0});
  PairScheme scheme(cube<3>(10));
  scheme.add(gas);
  scheme.add(more);
  LangevinBath bath(2, 0.5, 1);
  bath.on(gas);
  bath.on(more);
  bath.on(gas);  // twice is once
  EXPECT_EQ(bath.ensembles().size(), 2U);
  PairScheme none(cube<3>(10), 1);
  none.add(gas);
  none.add(more);
  Simulation simulation(none, 0.05);
  simulation.add(bath);
  simulation.integrate(gas, Method::leap_frog);
  simulation.integrate(more, Method::leap_frog);
  simulation.seed(test_seed(1));
  double const before = kinetic_of({&gas, &more});
  simulation.run(40);
  double const gained = kinetic_of({&gas, &more}) - before;
  EXPECT_GT(std::abs(gained), 100);
  EXPECT_NEAR(bath.heat(), gained, 1e-11 * before);
  EXPECT_EQ(simulation.measure().heat, bath.heat());
  EXPECT_EQ(simulation.measure().internal, 0);
  // The two ensembles have not the same noise.
  EXPECT_NE(gas[7].velocity[0] * std::sqrt(gas[7].mass), more[7].velocity[0] * std::sqrt(more[7].mass));
}

TEST(LangevinBath, TheSameBitsForAnyThreadsAndAfterARestart) {
  struct Run {
    Ensemble<Newton<3>> gas{"gas"};
    PairScheme scheme{cube<3>(10), 1};
    LangevinBath bath{2, 0.5, 1};
    Simulation simulation{scheme, 0.05};
    explicit Run(int threads) {
      start(gas, 20000, {1, 2, 3});
      scheme.add(gas);
      bath.on(gas);
      simulation.add(bath);
      simulation.integrate(gas, Method::leap_frog);
      simulation.threads(threads);
      simulation.seed(4);
    }
  };
  Run one(1);
  one.simulation.run(10);
  for (int const threads : {2, 3, 8}) {
    Run more(threads);
    more.simulation.run(4);
    Run resumed(threads);
    set_rows(resumed.gas, bits_of_rows(more.gas));
    resumed.simulation.restore(more.simulation.step(), 0.05, 4, more.simulation.state());
    more.simulation.run(6);
    resumed.simulation.run(6);
    EXPECT_TRUE(bits_of_rows(more.gas) == bits_of_rows(one.gas)) << threads;
    EXPECT_TRUE(bits_of_rows(resumed.gas) == bits_of_rows(one.gas)) << threads;
    EXPECT_EQ(more.bath.heat(), one.bath.heat());
    EXPECT_EQ(resumed.bath.heat(), one.bath.heat());
  }
  Run other(1);
  other.simulation.seed(5);
  other.simulation.run(10);
  EXPECT_FALSE(bits_of_rows(other.gas) == bits_of_rows(one.gas));
}

TEST(LangevinBath, TwoBathsOfOneTemperatureAreOne) {
  Ensemble<Newton<3>> gas("gas");
  start(gas, 20000, {0, 0, 0});
  PairScheme scheme(cube<3>(10), 1);
  scheme.add(gas);
  LangevinBath first(2, 3, 1), second(2, 3, 1);
  first.on(gas);
  second.on(gas);
  Simulation simulation(scheme, 0.02);
  simulation.add(first);
  simulation.add(second);
  simulation.integrate(gas, Method::leap_frog);
  simulation.seed(test_seed(1));
  simulation.run(60);
  EXPECT_NEAR(kinetic_of({&gas}) / 30000, 2, 2 * 5 * std::sqrt(2 / 60000.0));
}

TEST(LangevinBath, Errors) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_EQ(message([] { LangevinBath(-1, 1, 1); }), "the temperature of a heat bath is zero or more, not -1");
  EXPECT_EQ(message([&] { LangevinBath(nan, 1, 1); }), "the temperature of a heat bath is zero or more, not nan");
  EXPECT_EQ(message([] { LangevinBath(1, 0, 1); }), "the rate of a heat bath is positive, not 0");
  EXPECT_EQ(message([] { LangevinBath(1, 1 / 0.0, 1); }), "the rate of a heat bath is positive, not inf");
  EXPECT_EQ(message([] { LangevinBath(1, 1, 0); }), "Boltzmann's constant is positive, not 0");
  LangevinBath bath(1, 1, 1);
  Ensemble<Inviscid<2>> vortices("vortices", 2);
  EXPECT_EQ(message([&] { bath.on(vortices); }),
            "a heat bath can't act on ensemble 'vortices': class Inviscid has no mass");
  Ensemble<Newton<2>> atoms("atoms", 3);
  bath.on(atoms);
  EXPECT_EQ(message([&] { bath.check(); }), "no error");
  atoms[2].mass = -1;
  EXPECT_EQ(message([&] { bath.check(); }), "particle 2 of 'atoms' has the mass -1: a heat bath needs positive masses");
  EXPECT_EQ(message([&] {
              bath.restore(std::vector<double>{1, 2});
            }),
            "the checkpoint's heat bath does not fit this simulation");
  EXPECT_TRUE(bath.warnings(0.1).empty());
  ASSERT_EQ(bath.warnings(5).size(), 1U);
  EXPECT_EQ(bath.warnings(5)[0],
            "warning: the heat bath's rate times the step is 5: velocities are drawn anew in every step");
  for (std::size_t const count : {0U, 1U, 2U}) {
    Ensemble<Newton<2>> few("few", count);
    LangevinBath small(1, 1, 1);
    small.on(few);
    small.advance({0.1, 0, 1});
    EXPECT_NEAR(small.heat(), kinetic_of({&few}), 1e-15);
  }
}

}  // namespace
}  // namespace boltzmann::langevin_flow_test
