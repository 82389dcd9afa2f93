// Scenarios whose laws are typed, against the theory of small waves in them.
#include "shipped.hpp"

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

}  // namespace
}  // namespace boltzmann::typed_laws_test
