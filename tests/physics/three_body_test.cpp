// Three bodies: the figure-8 closes, the Pythagorean problem has its energy and its closest approach.
#include "shipped.hpp"

#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/particles/laplace.hpp>

#include <gtest/gtest.h>

namespace boltzmann::three_body_test {
namespace {

TEST(ThreeBody, Figure8Closes) {
  auto const run = shipped("three-body");
  auto& bodies = *run->ensembles.front();
  double start[9];
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 3; ++a) start[3 * i + a] = bodies.row(i)[a];
  EXPECT_NEAR(total_energy(*run), -1.287141991766, 1e-9);
  double const period = 6.32591398;
  run->simulation->run(std::llround(period / run->simulation->step_size()));
  EXPECT_NEAR(run->simulation->time(), period, 1e-6);
  double distance = 0;
  for (int i = 0; i < 3; ++i)
    for (int a = 0; a < 3; ++a) distance = std::max(distance, std::abs(bodies.row(i)[a] - start[3 * i + a]));
  EXPECT_LT(distance, 2e-7);
  EXPECT_NEAR(total_energy(*run), -1.287141991766, 1e-8);
}

TEST(ThreeBody, PythagoreanEnergyAndScenario) {
  auto const run = shipped("pythagorean");
  EXPECT_NEAR(total_energy(*run), -12.816666667, 1e-8);
  run->simulation->run(run->steps / 4);
  EXPECT_NEAR(total_energy(*run), -12.816666667, 1e-4);
}

// Closest approach 4.138e-4 at t = 15.82992, between the masses 4 and 5.
TEST(ThreeBody, PythagoreanClosestApproach) {
  Ensemble<Kepler<3>> bodies("bodies", 3);
  double const mass[3] = {3, 4, 5}, x[3] = {1, -2, 1}, y[3] = {3, -1, -1};
  for (int i = 0; i < 3; ++i) bodies[i].mass = mass[i], bodies[i].position = {x[i], y[i], 0};
  PairScheme space(Box(Vector{-9., -9., -9.}, Vector{9., 9., 9.}));
  space.internal(bodies, gravity(1.0));
  Simulation simulation(space, 1e-3);
  simulation.integrate(bodies, Method::rk4);
  double closest = 1, when = 0;
  while (simulation.time() < 15.9) {
    // The step follows the closest pair: a few thousandths of its free-fall time.
    double nearest = 1e9;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j) nearest = std::min(nearest, magnitude(bodies[i].position - bodies[j].position));
    simulation.step_size(0.004 * std::pow(nearest, 1.5));
    simulation.run(1);
    double const d = magnitude(bodies[1].position - bodies[2].position);
    if (d < closest) closest = d, when = simulation.time();
  }
  std::printf("[  CLOSEST ] %.4g at t = %.5f\n", closest, when);
  EXPECT_NEAR(when, 15.82992, 2e-4);
  EXPECT_NEAR(closest, 4.138e-4, 0.03e-4);
}

}  // namespace
}  // namespace boltzmann::three_body_test
