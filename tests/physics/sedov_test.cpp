// Sedov's point blast (scenarios/sedov.toml) in 1D, 2D and 3D: the radius of the shock, and the flow behind it.
#include <tests/physics/shipped.hpp>
#include <tests/physics/smooth_gas.hpp>

#include <boltzmann/exact/sedov.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/weight.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <vector>

namespace boltzmann::sedov_test {
namespace {

using exact::SedovBlast;

constexpr double gamma_of_air = 1.4;

/// The radius from how far the gas has been moved outwards: Sum m (r - r at the start) / density.
double radius_of_displacement(SedovBlast const& blast, int dimension, double moved) {
  double const surface = dimension == 1 ? 2 : dimension == 2 ? 2 * pi : 4 * pi;
  double of_unit = -surface / (dimension + 1);
  constexpr int steps = 20000;
  for (int k = 0; k < steps; ++k) {
    double const x = (k + 0.5) / steps;
    of_unit += blast.at(x).density * surface * std::pow(x, dimension) / steps;
  }
  return std::pow(moved / of_unit, 1.0 / (dimension + 1));
}

struct Blast {
  double radius;          ///< from the displacement of all gas, by exact
  double front;           ///< where the mean radial velocity is half its maximum, by exact
  double kinetic_share;   ///< by exact
  double velocity_error;  ///< mean |radial velocity - exact| by mass, by the exact mean
  double energy_drift;
};

/// One half, quarter or eighth of a blast of energy 1 between mirrors, with so many particles along each edge.
template <int D>
Blast explode(std::size_t along, double spacings, double hot, double longest) {
  SedovBlast const exact(D, gamma_of_air);
  double const spacing = 1 / static_cast<double>(along), end_time = 0.5;
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) high[a] = 1;
  std::array<std::size_t, D> counts;
  counts.fill(along);
  Ensemble<Smooth<D>> gas("gas");
  fill<D>(gas, low, spacing, counts);
  nudge(gas);
  double energy = 0, moment = 0;
  for (auto& p : gas) {
    double const r = magnitude(p.position);
    p.mass = std::pow(spacing, D);
    p.range = spacings * spacing;
    p.specific_energy = weight_at(WeightShape::lucy, D, r, hot * spacing).value;
    energy += p.mass * p.specific_energy;
    moment += p.mass * r;
  }
  for (auto& p : gas) p.specific_energy = p.specific_energy * std::pow(0.5, D) / energy + 1e-6;
  SmoothScheme scheme(Box(low, high, Boundary::mirror));
  scheme.material(gas, IdealGas{gamma_of_air});
  scheme.artificial_viscosity({});
  scheme.heating(Heating::own);
  scheme.variable_range({.spacings = spacings, .longest = longest * spacing});
  Simulation simulation(scheme, 1e-6);
  simulation.integrate(gas, Method::leap_frog);
  double const start = total_energy(scheme, gas);
  run_by_courant(simulation, scheme, end_time, 0.5, 20);

  Blast blast{};
  blast.energy_drift = std::abs(total_energy(scheme, gas) / start - 1);
  double const radius = exact.radius(1, 1, end_time), speed = 2.0 / (D + 2) * radius / end_time;
  blast.kinetic_share = kinetic_energy(gas) * std::pow(2, D) / exact.kinetic_share();
  std::vector<double> sums(2 * along), numbers(2 * along);
  double size = 0;
  for (auto const& p : gas) {
    double const r = magnitude(p.position), velocity = dot(p.velocity, p.position) / r;
    moment -= p.mass * r;
    double const expected = speed * exact.at(r / radius).velocity;
    blast.velocity_error += std::abs(velocity - expected);
    size += expected;
    auto const bin = static_cast<std::size_t>(2 * r / spacing);
    if (bin < sums.size()) sums[bin] += velocity, ++numbers[bin];
  }
  blast.velocity_error /= size;
  blast.radius = radius_of_displacement(exact, D, -moment * std::pow(2, D)) / radius;
  double greatest = 0;
  for (std::size_t bin = 0; bin < sums.size(); ++bin)
    if (numbers[bin] > 0) greatest = std::max(greatest, sums[bin] /= numbers[bin]);
  for (std::size_t bin = sums.size(); bin-- > 0;) {
    if (numbers[bin] == 0) continue;
    if (sums[bin] > 0.5 * greatest) {
      blast.front = (static_cast<double>(bin) + 0.5) * 0.5 * spacing / radius;
      break;
    }
  }
  return blast;
}

TEST(Sedov, In1D) {
  Blast const blast = explode<1>(400, 3, 6, 60);
  EXPECT_NEAR(blast.radius, 1, 0.01);
  EXPECT_NEAR(blast.front, 1, 0.01);
  EXPECT_LT(blast.velocity_error, 0.03);
  EXPECT_NEAR(blast.kinetic_share, 1, 0.04);
  EXPECT_LT(blast.energy_drift, 1e-4);
}

TEST(Sedov, In2D) {
  Blast const blast = explode<2>(64, 3, 8, 9);
  EXPECT_NEAR(blast.radius, 1, 0.02);
  EXPECT_NEAR(blast.front, 1, 0.02);
  EXPECT_LT(blast.velocity_error, 0.2);
  EXPECT_NEAR(blast.kinetic_share, 1, 0.04);
  EXPECT_LT(blast.energy_drift, 2e-4);
}

// Few particles: the front is as thick as they are far apart.
TEST(Sedov, In3D) {
  Blast const blast = explode<3>(18, 2.2, 5, 4.4);
  EXPECT_NEAR(blast.radius, 1, 0.02);
  EXPECT_NEAR(blast.front, 1, 0.05);
  EXPECT_LT(blast.energy_drift, 4e-4);
}

// The energy that the scenario's formula gives, and the radius half way to its end.
TEST(Sedov, AsItIsShipped) {
  auto const run = shipped("sedov");
  auto& gas = dynamic_cast<Ensemble<Smooth<2>>&>(ensemble(*run, "gas"));
  double energy = 0, moment = 0;
  for (auto const& p : gas) {
    energy += p.mass * p.specific_energy;
    moment -= p.mass * magnitude(p.position);
  }
  EXPECT_NEAR(energy, 0.25, 0.001);
  run->simulation->run(static_cast<std::uint64_t>(run->steps / 2));
  for (auto const& p : gas) moment += p.mass * magnitude(p.position);
  SedovBlast const exact(2, gamma_of_air);
  EXPECT_NEAR(radius_of_displacement(exact, 2, 4 * moment) / exact.radius(1, 1, run->simulation->time()), 1, 0.02);
}

}  // namespace
}  // namespace boltzmann::sedov_test
