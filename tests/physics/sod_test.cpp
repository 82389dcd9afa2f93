// Sod's shock tube (scenarios/sod.toml) against the exact solution of the Riemann problem.
#include <tests/physics/shipped.hpp>
#include <tests/physics/smooth_gas.hpp>

#include <boltzmann/exact/riemann.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <utility>
#include <vector>

namespace boltzmann::sod_test {
namespace {

using exact::GasState, exact::Riemann;

constexpr double end_time = 0.2;
constexpr GasState left_state{1, 0, 1}, right_state{0.125, 0, 0.1};

struct Tube {
  double error;  ///< mean over space of |density - exact|
  double shock;  ///< where the density is half way between both sides of the shock, by where it should be
  double pressure, velocity, left_density, right_density;  ///< in the middle of both plateaus, by exact
  double energy_drift;
};

/// A tube of so many particles in the length 1, and so many across (periodic). Equal masses: the right side has eight
/// times fewer in 1D; else equal spacings, the right ones lighter.
template <int D>
Tube run_tube(double gamma, std::size_t along, std::size_t across, bool equal_masses) {
  Riemann const exact = exact::sod(gamma);
  double const spacing = 1.0 / static_cast<double>(along), width = spacing * static_cast<double>(across);
  Ensemble<Smooth<D>> gas("gas", along);
  Vector<D> low{}, high{};
  low[0] = -0.5, high[0] = 0.5;
  std::array<Boundary, D> boundaries;
  boundaries.fill(Boundary::periodic);
  boundaries[0] = Boundary::mirror;
  std::array<std::size_t, D> counts;
  counts.fill(across);
  counts[0] = along;
  for (int a = 1; a < D; ++a) high[a] = width;
  if (equal_masses) {
    std::size_t const on_the_left = along * 8 / 9;
    double const mass = 0.5 / static_cast<double>(on_the_left);
    for (std::size_t i = 0; i < along; ++i) {
      gas[i].mass = mass;
      gas[i].position[0] = i < on_the_left ? (static_cast<double>(i) + 0.5) * mass - 0.5
                                           : (static_cast<double>(i - on_the_left) + 0.5) * 8 * mass;
    }
    high[0] = static_cast<double>(along - on_the_left) * 8 * mass;
  } else {
    fill(gas, low, spacing, counts);
  }
  for (auto& p : gas) {
    GasState const& state = p.position[0] < 0 ? left_state : right_state;
    if (!equal_masses) p.mass = state.density * std::pow(spacing, D);
    p.specific_energy = state.pressure / ((gamma - 1) * state.density);
    p.range = 3 * spacing;
  }
  SmoothScheme scheme(Box(low, high, boundaries));
  scheme.material(gas, IdealGas{gamma});
  scheme.artificial_viscosity({});
  scheme.heating(Heating::own);
  scheme.variable_range({.spacings = 3});
  Simulation simulation(scheme, 1e-6);
  simulation.integrate(gas, Method::leap_frog);
  double const start = total_energy(scheme, gas);
  run_by_courant(simulation, scheme, end_time, 0.5, 1);
  Tube tube{};
  tube.energy_drift = std::abs(total_energy(scheme, gas) / start - 1);
  scheme.complete(end_time);
  std::array<double, 4> sums{}, numbers{};
  double space = 0;
  std::vector<std::pair<double, double>> profile;  // density over x/t
  double const contact = exact.star_velocity(), half = 0.5 * (exact.right_density() + right_state.density);
  for (auto const& p : gas) {
    double const speed = p.position[0] / end_time, volume = p.mass / p.density;
    tube.error += volume * std::abs(p.density - exact.at(speed, 1).density);
    space += volume;
    profile.emplace_back(speed, p.density);
    bool const left = speed > 0.2 && speed < contact - 0.15;
    bool const right = speed > contact + 0.15 && speed < exact.shock_speed() - 0.2;
    if (left || right) {
      sums[0] += p.pressure, ++numbers[0];
      sums[1] += p.velocity[0], ++numbers[1];
      sums[left ? 2 : 3] += p.density, ++numbers[left ? 2 : 3];
    }
  }
  tube.error /= space;
  std::sort(profile.begin(), profile.end());
  std::size_t front = profile.size() - 1;
  while (profile[front].second < half) --front;
  auto const [inside, above] = profile[front];
  auto const [outside, below] = profile[front + 1];
  tube.shock = (inside + (outside - inside) * (above - half) / (above - below)) / exact.shock_speed();
  tube.pressure = sums[0] / numbers[0] / exact.star_pressure();
  tube.velocity = sums[1] / numbers[1] / exact.star_velocity();
  tube.left_density = sums[2] / numbers[2] / exact.left_density();
  tube.right_density = sums[3] / numbers[3] / exact.right_density();
  return tube;
}

void expect_near_exact(Tube const& tube, double error, double shock, double plateau) {
  EXPECT_LT(tube.error, error);
  EXPECT_NEAR(tube.shock, 1, shock);
  EXPECT_NEAR(tube.pressure, 1, plateau);
  EXPECT_NEAR(tube.velocity, 1, plateau);
  EXPECT_NEAR(tube.left_density, 1, plateau);
  EXPECT_NEAR(tube.right_density, 1, plateau);
  EXPECT_LT(tube.energy_drift, 2e-5);
}

class SodIn1D : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(Gammas, SodIn1D, testing::Values(1.4, 5.0 / 3));

TEST_P(SodIn1D, WithEqualSpacings) { expect_near_exact(run_tube<1>(GetParam(), 400, 1, false), 0.007, 0.005, 0.01); }
TEST_P(SodIn1D, WithEqualMasses) { expect_near_exact(run_tube<1>(GetParam(), 400, 1, true), 0.008, 0.01, 0.01); }

TEST(Sod, In2D) { expect_near_exact(run_tube<2>(1.4, 200, 12, false), 0.012, 0.015, 0.02); }
TEST(Sod, In3D) { expect_near_exact(run_tube<3>(1.4, 100, 8, false), 0.015, 0.02, 0.03); }

TEST(Sod, AsItIsShipped) {
  auto const run = shipped("sod");
  auto& gas = dynamic_cast<Ensemble<Smooth<1>>&>(ensemble(*run, "gas"));
  ASSERT_EQ(gas.size(), 400u);
  run->simulation->run(static_cast<std::uint64_t>(run->steps));
  double const time = run->simulation->time();
  EXPECT_NEAR(time, end_time, 2e-3 * end_time);
  Riemann const exact = exact::sod();
  double error = 0;
  for (auto const& p : gas) error += p.mass / p.density * std::abs(p.density - exact.at(p.position[0], time).density);
  EXPECT_LT(error, 0.007);
}

}  // namespace
}  // namespace boltzmann::sod_test
