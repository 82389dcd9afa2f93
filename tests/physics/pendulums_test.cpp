// Two coupled pendulums (section 6.1): normal modes, and the energy that the printed torques would not keep.
#include "shipped.hpp"

#include <boltzmann/laws/pendulum.hpp>
#include <boltzmann/particles/pendulum.hpp>

#include <gtest/gtest.h>

namespace boltzmann::pendulums_test {
namespace {

TEST(Pendulums, EnergyIsConserved) {
  auto const run = shipped("pendulums");
  double const start = total_energy(*run);
  double largest = 0;
  for (int k = 0; k < 100; ++k) {
    run->simulation->run(run->steps / 100);
    largest = std::max(largest, std::abs(total_energy(*run) - start));
  }
  // m g l (1 - cos 0.3 pi) and the stretched spring are in it.
  EXPECT_GT(start, 41);
  EXPECT_LT(largest / start, 2e-3);
}

// Small swings: in phase the spring keeps its length, omega^2 = g / l; in opposition it is stretched twice, omega^2 = g
// / l + 2 kappa / m.
double period(double first, double second) {
  double const m = 1, length = 10, g = 10;
  Ensemble<Pendulum<>> pendulums("pendulums", 2);
  for (int i = 0; i < 2; ++i) {
    pendulums[i].bob_mass = m;
    pendulums[i].length = length;
    pendulums[i].mass = m * length * length;
    pendulums[i].pivot = {3.0 + 4.0 * i, 5.0};
  }
  pendulums[0].position = {first};
  pendulums[1].position = {second};
  PairScheme space(Box(Vector{-4.}, Vector{4.}));
  space.internal(pendulums, PendulumCoupling{.stiffness = 0.8, .rest_length = 4});
  space.external(pendulums, PendulumGravity{g});
  Simulation simulation(space, 0.001);
  simulation.integrate(pendulums, Method::rk4);
  // From the turning point to the first passage of zero: a quarter of a period.
  double before = first;
  for (int n = 0; n < 20000; ++n) {
    simulation.run(1);
    double const now = pendulums[0].position[0];
    if (before * now <= 0) return 4 * (simulation.time() - 0.001 * now / (now - before));
    before = now;
  }
  return 0;
}

TEST(Pendulums, NormalModes) {
  EXPECT_NEAR(period(1e-3, 1e-3), 2 * pi / std::sqrt(1.0), 1e-5);
  EXPECT_NEAR(period(1e-4, -1e-4), 2 * pi / std::sqrt(1.0 + 2 * 0.8), 1e-4);
}

}  // namespace
}  // namespace boltzmann::pendulums_test
