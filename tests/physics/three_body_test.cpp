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

// Through all encounters to the escape of the mass 3. Positions of the masses 3 and 4 from a calculation in quadruple
// precision (extrapolation of order 28, relative tolerance 1e-27); what is wrong grows some 10^10 times on the way.
TEST(ThreeBody, PythagoreanToTheEscape) {
  auto const run = shipped("pythagorean");
  auto& bodies = *run->ensembles.front();
  double const start = total_energy(*run);
  EXPECT_NEAR(start, -12.816666667, 1e-8);
  struct Known {
    double time, x3, y3, x4, y4, error;
  };
  double worst = 0;
  run->simulation->observe(
      50, [&](Simulation const&) { worst = std::max(worst, std::abs(total_energy(*run) / start - 1)); });
  for (auto const& known :
       {Known{10, 0.7784804101380855, 0.1413923002900862, -2.025092477978199, 0.09721938414605839, 1e-10},
        {20, 3.004292636696399, 0.5119252350246859, -1.388626537510895, -0.4704760502527222, 1e-7},
        {40, -0.6220036918010971, 1.858318157899773, 0.1735445568164398, -2.368410443283164, 1e-4},
        {60, 0.7438075001180829, 1.939947951094863, 0.2640103346862566, -0.7316243948699637, 0.01},
        {70, 6.933463599011887, 20.26180430595171, -2.003006002605982, -6.872463435824545, 0.05}}) {
    run->simulation->run(static_cast<std::uint64_t>(std::llround(known.time / 0.02) - run->simulation->step()));
    EXPECT_NEAR(run->simulation->time(), known.time, 1e-10);
    double const missed = std::hypot(bodies.row(0)[0] - known.x3, bodies.row(0)[1] - known.y3,
                                     std::hypot(bodies.row(1)[0] - known.x4, bodies.row(1)[1] - known.y4));
    std::printf("[ PYTHAGOR ] t = %g: position %.2g, energy %.2g\n", known.time, missed,
                std::abs(total_energy(*run) / start - 1));
    EXPECT_LT(missed, known.error);
    EXPECT_LT(std::abs(total_energy(*run) / start - 1), 1e-12);
  }
  EXPECT_EQ(run->simulation->step(), run->steps);
  EXPECT_LT(worst, 1e-11);  // where bodies are near each other, positions themselves have too few digits for more
  auto const& counts = run->simulation->gauss_radau().counts();
  std::printf("[ PYTHAGOR ] %g steps, %g done again, %g evaluations\n", static_cast<double>(counts.steps),
              static_cast<double>(counts.rejected), static_cast<double>(counts.evaluations));
}

// Closest approach 4.138e-4 at t = 15.82992, between the masses 4 and 5.
TEST(ThreeBody, PythagoreanClosestApproach) {
  Ensemble<Kepler<3>> bodies("bodies", 3);
  double const mass[3] = {3, 4, 5}, x[3] = {1, -2, 1}, y[3] = {3, -1, -1};
  for (int i = 0; i < 3; ++i) bodies[i].mass = mass[i], bodies[i].position = {x[i], y[i], 0};
  PairScheme space(Box(Vector{-9., -9., -9.}, Vector{9., 9., 9.}));
  space.internal(bodies, gravity(1.0));
  Simulation simulation(space, 15.82985);
  simulation.integrate(bodies, Method::gauss_radau);
  simulation.run(1);
  simulation.step_size(2e-8);  // a hundredth of the distance at the speed there
  double closest = 1, when = 0;
  while (simulation.time() < 15.83) {
    simulation.run(1);
    double const d = magnitude(bodies[1].position - bodies[2].position);
    if (d < closest) closest = d, when = simulation.time();
  }
  std::printf("[  CLOSEST ] %.4g at t = %.5f\n", closest, when);
  EXPECT_NEAR(when, 15.82992, 1e-5);
  EXPECT_NEAR(closest, 4.138e-4, 0.002e-4);
}

}  // namespace
}  // namespace boltzmann::three_body_test
