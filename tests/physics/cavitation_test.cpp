// Cavitation: van der Waals' liquid under tension, up to the density at which it can bear no more (the spinodal, where
// the speed of sound is zero) and beyond, where voids open.
#include <tests/physics/shipped.hpp>
#include <tests/seed.hpp>

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/diagnoses/smooth_field.hpp>
#include <boltzmann/laws/materials/van_der_waals.hpp>
#include <boltzmann/loaders/jitter.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

namespace boltzmann::cavitation_test {
namespace {

// In units of the critical density and temperature, six degrees of freedom.
constexpr double a = 9.0 / 8, b = 1.0 / 3, freedom = 6;
constexpr double first_density = 2, first_temperature = 0.7;
constexpr VanDerWaals liquid{a, b, 1, freedom};

// The isentrope through the first state: T (1/rho - b)^(2/f) is constant.
double temperature(double density) {
  double const ratio = density / (1 - b * density) * (1 - b * first_density) / first_density;
  return first_temperature * std::pow(ratio, 2 / freedom);
}
double pressure(double density) { return density * temperature(density) / (1 - b * density) - a * density * density; }
/// dP/drho along it, by differences: nothing of the code under test is in it.
double stiffness(double density) { return (pressure(density + 1e-5) - pressure(density - 1e-5)) / 2e-5; }
double spinodal() {
  double low = 1.2, high = 2;
  while (high - low > 1e-9) (stiffness((low + high) / 2) < 0 ? low : high) = (low + high) / 2;
  return low;
}

constexpr double length = 40, range = 4, k = 2 * std::numbers::pi / length;

/// Eq 8 and 13 linearised on a square lattice of spacing 1, for waves along x:
/// omega^2 = k^2 [A^2 (dP/drho - 2 P/rho) + 2 B P/rho], A = -Sum w_x sin(kx) / k, B = Sum w_xx (1 - cos(kx)) / k^2,
/// with Lucy's weight w; both are 1 where range is long beside the spacing and short beside the wave.
double expected_stiffness(double density) {
  double const norm = 5 / (std::numbers::pi * range * range);
  double A = 0, B = 0;
  for (int i = -4; i <= 4; ++i)
    for (int j = -4; j <= 4; ++j) {
      double const x = i, r = std::hypot(i, j), q = r / range;
      if (r == 0 || q >= 1) continue;
      double const slope = -12 * norm * square(1 - q) / square(range);  // w'/r
      double const curvature = -12 * norm * (1 - q) * (1 - 3 * q) / square(range);
      A -= slope * x * std::sin(k * x) / k;
      B += (curvature * square(x / r) + slope * (1 - square(x / r))) * (1 - std::cos(k * x)) / square(k);
    }
  return square(A) * (stiffness(density) - 2 * pressure(density) / density) + 2 * B * pressure(density) / density;
}

/// omega^2 / k^2 of the longest wave in a uniform liquid of that density: particles are displaced a little, and what is
/// left of the displacement a time later is cos(omega t), or cosh where it grows.
double measured_stiffness(double density) {
  constexpr double amplitude = 1e-3;
  Ensemble<Smooth<2>> fluid("fluid", 0);
  block_load(fluid, {Lattice::square, 1, {40, 10, 1}, {0.5, 0.5, 0}});
  std::vector<double> places;
  for (auto& p : fluid) {
    places.push_back(p.position[0]);
    p.position[0] += amplitude * std::sin(k * p.position[0]);
    p.mass = density;
    p.range = range;
    p.specific_energy = liquid.energy_at(density, temperature(density));
  }
  SmoothScheme scheme(Box(Vector{0.0, 0.0}, Vector{length, 10.0}, Boundary::periodic));
  scheme.material(fluid, liquid);
  scheme.complete(0);
  for (auto& p : fluid)  // displaced along the isentrope
    p.specific_energy = liquid.energy_at(p.density, temperature(p.density));
  Simulation simulation(scheme, 0.02);
  simulation.integrate(fluid, Method::rk4);
  simulation.run(100);
  double left = 0;
  for (std::size_t i = 0; i < fluid.size(); ++i)
    left += 2 * (fluid[i].position[0] - places[i]) * std::sin(k * places[i]) / static_cast<double>(fluid.size());
  double const ratio = left / amplitude, phase = ratio < 1 ? std::acos(ratio) : std::acosh(ratio);
  return (ratio < 1 ? 1 : -1) * square(phase / (simulation.time() * k));
}

TEST(Cavitation, WavesRunBeforeTheSpinodalAndGrowBehindIt) {
  double const limit = spinodal();
  EXPECT_NEAR(limit, 1.6097, 0.0005);
  for (double const density : {2.0, 1.8, 1.4, 1.2}) {
    double const expected = expected_stiffness(density);
    EXPECT_NEAR(expected / stiffness(density), 1, 0.15);
    EXPECT_NEAR(measured_stiffness(density) / expected, 1, 0.02) << density;
  }
  EXPECT_GT(measured_stiffness(1.03 * limit), 0);
  EXPECT_LT(measured_stiffness(0.97 * limit), 0);
}

TEST(Cavitation, ExpandingLiquidTearsAtTheSpinodal) {
  constexpr std::size_t side = 60;
  constexpr double rate = 0.05, half = side / 2.0;
  Ensemble<Smooth<2>> square_of_liquid("liquid", 0);
  block_load(square_of_liquid, {Lattice::square, 1, {side, side, 1}, {0.5 - half, 0.5 - half, 0}});
  jitter(square_of_liquid, {.most = 0.02, .seed = test_seed(1)});
  for (auto& p : square_of_liquid) {
    p.mass = first_density;
    p.range = 4;
    p.velocity = p.position * rate;
    p.specific_energy = liquid.energy_at(first_density, first_temperature);
  }
  Box const box(Vector{-100.0, -100.0}, Vector{100.0, 100.0});
  SmoothScheme scheme(box);
  scheme.material(square_of_liquid, liquid);
  Simulation simulation(scheme, 0.05);
  simulation.integrate(square_of_liquid, Method::leap_frog);
  simulation.check();

  std::vector<AnyEnsemble const*> const all{&square_of_liquid};
  auto const energy = [&] { return kinetic_energy(all) + scheme.measure().internal; };
  double const kinetic = kinetic_energy(all), start = energy();
  auto const momentum_before = momentum(all);

  double greatest_tension = 0, torn_at = 0;
  for (int look = 0; look < 80; ++look) {
    simulation.run(5);
    scheme.complete(simulation.time());
    double density = 0, squares = 0, mean_pressure = 0, count = 0;
    for (auto const& p : square_of_liquid)
      if (magnitude(p.position) < 0.3 * half * (1 + rate * simulation.time())) {
        density += p.density;
        squares += p.density * p.density;
        mean_pressure += p.pressure;
        ++count;
      }
    density /= count;
    mean_pressure /= count;
    double const spread = std::sqrt(std::max(0.0, squares / count - density * density)) / density;
    greatest_tension = std::max(greatest_tension, -mean_pressure);
    if (spread < 0.02) {
      EXPECT_NEAR(mean_pressure / pressure(density), 1, 0.03) << density;
    }
    if (torn_at == 0 && spread > 0.05) torn_at = density;
  }
  // The greatest tension is that of the spinodal; voids open behind it.
  EXPECT_NEAR(greatest_tension / -pressure(spinodal()), 1, 0.02);
  EXPECT_GT(torn_at, 0.9);
  EXPECT_LT(torn_at, spinodal());

  EXPECT_NEAR((energy() - start) / kinetic, 0, 2e-3);
  for (int axis = 0; axis < 2; ++axis) EXPECT_NEAR((momentum(all)[axis] - momentum_before[axis]) / kinetic, 0, 1e-12);

  // In the end: drops as dense as liquid, and emptiness between them.
  SmoothField const field(all, box);
  double const reach = 0.5 * half * (1 + rate * simulation.time());
  double empty = 0, dense = 0, points = 0;
  for (double y = -reach; y < reach; y += reach / 40) {
    auto const line = field.density(points_on_line(Vector{-reach, y}, Vector{reach, y}, 80));
    for (double const density : line.value) {
      empty += density < 0.2 ? 1 : 0;
      dense += density > 1.4 ? 1 : 0;
      ++points;
    }
  }
  EXPECT_GT(empty / points, 0.3);
  EXPECT_GT(dense / points, 0.05);
}

TEST(Cavitation, ScenarioConservesEnergy) {
  auto const run = shipped("cavitation");
  auto const total = [&] { return kinetic_energy(*run) + run->simulation->measure().internal; };
  run->simulation->run(0);
  double const start = total(), kinetic = kinetic_energy(*run);
  run->simulation->run(60);
  EXPECT_NEAR(total() - start, 0, 1e-3 * kinetic);
}

}  // namespace
}  // namespace boltzmann::cavitation_test
