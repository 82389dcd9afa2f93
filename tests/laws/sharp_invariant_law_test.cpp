// Internal energies of large lumps: heat capacities of many k, whose law is a sharp peak, and of next to none.
#include <boltzmann/laws/invariant_law.hpp>
#include <boltzmann/loaders/internal_energy_load.hpp>
#include <boltzmann/particles/meso.hpp>

#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <vector>

namespace boltzmann::sharp_invariant_law_test {
namespace {

constexpr double k = 0.83, bath = 300;
constexpr double below_one = 0.8413447460685429, below_two = 0.9772498680518208;  // of a normal law, in deviations

/// The quantile of Gamma(a, 1) in standard deviations about its mean: Cornish and Fisher's series.
double gamma_deviation(double z, double a) {
  return z + (z * z - 1) / (3 * std::sqrt(a)) + (z * z * z - 7 * z) / (36 * a);
}

// 1e7 and 1e16 are where the way of computing it changes; 7e22 k is one joule per kelvin.
TEST(SharpInvariantLaw, HasTheQuantilesOfAGammaDistribution) {
  for (double const alpha : {9.9e6, 1.01e7, 1e9, 1e12, 9.9e15, 1.01e16, 1e20, 7.2e22}) {
    StateLaw const law(alpha * k);
    InvariantLaw const invariant(law, bath, k);
    double const mean = k * bath * (alpha + 1), deviation = k * bath * std::sqrt(alpha + 1);
    double const rounding = 1e-15 * mean / deviation + 1e-10;
    for (double const sign : {-1.0, 1.0})
      for (double const z : {0.0, 1.0, 2.0}) {
        double const one = z == 0 ? 0.5 : z == 1 ? below_one : below_two, u = sign > 0 ? one : 1 - one;
        double const energy = invariant.quantile(u);
        EXPECT_NEAR((energy - mean) / deviation, gamma_deviation(sign * z, alpha + 1), rounding)
            << alpha << " at " << u;
        EXPECT_NEAR(invariant.distribution(energy), u, rounding) << alpha << " at " << u;
      }
    EXPECT_LT(invariant.distribution(mean * 0.99), 1e-30);
    EXPECT_EQ(invariant.distribution(mean * 1.01), 1);
    EXPECT_EQ(invariant.distribution(0), 0);
  }
}

TEST(SharpInvariantLaw, SharperThanDoublePrecisionIsItsMiddle) {
  for (double const alpha : {1e33, 1e200, 1e305}) {
    StateLaw const law(alpha);
    InvariantLaw const invariant(law, bath, 1e-3);
    for (double const u : {1e-12, 0.3, 0.5, 0.999}) EXPECT_NEAR(invariant.quantile(u) / (alpha * bath), 1, 1e-14);
    EXPECT_EQ(invariant.distribution(alpha * bath), 0.5);
    EXPECT_EQ(invariant.distribution(alpha * bath * 0.999), 0);
    EXPECT_EQ(invariant.distribution(alpha * bath * 1.001), 1);
  }
}

// A table whose heat capacity is constant is the constant law, wherever the temperature of the bath is.
TEST(SharpInvariantLaw, OfATableIsThatOfItsHeatCapacityAtTheBath) {
  for (double const alpha : {1e6, 1e8, 1e12, 1e20})
    for (double const temperature : {50.0, 100.0, 200.0, 300.0, 1000.0}) {
      StateLaw const constant(alpha * k), table({100, 150, 300}, {alpha * k, alpha * k, alpha * k});
      InvariantLaw const one(constant, temperature, k), other(table, temperature, k);
      for (double const u : {0.001, 0.3, 0.5, 0.9}) {
        double const expected = one.quantile(u), deviation = k * temperature * std::sqrt(alpha);
        EXPECT_NEAR((other.quantile(u) - expected) / deviation, 0, 1e-6 + 1e-15 * std::sqrt(alpha))
            << alpha << " at " << temperature;
        EXPECT_NEAR(other.distribution(expected), one.distribution(expected), 1e-6 + 1e-15 * std::sqrt(alpha));
      }
    }
  // The variance of the energy is k T0^2 Cv(T0), its mean that of T0.
  StateLaw const rising({100, 300}, {1e10 * k, 3e10 * k});
  InvariantLaw const invariant(rising, 200, k);
  double const deviation = k * 200 * std::sqrt(2e10);
  EXPECT_NEAR((invariant.quantile(below_one) - invariant.quantile(1 - below_one)) / (2 * deviation), 1, 1e-5);
  EXPECT_NEAR((invariant.quantile(0.5) - rising.energy(200)) / deviation, 0, 1e-4);
}

// Without heat capacity what is left is exp(-eps / k T).
TEST(SharpInvariantLaw, OfNextToNoHeatCapacityIsExponential) {
  for (double const capacity : {1e-20, 1e-300})
    for (double const u : {0.01, 0.5, 0.99}) {
      StateLaw const law(capacity);
      EXPECT_NEAR(law.quantile(u, 2, 1) / (-2 * std::log1p(-u)), 1, 1e-12) << capacity;
      EXPECT_NEAR(law.distribution(-2 * std::log1p(-u), 2, 1), u, 1e-12) << capacity;
    }
}

TEST(SharpInvariantLaw, LoadsGrainsInSIUnits) {
  Ensemble<Meso<3>> grains("grains", 1000);
  StateLaw const law(1e-6);  // of a grain of sand, in J/K: 7e16 k
  internal_energy_load(grains, law, {.temperature = 300, .boltzmann_constant = 1.380649e-23, .seed = test_seed(1)});
  double mean = 0, square = 0;
  for (auto const& grain : grains) {
    mean += grain.temperature / 1000;
    square += (grain.temperature - 300) * (grain.temperature - 300) / 1000;
  }
  double const deviation = 300 * std::sqrt(1.380649e-23 / 1e-6);
  EXPECT_NEAR((mean - 300) / deviation, 0, 0.15);  // 1 / sqrt(1000) = 0.03
  EXPECT_NEAR(std::sqrt(square) / deviation, 1, 0.1);
}

TEST(SharpInvariantLaw, FunctionsHaveTemperaturesThatSpanANumber) {
  auto const made = [](double lowest, double highest) {
    return message([&] { StateLaw([](double) { return 1.0; }, lowest, highest); });
  };
  EXPECT_EQ(made(1e-300, 1e300),
            "state law: the temperatures must ascend from above zero, by a factor that is a number, not from 1e-300 to "
            "1e+300");
  EXPECT_EQ(made(1e-100, 1e100), "no error");
  EXPECT_EQ(message([] { StateLaw([](double T) { return std::sqrt(20 - T); }, 10, 30); }).substr(0, 63),
            "state law: the heat capacity must be positive and finite, at th");
  EXPECT_EQ(message([] { StateLaw([](double T) { return std::sqrt(20 - T); }, 10, 30); }).find("-nan"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::sharp_invariant_law_test
