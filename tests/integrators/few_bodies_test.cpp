// Methods for few bodies against exact and published motion: Gauss-Radau and the symplectic method of fourth order.
#include <boltzmann/exact/kepler.hpp>
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/laws/magnetic.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/vortex.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <cstdio>
#include <cstring>
#include <memory>
#include <vector>

namespace boltzmann::few_bodies_test {
namespace {

constexpr double infinite_box = 1e6;

Box space() {
  return Box(Vector{-infinite_box, -infinite_box, -infinite_box}, Vector{infinite_box, infinite_box, infinite_box});
}

/// Bodies with G = 1.
struct System {
  Ensemble<Kepler<3>> bodies;
  PairScheme scheme{space()};
  Simulation simulation{scheme, 0.1};
  double start_energy = 0;

  System(std::size_t count, double step, Method method) : bodies("bodies", count) {
    scheme.internal(bodies, gravity(1.0));
    simulation.step_size(step);
    simulation.integrate(bodies, method);
  }
  double energy() const {
    double sum = simulation.measure().potential;
    for (auto const& body : bodies) sum += 0.5 * body.mass * norm2(body.velocity);
    return sum;
  }
  void begin() { start_energy = energy(); }
  double energy_error() const { return std::abs(energy() / start_energy - 1); }
};

/// Two bodies on an orbit with the semi-major axis 1 and the period 2 pi, at the pericentre.
std::unique_ptr<System> kepler(double eccentricity, double step, Method method) {
  auto system = std::make_unique<System>(2, step, method);
  double const speed = std::sqrt((1 + eccentricity) / (1 - eccentricity));
  auto& bodies = system->bodies;
  bodies[0].mass = 0.75, bodies[1].mass = 0.25;
  bodies[0].position = {-0.25 * (1 - eccentricity), 0, 0}, bodies[1].position = {0.75 * (1 - eccentricity), 0, 0};
  bodies[0].velocity = {0, -0.25 * speed, 0}, bodies[1].velocity = {0, 0.75 * speed, 0};
  system->begin();
  return system;
}

/// How far the bodies are from where they should be relative to each other at t = 2, on the way from the pericentre: a
/// whole orbit would hide what is symmetric.
double kepler_error(Method method, int steps, double tolerance) {
  double const e = 0.3, time = 2;
  auto const system = kepler(e, time / steps, method);
  system->simulation.tolerance(tolerance);
  system->simulation.run(static_cast<std::uint64_t>(steps));
  auto const exact = exact::orbit_state({.semi_major_axis = 1, .eccentricity = e, .mean_anomaly = time}, 1);
  return magnitude(system->bodies[1].position - system->bodies[0].position - exact.position);
}

TEST(FewBodies, OrdersOnAKeplerOrbit) {
  auto const order = [](char const* name, double coarse, double fine, double ratio) {
    double const measured = std::log(coarse / fine) / std::log(ratio);
    std::printf("[  ORDER   ] %-14s %.2f  (errors %.3g %.3g)\n", name, measured, coarse, fine);
    return measured;
  };
  auto const four = [](int steps) { return kepler_error(Method::symplectic_4, steps, 1e-9); };
  // The constant of the fourth order is small: long steps seem to have a higher one.
  for (int const steps : {20, 40}) order("symplectic-4", four(steps), four(2 * steps), 2);
  EXPECT_NEAR(order("symplectic-4", four(80), four(160), 2), 4, 0.3);
  EXPECT_NEAR(order("symplectic-4", four(160), four(320), 2), 4, 0.3);
  // So large a tolerance shortens no step.
  auto const fifteen = [](int steps) { return kepler_error(Method::gauss_radau, steps, 1e-2); };
  EXPECT_NEAR(order("gauss-radau", fifteen(2), fifteen(4), 2), 15, 2);
}

TEST(FewBodies, Symplectic4IsBetterForTheSameWork) {
  double const here = kepler_error(Method::symplectic_4, 20, 1e-9), rk4 = kepler_error(Method::rk4, 30, 1e-9),
               leap_frog = kepler_error(Method::leap_frog, 120, 1e-9);
  std::printf("[  WORK    ] 120 evaluations: symplectic-4 %.2g, rk4 %.2g, leap-frog %.2g\n", here, rk4, leap_frog);
  EXPECT_LT(here, 0.05 * rk4);
  EXPECT_LT(here, 0.01 * leap_frog);
}

TEST(FewBodies, Symplectic4KeepsTheEnergyWithinBounds) {
  auto const system = kepler(0.3, 2 * pi / 60, Method::symplectic_4);
  double early = 0, late = 0;
  for (int orbit = 0; orbit < 1000; ++orbit) {
    system->simulation.run(17);  // not always at the same place
    double& worst = orbit < 100 ? early : late;
    worst = std::max(worst, system->energy_error());
  }
  std::printf("[  ENERGY  ] %.3g in the first tenth, %.3g later\n", early, late);
  EXPECT_LT(late, 1.1 * early);
  EXPECT_LT(early, 1e-5);
}

TEST(FewBodies, Symplectic4GoesBackToTheStart) {
  auto const system = kepler(0.5, 2 * pi / 60, Method::symplectic_4);
  auto const start = system->bodies[1].position;
  system->simulation.run(1000);
  system->simulation.rewind(1000);
  EXPECT_LT(magnitude(system->bodies[1].position - start), 1e-10);
}

// An orbit of eccentricity 0.99 comes back, whatever the step of the run.
TEST(FewBodies, GaussRadauFollowsEccentricOrbits) {
  for (double const eccentricity : {0.3, 0.9, 0.99})
    for (int const steps : {1, 100}) {
      auto const system = kepler(eccentricity, 2 * pi / steps, Method::gauss_radau);
      system->simulation.run(static_cast<std::uint64_t>(100 * steps));
      double const missed = magnitude(system->bodies[1].position - Vector{0.75 * (1 - eccentricity), 0., 0.});
      auto const& counts = system->simulation.gauss_radau().counts();
      std::printf(
          "[  KEPLER  ] e = %.2f, %d steps an orbit: energy %.2g, position %.2g, %.1f steps of its own an orbit, "
          "%.1f evaluations each, %.1f %% done again\n",
          eccentricity, steps, system->energy_error(), missed, static_cast<double>(counts.steps) / 100,
          static_cast<double>(counts.evaluations) / static_cast<double>(counts.steps),
          100. * static_cast<double>(counts.rejected) / static_cast<double>(counts.steps));
      EXPECT_LT(system->energy_error(), 1e-13 / (1 - eccentricity));
      // At the pericentre: an error of the time of 1e-11 at the speed there.
      EXPECT_LT(missed, 1e-11 * std::sqrt(1 / (1 - eccentricity)) / (1 - eccentricity));
    }
}

// The figure of eight of C. Moore, A. Chenciner and R. Montgomery, with 14 digits of its start.
TEST(FewBodies, GaussRadauClosesTheFigureOfEightAHundredTimes) {
  System system(3, 6.325913982926326, Method::gauss_radau);
  auto& bodies = system.bodies;
  for (auto& body : bodies) body.mass = 1;
  bodies[0].position = {0.97000435669734, -0.24308753153583, 0};
  bodies[1].position = -bodies[0].position;
  bodies[2].velocity = {-0.93240737144104, -0.86473146092102, 0};
  bodies[0].velocity = bodies[1].velocity = bodies[2].velocity * -0.5;
  auto const start = bodies[0].position;
  system.begin();
  system.simulation.run(100);
  double const missed = magnitude(bodies[0].position - start);
  std::printf("[  EIGHT   ] after 100 periods %.2g from the start, energy %.2g\n", missed, system.energy_error());
  EXPECT_LT(missed, 1e-10);
  EXPECT_LT(system.energy_error(), 1e-13);
}

TEST(FewBodies, GaussRadauGoesBackToTheStart) {
  auto const system = kepler(0.9, 1.3, Method::gauss_radau);
  auto const start = system->bodies[1].position;
  system->simulation.run(50);
  EXPECT_GT(magnitude(system->bodies[1].position - start), 0.01);
  system->simulation.rewind(50);
  EXPECT_EQ(system->simulation.step(), 0);
  EXPECT_LT(magnitude(system->bodies[1].position - start), 1e-10);
}

TEST(FewBodies, GaussRadauHasTheSameBitsInPieces) {
  auto const whole = kepler(0.8, 0.37, Method::gauss_radau), pieces = kepler(0.8, 0.37, Method::gauss_radau),
             resumed = kepler(0.8, 0.37, Method::gauss_radau);
  whole->simulation.run(40);
  pieces->simulation.run(15);
  auto const state = pieces->simulation.state();
  for (std::size_t i = 0; i < 2; ++i) resumed->bodies[i] = pieces->bodies[i];
  resumed->simulation.restore(15, 0.37, 1, state);
  pieces->simulation.run(25);
  resumed->simulation.run(25);
  std::size_t const bytes = 2 * whole->bodies.stride() * sizeof(double);
  EXPECT_EQ(std::memcmp(whole->bodies.row(0), pieces->bodies.row(0), bytes), 0);
  EXPECT_EQ(std::memcmp(whole->bodies.row(0), resumed->bodies.row(0), bytes), 0);
  EXPECT_EQ(message([&] { resumed->simulation.restore(15, 0.37, 1, std::span(state).first(state.size() - 1)); }),
            "the checkpoint does not fit this simulation: its state has another length");
}

TEST(FewBodies, GaussRadauHasTheSameBitsForAnyNumberOfThreads) {
  auto const cloud = [](int threads) {
    struct Cloud {
      Ensemble<Newton<3>> points{"points", 9'000};
      PairScheme scheme{space()};
      Simulation simulation{scheme, 0.5};
    };
    auto all = std::make_unique<Cloud>();
    for (std::size_t i = 0; i < all->points.size(); ++i) {
      double const k = static_cast<double>(i);
      all->points[i].position = {std::sin(k), std::sin(1.7 * k + 0.3), std::sin(2.9 * k + 1)};
      all->points[i].velocity = {0.1 * std::cos(k), 0, 0};
    }
    all->scheme.external(all->points, [](auto const& p) { return p.position * -norm2(p.position); });
    all->simulation.integrate(all->points, Method::gauss_radau);
    all->simulation.threads(threads);
    all->simulation.run(2);
    return all;
  };
  auto const one = cloud(1), three = cloud(3);
  EXPECT_GT(one->simulation.gauss_radau().counts().steps, 1U);
  EXPECT_EQ(
      std::memcmp(one->points.row(0), three->points.row(0), one->points.size() * one->points.stride() * sizeof(double)),
      0);
}

// Influences that depend on velocities, and on time, need no care.
TEST(FewBodies, GaussRadauInAMagneticField) {
  Ensemble<Coulomb<3>> ion("ion", 1);
  ion[0].mass = 2, ion[0].charge = 3;
  ion[0].velocity = {1, 0, 0.5};
  PairScheme scheme(space());
  scheme.external(ion, UniformMagneticField<3>{{0, 0, 4}});  // six radians a time unit
  Simulation simulation(scheme, pi / 3);
  simulation.integrate(ion, Method::gauss_radau);
  simulation.run(100);
  EXPECT_NEAR(ion[0].position[0], 0, 1e-12);
  EXPECT_NEAR(ion[0].position[1], 0, 1e-12);
  EXPECT_NEAR(ion[0].position[2], 0.5 * 100 * pi / 3, 1e-12);
  EXPECT_NEAR(ion[0].velocity[0], 1, 1e-12);
}

TEST(FewBodies, GaussRadauOfADrivenParticle) {
  Ensemble<Newton<1>> particle("particle", 1);
  PairScheme scheme(Box(Vector{-9.}, Vector{9.}));
  scheme.external(particle, [](auto const&, double time) { return Vector{std::cos(time)}; });
  Simulation simulation(scheme, 2);
  simulation.integrate(particle, Method::gauss_radau);
  simulation.run(3);
  EXPECT_NEAR(particle[0].position[0], 1 - std::cos(6.0), 1e-13);
}

// First derivatives alone: a tracer goes round with a fluid that turns like a solid.
TEST(FewBodies, GaussRadauOfFirstDerivatives) {
  Ensemble<Tracer<2>> tracer("tracer", 1);
  tracer[0].position = {1, 0};
  PairScheme scheme(Box(Vector{-2., -2.}, Vector{2., 2.}));
  scheme.external(tracer, [](auto const& p) { return cross(Vector{1.0}, p.position); });
  Simulation simulation(scheme, 2 * pi);
  simulation.integrate(tracer, Method::gauss_radau);
  simulation.run(10);
  EXPECT_LT(magnitude(tracer[0].position - Vector{1., 0.}), 1e-12);
}

// Two atoms fly apart through the cut-off, where the force jumps: steps become short there, and go on.
TEST(FewBodies, GaussRadauCrossesACutOff) {
  Ensemble<Newton<3>> atoms("atoms", 2);
  atoms[1].position = {1.05, 0, 0};
  atoms[1].velocity = {3, 0, 0};
  PairScheme scheme(space(), 2.5);
  scheme.internal(atoms, LennardJones{1, 1});
  Simulation simulation(scheme, 0.5);
  simulation.integrate(atoms, Method::gauss_radau);
  auto const energy = [&] {
    return 0.5 * (norm2(atoms[0].velocity) + norm2(atoms[1].velocity)) + simulation.measure().potential;
  };
  double const start = energy();
  simulation.run(4);
  EXPECT_GT(atoms[1].position[0] - atoms[0].position[0], 3);
  EXPECT_NEAR(energy(), start, 1e-9);
}

struct Friction {
  static constexpr bool velocity_dependent = true;
  Vector<3> operator()(Kepler<3> const& p) const { return -p.velocity; }
};

TEST(FewBodies, WhatDoesNotGoTogetherIsRefused) {
  Ensemble<Kepler<3>> sun("sun", 1), planets("planets", 1);
  planets[0].position = {1, 0, 0};
  PairScheme scheme(space());
  scheme.between(sun, planets, gravity(1.0));
  Simulation simulation(scheme, 0.1);
  simulation.integrate(sun, Method::leap_frog);
  simulation.integrate(planets, Method::gauss_radau);
  EXPECT_EQ(message([&] { simulation.check(); }),
            "ensemble 'planets' moves by gauss-radau, which advances all ensembles together; 'sun' moves by leap-frog: "
            "use gauss-radau for all (or deactivate)");
  simulation.integrate(sun, Method::deactivate);
  EXPECT_EQ(message([&] { simulation.check(); }), "no error");
  EXPECT_EQ(message([&] { simulation.tolerance(0); }), "the tolerance is a number between 1e-14 and 0.01, not 0");

  Ensemble<Viscous<2>> viscous("viscous", 1);
  EXPECT_NE(message([&] { make_integrator(viscous, Method::gauss_radau); }).find("viscous vortices diffuse"),
            std::string::npos);
  Ensemble<Kepler<3>> body("body", 1);
  PairScheme drag(space());
  drag.external(body, Friction{});
  Simulation falling(drag, 0.1);
  falling.integrate(body, Method::symplectic_4);
  EXPECT_EQ(
      message([&] { falling.check(); }),
      "influences on ensemble 'body' depend on velocities, which symplectic-4 can't follow; use leap-frog, rk4 or "
      "gauss-radau");
}

// Two bodies at rest fall into each other at t = pi / (2 sqrt 2): nothing goes on from there.
TEST(FewBodies, GaussRadauSaysWhereBodiesMeet) {
  System system(2, 2.0, Method::gauss_radau);
  system.bodies[0].mass = system.bodies[1].mass = 0.5;
  system.bodies[1].position = {1, 0, 0};
  std::string const said = message<PhysicsFailure>([&] { system.simulation.run(1); });
  EXPECT_NE(said.find("step 1: gauss-radau finds no step"), std::string::npos) << said;
  EXPECT_NE(said.find("of 'bodies' is smooth: particles meet"), std::string::npos) << said;
}

}  // namespace
}  // namespace boltzmann::few_bodies_test
