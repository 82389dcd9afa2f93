// Scenarios whose classes are derived in them, against exact solutions and published transitions.
#include "shipped.hpp"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <complex>

namespace boltzmann::own_classes_test {
namespace {

double field(AnyEnsemble const& particles, std::size_t i, char const* name, int component = 0) {
  return particles.row(i)[particles.field(name).offset + component];
}

std::complex<double> order_of(AnyEnsemble const& particles) {
  std::complex<double> sum = 0;
  for (std::size_t i = 0; i < particles.size(); ++i) sum += std::polar(1.0, field(particles, i, "angle"));
  return sum / static_cast<double>(particles.size());
}

TEST(ChargingGrains, ChargesGrowExponentiallyAndTheClusterComesToRest) {
  auto const run = shipped("charging-grains");
  auto const& grains = *run->ensembles[0];
  auto& simulation = *run->simulation;
  double const e = 1.602176634e-19, k = 8.9875517923e9;
  for (int part = 0; part < 4; ++part) {
    simulation.run(500);
    for (std::size_t i = 0; i < grains.size(); ++i) {
      double const radius = field(grains, i, "radius") * 1e-3;  // m
      double const full = radius * 5 / k / e, tau = 1e-6 / radius;
      EXPECT_NEAR(field(grains, i, "charge"), full * (1 - std::exp(-simulation.time() / tau)), 2e-6 * full) << i;
    }
  }
  // Forces in the bowl, proportional to r, balance those between charges: sum of r . F = 0 says 2 U_bowl = U_charges.
  auto const energies = simulation.measure();
  EXPECT_NEAR(energies.potential / (2 * energies.external), 1, 2e-3);
  EXPECT_GT(energies.external, 0);
}

/// Of Kuramoto's oscillators, coupled so.
std::unique_ptr<ScenarioSimulation> oscillators(double coupling, int count, double time) {
  Overrides few;
  few.set = {fmt::format("influences.0.parameters.K={}", coupling),
             fmt::format("influences.0.parameters.N={}", count),
             fmt::format("ensembles.oscillators.load.counts=[{}]", count),
             fmt::format("ensembles.oscillators.load.spacing={}", 1.0 / count),
             fmt::format("ensembles.oscillators.load.origin=[{}]", 0.5 / count),
             fmt::format("run.time={}", time)};
  return shipped("kuramoto", few);
}

// Y. Kuramoto (1975): r = sqrt(1 - Kc / K) above Kc = 2 gamma = 1, and no order below.
TEST(Kuramoto, OscillatorsFindTogetherAsTheoryHas) {
  for (double const K : {0.6, 1.25, 2.0, 3.0}) {
    auto const run = oscillators(K, 400, 100);
    auto const& all = *run->ensembles[0];
    double const exact = K > 1 ? std::sqrt(1 - 1 / K) : 0;
    run->simulation->run(K < 2 ? 600 : 250);
    double mean = 0;
    for (int step = 0; step < 200; ++step) {
      run->simulation->run(1);
      mean += std::abs(order_of(all)) / 200;
    }
    std::printf("[ KURAMOTO ] K = %.2f: order %.4f (%.4f)\n", K, mean, exact);
    if (K > 1)
      EXPECT_NEAR(mean, exact, 0.03 * exact);
    else
      EXPECT_LT(mean, 0.1);
  }
}

TEST(ActiveMatter, SwimmersWithoutNeighboursWalkPersistently) {
  Overrides alone;
  alone.set = {"influences.1.parameters.turning=0", "ensembles.swimmers.number=2000", "box.boundary='open'"};
  auto const run = shipped("active-matter", alone);
  auto const& swimmers = *run->ensembles[0];
  std::vector<double> start;
  for (std::size_t i = 0; i < swimmers.size(); ++i) start.insert(start.end(), {swimmers.row(i)[0], swimmers.row(i)[1]});
  run->simulation->run(400);
  double const t = 20, D = 0.1, v = 0.5, n = static_cast<double>(swimmers.size());
  double square = 0, fourth = 0;
  for (std::size_t i = 0; i < swimmers.size(); ++i) {
    double const x = swimmers.row(i)[0] - start[2 * i], y = swimmers.row(i)[1] - start[2 * i + 1], d2 = x * x + y * y;
    square += d2 / n, fourth += d2 * d2 / n;
  }
  double const exact = 2 * v * v / (D * D) * (D * t - 1 + std::exp(-D * t));
  EXPECT_NEAR(square, exact, 5 * std::sqrt((fourth - square * square) / n));
}

/// I1(z) / I0(z) by their integrals over a circle, which the rule of rectangles gives to rounding.
double bessel_ratio(double z) {
  double zero = 0, one = 0;
  for (int k = 0; k < 64; ++k) {
    double const angle = 2 * pi * k / 64, weight = std::exp(z * (std::cos(angle) - 1));
    zero += weight, one += weight * std::cos(angle);
  }
  return one / zero;
}

// All with all, and noise D: the order is that of r = I1(K r / D) / I0(K r / D), above K = 2 D.
TEST(ActiveMatter, NoiseAndAlignmentOfAllWithAllGiveTheOrderOfTheMeanField) {
  std::string const text =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [1, 1]\n[run]\nstep = 0.02\nsteps = "
      "1\n[[classes]]\nname = "
      "\"Spin\"\nbase = \"Tracer\"\nfields = [{ name = \"angle\", period = \"2 pi\" }]\nrate.angle = "
      "0\ndiffusion.angle = "
      "1\n[[ensembles]]\nname = \"a\"\nclass = \"Spin\"\nintegrator = \"rk2\"\nload = { kind = \"random\" }\nnumber = "
      "500\n[[influences]]\nchanges = \"angle\"\ninfluence = \"3/500*sin(q.angle - p.angle)\"\non = \"a\"\n";
  auto const run = parse_scenario(text, "spins.toml");
  double exact = 1;
  for (int k = 0; k < 200; ++k) exact = bessel_ratio(3 * exact);
  run->simulation->run(400);
  double mean = 0;
  for (int part = 0; part < 200; ++part) {
    run->simulation->run(8);
    mean += std::abs(order_of(*run->ensembles[0])) / 200;
  }
  std::printf("[ SPINS    ] order %.4f, mean field %.4f\n", mean, exact);
  EXPECT_NEAR(mean, exact, 0.03 * exact);
}

TEST(ActiveMatter, FlocksFormBelowAThresholdOfNoise) {
  auto const polarisation = [](double noise) {
    Overrides with;
    with.set = {fmt::format("classes.Swimmer.parameters.noise={}", noise)};
    auto const run = shipped("active-matter", with);
    run->simulation->run(600);
    return std::abs(order_of(*run->ensembles[0]));
  };
  EXPECT_GT(polarisation(0.02), 0.7);
  EXPECT_LT(polarisation(2), 0.2);
}

}  // namespace
}  // namespace boltzmann::own_classes_test
