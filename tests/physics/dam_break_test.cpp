// A dam breaks (Martin and Moyce, Phil. Trans. R. Soc. A 244, 312, 1952): a column of water of width a and height 2a,
// set free at once. First it moves as potential theory has it; then its front runs along the floor.
#include <tests/physics/shipped.hpp>

#include <boltzmann/laws/materials/tait.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>
#include <optional>

namespace boltzmann::dam_break_test {
namespace {

/// Water that can't be compressed, once the wall at x = 1 is gone, floor at 0, free surface at 2, density and gravity
/// 1: its pressure p solves Laplace's equation with p = 0 on the free sides, dp/dx = 0 on the wall at x = 0, dp/dy = -1
/// on the floor. p = Sum_n 2 (-1)^(n-1) / (k^2 cosh 2k) sinh(k (2 - y)) cos(k x), k = (n - 1/2) pi.
double released_pressure(double x, double y) {
  double sum = 0;
  for (int n = 1; n <= 40; ++n) {
    double const k = (n - 0.5) * std::numbers::pi;
    double const part = (std::exp(-k * y) - std::exp(-k * (4 - y))) / (1 + std::exp(-4 * k));
    sum += (n % 2 == 1 ? 2 : -2) / (k * k) * part * std::cos(k * x);
  }
  return sum;
}
/// And the acceleration of the centre of mass: the force on the wall, Sum_n 2 (-1)^(n-1) / k^3 (1 - 1 / cosh 2k), over
/// the mass.
double released_acceleration() {
  double sum = 0;
  for (int n = 1; n <= 40; ++n) {
    double const k = (n - 0.5) * std::numbers::pi;
    sum += (n % 2 == 1 ? 2 : -2) / (k * k * k) * (1 - 1 / std::cosh(2 * k));
  }
  return sum / 2;
}

struct Dam {
  static constexpr std::size_t columns = 20;
  static constexpr double spacing = 1.0 / columns;
  Tait water{.reference_density = 1, .sound_speed = 20};
  Ensemble<Smooth<2>> column{"water", 2 * columns* columns};
  std::optional<SmoothScheme> scheme;
  std::optional<Simulation> simulation;

  /// With the pressure of a column at rest, or with that of one just set free.
  explicit Dam(bool released) {
    Box box(Vector{0.0, 0.0}, Vector{9.0, 3.0}, Boundary::mirror);
    box.open_end(1, Box::End::high);
    block_load(column, {Lattice::square, spacing, {columns, 2 * columns, 1}, {spacing / 2, spacing / 2, 0}});
    nudge(column);
    for (auto& p : column) {
      double const x = p.position[0], y = p.position[1], pressure = released ? released_pressure(x, y) : 2 - y;
      p.density = std::pow(1 + pressure / water.stiffness(), 1 / water.gamma);
      p.mass = p.density * spacing * spacing;
      p.range = 2.6 * spacing;
    }
    scheme.emplace(box, WeightShape::wendland);
    scheme->material(column, water);
    scheme->density_from(DensityFrom::continuity);
    scheme->artificial_viscosity({.alpha = 0.05, .beta = 0});
    scheme->external(column, UniformGravity<2>{Vector{0.0, -1.0}});
    simulation.emplace(*scheme, 0.6 * scheme->courant_step());
    simulation->integrate(column, Method::leap_frog);
    simulation->check();
  }
  void run_to(double time) {
    simulation->run(static_cast<std::uint64_t>(std::round((time - simulation->time()) / simulation->step_size())));
  }
  double front() const {
    double front = 0;
    for (auto const& p : column) front = std::max(front, p.position[0] + spacing / 2);
    return front;
  }
  double centre() const {
    double moment = 0, mass = 0;
    for (auto const& p : column) {
      moment += p.mass * p.position[0];
      mass += p.mass;
    }
    return moment / mass;
  }
  double kinetic() const {
    double sum = 0;
    for (auto const& p : column) sum += 0.5 * p.mass * norm2(p.velocity);
    return sum;
  }
};

TEST(DamBreak, BeginsAsPotentialTheoryHasIt) {
  double const acceleration = released_acceleration();
  EXPECT_NEAR(acceleration, 0.2277, 0.0002);  // by hand, three terms
  Dam dam(true);
  double const start = dam.centre();
  for (double const time : {0.1, 0.15}) {
    dam.run_to(time);
    EXPECT_NEAR((dam.centre() - start) / (0.5 * acceleration * time * time), 1, 0.015) << time;
  }
}

// Martin and Moyce, a = 1.125 in: Z = z/a at T = t sqrt(2g/a). In the experiment the wall took time to go: its front is
// at 1.245 when T = 0.849, here 0.23 earlier (so that at the same T it is 8 to 16 % ahead up to T = 3.9). From there on
// both keep pace to 4 %, but for the last point: on the real floor a film of water is slow.
TEST(DamBreak, FrontRunsAsInTheExperiment) {
  Dam dam(false);
  auto const energy = [&] {
    EnergyAndVirial const m = dam.scheme->measure();
    return dam.kinetic() + m.internal + m.external;
  };
  double const start = energy();
  double shift = 0;
  while (dam.front() < 1.245) dam.simulation->run(5);
  shift = 0.849 - dam.simulation->time() * std::numbers::sqrt2;
  EXPECT_GT(shift, 0);
  EXPECT_LT(shift, 0.35);
  for (auto const& [t, z] : {std::pair{1.602, 1.884}, {2.95, 3.728}, {3.905, 4.999}}) {
    dam.run_to((t - shift) / std::numbers::sqrt2);
    EXPECT_NEAR(dam.front() / z, 1, 0.05) << t;
  }
  dam.run_to((5.316 - shift) / std::numbers::sqrt2);
  EXPECT_NEAR(dam.front() / 6.717, 1, 0.15);
  EXPECT_GT(dam.front(), 6.717);
  // Nothing but artificial viscosity takes energy, and little: a part of what the fall has set free.
  double const fallen = dam.kinetic();
  EXPECT_GT(fallen, 0.8);
  EXPECT_LT(energy(), start);
  EXPECT_GT(energy(), start - 0.1 * fallen);
  for (auto const& p : dam.column) EXPECT_NEAR(p.density, 1, 0.01);
}

TEST(DamBreak, ScenarioRuns) {
  auto const run = shipped("dam-break");
  AnyEnsemble const& water = ensemble(*run, "water");
  auto const total = [&] {
    EnergyAndVirial const m = run->simulation->measure();
    return kinetic_energy(*run) + m.internal + m.external;
  };
  run->simulation->run(0);
  double const start = total();
  run->simulation->run(800);
  double front = 0;
  for (std::size_t i = 0; i < water.size(); ++i) front = std::max(front, water.row(i)[0]);
  double const time = run->simulation->time();
  EXPECT_GT(front, 1.0);
  EXPECT_LT(front, 1 + 2 * std::numbers::sqrt2 * time);  // what shallow water can do at most
  EXPECT_NEAR(total(), start, 0.01);
}

}  // namespace
}  // namespace boltzmann::dam_break_test
