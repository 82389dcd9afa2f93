// Internal energies of mesoparticles against the Gamma law, and what a loader promises.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/incomplete_gamma.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/loaders/internal_energy_load.hpp>
#include <boltzmann/particles/meso.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <string>
#include <vector>

namespace boltzmann::internal_energy_load_test {
namespace {

TEST(InternalEnergyLoad, DrawsFromTheGammaLaw) {
  // PVDF: 16 k, 300 K, in angstrom, ps and amu.
  double const k = 0.831446, T0 = 300, alpha = 16;
  StateLaw const law(alpha * k);
  std::size_t const n = 100'000;
  Ensemble<Meso<2>> lumps("pvdf", n);
  internal_energy_load(lumps, law, {.temperature = T0, .boltzmann_constant = k, .seed = test_seed(1)});
  std::vector<double> energy = lumps.column(lumps.field("internal_energy"));
  double mean = 0, variance = 0, inverse = 0, hot = 0;
  for (double const x : energy) mean += x / n;
  for (double const x : energy) variance += (x - mean) * (x - mean) / n;
  for (auto const& p : lumps) {
    EXPECT_EQ(p.temperature, law.temperature(p.internal_energy));
    inverse += 1 / p.temperature / n;
    hot += p.temperature / n;
  }
  double const deviation = k * T0 * std::sqrt(alpha + 1), root = std::sqrt(static_cast<double>(n));
  EXPECT_NEAR(mean, k * T0 * (alpha + 1), 5 * deviation / root);
  EXPECT_NEAR(variance / (deviation * deviation), 1, 5 * std::sqrt((2 + 6 / (alpha + 1))) / root);
  EXPECT_NEAR(hot / T0, 1 + 1 / alpha, 5 * 0.26 / root);          // the arithmetic mean is above
  EXPECT_NEAR(inverse * T0, 1, 5 / std::sqrt(alpha - 1) / root);  // the harmonic mean is the bath's

  std::sort(energy.begin(), energy.end());
  double distance = 0;
  for (std::size_t i = 0; i < n; ++i) {
    double const f = std::exp(log_lower_gamma(alpha + 1, energy[i] / (k * T0)));
    distance = std::max({distance, f - static_cast<double>(i) / n, static_cast<double>(i + 1) / n - f});
  }
  EXPECT_LT(root * distance, 2.74);  // 2 exp(-2 x^2): once in 2 million times
}

TEST(InternalEnergyLoad, FollowsATable) {
  StateLaw const law({100, 250, 350, 900}, {4, 6, 30, 31});
  std::size_t const n = 50'000;
  Ensemble<Meso<3>> lumps("lumps", n);
  internal_energy_load(lumps, law, {.temperature = 300, .seed = test_seed(5)});
  double inverse = 0, square = 0;
  std::size_t below = 0;
  double const median = law.quantile(0.5, 300, 1);
  for (auto const& p : lumps) {
    inverse += 300 / p.temperature / n;
    square += 300 / p.temperature * 300 / p.temperature / n;
    below += p.internal_energy < median;
  }
  EXPECT_NEAR(inverse, 1, 5 * std::sqrt((square - inverse * inverse) / n));
  EXPECT_NEAR(static_cast<double>(below) / n, 0.5, 5 * 0.5 / std::sqrt(n));
}

TEST(InternalEnergyLoad, AParticlesEnergyDependsOnNothingElse) {
  StateLaw const law(16);
  Ensemble<Meso<2>> few("lumps", 10), many("lumps", 1000), other("other", 10), again("lumps", 10);
  internal_energy_load(few, law, {.temperature = 300, .seed = test_seed(3)});
  internal_energy_load(many, law, {.temperature = 300, .seed = test_seed(3)});
  internal_energy_load(other, law, {.temperature = 300, .seed = test_seed(3)});
  internal_energy_load(again, law, {.temperature = 300, .seed = test_seed(4)});
  for (int i = 0; i < 10; ++i) {
    EXPECT_EQ(few[i].internal_energy, many[i].internal_energy);
    EXPECT_NE(few[i].internal_energy, other[i].internal_energy);
    EXPECT_NE(few[i].internal_energy, again[i].internal_energy);
    EXPECT_GT(few[i].internal_energy, 0);
  }
  Ensemble<Meso<2>> none("none");
  internal_energy_load(none, law, {.temperature = 300, .seed = 3});
  EXPECT_EQ(none.size(), 0U);
}

/// An internal energy, but no temperature to write it down.
template <int D, class Real = double>
struct Lump : Newton<D, Real> {
  static constexpr char const* class_name = "Lump";
  Real internal_energy;

  static FieldTable fields() {
    return Newton<D, Real>::fields().add(&Lump::internal_energy, "internal_energy", dimensions::energy,
                                         "energy of what is inside it");
  }
};

TEST(InternalEnergyLoad, ClassesWithoutTheFields) {
  StateLaw const law(16);
  Ensemble<Lump<1>> lumps("lumps", 3);
  internal_energy_load(lumps, law, {.temperature = 300, .seed = test_seed(3)});
  EXPECT_GT(lumps[2].internal_energy, 0);
  EXPECT_EQ(lumps[2].velocity[0], 0);

  Ensemble<Newton<2>> atoms("atoms", 3);
  try {
    internal_energy_load(atoms, law, {.temperature = 300, .seed = test_seed(3)});
    FAIL() << "Newton has no internal energy";
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("internal_energy"), std::string::npos) << error.what();
  }
  EXPECT_THROW(internal_energy_load(lumps, law, {.temperature = 0, .seed = 3}), Error);
  EXPECT_THROW(internal_energy_load(lumps, law, {.temperature = 300, .boltzmann_constant = -1, .seed = 3}), Error);
  EXPECT_THROW(internal_energy_load(lumps, law, {.seed = 3}), Error);  // a temperature is needed
}

}  // namespace
}  // namespace boltzmann::internal_energy_load_test
