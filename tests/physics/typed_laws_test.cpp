// Scenarios whose laws are typed, against the theory of small waves in them.
#include "shipped.hpp"

#include <boltzmann/exact/riemann.hpp>

#include <gtest/gtest.h>

#include <complex>

namespace boltzmann::typed_laws_test {
namespace {

/// The amplitude of a mode of displacements from even places, on a ring.
std::complex<double> mode_of(AnyEnsemble const& particles, int mode, double spacing, double length) {
  std::complex<double> sum = 0;
  auto const n = static_cast<double>(particles.size());
  double mean = 0;
  std::vector<double> moved(particles.size());
  for (std::size_t i = 0; i < particles.size(); ++i) {
    double const away = particles.row(i)[0] - particles.row(0)[0] - spacing * static_cast<double>(i);
    moved[i] = away - length * std::round(away / length);
    mean += moved[i] / n;
  }
  for (std::size_t i = 0; i < particles.size(); ++i)
    sum += (moved[i] - mean) * std::polar(1.0, -2 * pi * mode * static_cast<double>(i) / n);
  return sum / n;
}

TEST(Traffic, RipplesGrowAsTheoryHas) {
  auto const run = shipped("traffic");
  auto const& cars = *run->ensembles[0];
  // z^2 + a z = a V' (exp(i k) - 1), k = 2 pi 12 / 100, a = V' = 1: the root that grows.
  std::complex<double> const drive = std::polar(1.0, 2 * pi * 0.12) - 1.0;
  std::complex<double> const z = (-1.0 + std::sqrt(1.0 + 4.0 * drive)) / 2.0;
  auto& simulation = *run->simulation;
  simulation.run(400);  // until the other root has died out: exp(-21)
  auto const before = mode_of(cars, 12, 2, 200);
  simulation.run(200);
  auto const after = mode_of(cars, 12, 2, 200);
  double const growth = std::log(std::abs(after) / std::abs(before)) / 10;
  std::printf("[  TRAFFIC ] growth %.5f, theory %.5f\n", growth, z.real());
  EXPECT_LT(std::abs(after), 0.05) << "small waves";
  EXPECT_NEAR(growth, z.real(), 0.01 * z.real());
  // In the end jams are there: some stand nearly still, some go at the free speed.
  simulation.run(2400);
  double slowest = 1e9, fastest = -1e9;
  for (std::size_t i = 0; i < cars.size(); ++i) {
    slowest = std::min(slowest, cars.row(i)[cars.field("velocity").offset]);
    fastest = std::max(fastest, cars.row(i)[cars.field("velocity").offset]);
  }
  EXPECT_LT(slowest, 0.3);
  EXPECT_GT(fastest, 1.6);
}

TEST(Yukawa, WavesOfAChainHaveTheFrequencyOfItsLattice) {
  auto const run = shipped("yukawa");
  auto const& grains = *run->ensembles[0];
  double omega2 = 0;
  for (int n = 1; n < 9; ++n) {  // U = exp(-r) / r
    double const r = n, curvature = std::exp(-r) * (1 / r + 2 / (r * r) + 2 / (r * r * r));
    omega2 += 2 * curvature * (1 - std::cos(2 * pi * 4 / 64 * n));
  }
  double const omega = std::sqrt(omega2);
  auto& simulation = *run->simulation;
  for (int part = 0; part < 8; ++part) {
    simulation.run(250);
    // A standing wave v0 sin(k x) cos(omega t).
    double const exact = 0.001 / omega * std::sin(omega * simulation.time());
    EXPECT_NEAR(2 * std::abs(mode_of(grains, 4, 1, 64)), std::abs(exact), 0.01 * 0.001 / omega) << simulation.time();
  }
  std::printf("[  YUKAWA  ] omega %.5f\n", omega);
}

/// The mean of a field between two places.
double mean_between(AnyEnsemble const& gas, char const* name, double low, double high) {
  Field const field = gas.field(name);
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < gas.size(); ++i) {
    if (gas.row(i)[0] < low || gas.row(i)[0] > high) continue;
    sum += gas.row(i)[field.offset];
    ++count;
  }
  return sum / count;
}

// A gas of molecules with room of their own has the waves of an ideal one whose volumes are smaller by that room.
TEST(DenseGas, HasTheWavesOfSodWithRoomAdded) {
  auto const run = shipped("dense-gas");
  auto& simulation = *run->simulation;
  while (simulation.time() < 0.2) simulation.run(20);
  double const time = simulation.time();
  exact::Riemann const ideal = exact::sod();
  auto const dense = [](double density) { return 1 / (1 / density + 1); };
  auto const& gas = *run->ensembles[0];
  double const contact = ideal.star_velocity() * time, shock = ideal.shock_speed() * 0.125 / dense(0.125) * time;
  double const from = contact + 0.3 * (shock - contact), to = contact + 0.8 * (shock - contact);
  EXPECT_NEAR(mean_between(gas, "pressure", from, to), ideal.star_pressure(), 0.01 * ideal.star_pressure());
  EXPECT_NEAR(mean_between(gas, "velocity", from, to), ideal.star_velocity(), 0.01 * ideal.star_velocity());
  EXPECT_NEAR(mean_between(gas, "density", from, to), dense(ideal.right_density()),
              0.01 * dense(ideal.right_density()));
  EXPECT_NEAR(mean_between(gas, "density", 0.55 * contact, 0.8 * contact), dense(ideal.left_density()),
              0.01 * dense(ideal.left_density()));
  // Half way up the jump of the density is the shock.
  double front = 0;
  double const half = 0.5 * (dense(ideal.right_density()) + dense(0.125));
  for (std::size_t i = 0; i < gas.size(); ++i)
    if (gas.row(i)[gas.field("density").offset] > half) front = std::max(front, gas.row(i)[0]);
  EXPECT_NEAR(front, shock, 0.01 * shock);
}

}  // namespace
}  // namespace boltzmann::typed_laws_test
