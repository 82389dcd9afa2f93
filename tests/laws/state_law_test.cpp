// State laws against thermodynamics: the Gamma law, Einstein's solid, and identities that hold for any heat capacity.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/laws/invariant_law.hpp>
#include <boltzmann/laws/state_law.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <limits>
#include <string>
#include <vector>

namespace boltzmann::state_law_test {
namespace {

constexpr double nan_value = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();

/// Einstein's solid: N oscillators of the temperature theta (k = 1).
struct Einstein {
  double N, theta;

  double capacity(double T) const {
    double const x = theta / T;
    return N * x * x * std::exp(-x) / (std::expm1(-x) * std::expm1(-x));
  }
  double energy(double T) const { return N * theta / std::expm1(theta / T); }
  double entropy(double T) const {
    double const x = theta / T;
    return N * (x / std::expm1(x) - std::log(-std::expm1(-x)));
  }
};

/// Tables of every kind: rising, falling, with a peak, with a step, two points, many.
std::vector<StateLaw> tables() {
  std::vector<double> T, peak;
  for (int i = 0; i < 200; ++i) {
    T.push_back(40 + 5 * i);
    peak.push_back(3 + 40 * std::exp(-std::pow((T.back() - 350) / 60, 2)));
  }
  Einstein const solid{20, 900};
  return {StateLaw({100, 1000}, {2, 30}),
          StateLaw({100, 1000}, {30, 2}),
          StateLaw({200, 299.9, 300.1, 400}, {5, 5, 25, 25}),
          StateLaw({250, 300, 320}, {0.3, 8, 0.1}),
          StateLaw(T, peak),
          StateLaw({1, 5000}, {400, 600}),
          StateLaw([=](double t) { return solid.capacity(t); }, 80, 1500)};
}

/// The integral of f from a to b by Simpson's rule.
template <class F>
double simpson(F const& f, double a, double b, int cells) {
  double const h = (b - a) / cells;
  double sum = f(a) + f(b);
  for (int i = 0; i < cells; ++i) sum += 4 * f(a + (i + 0.5) * h) + (i > 0 ? 2 * f(a + i * h) : 0);
  return sum * h / 6;
}

/// Integrals over exp(s / k - eps / k T0) by quadrature over energies, from the entropy and nothing else.
struct Averages {
  StateLaw const& law;
  double T0, k;
  double lowest, highest;  // in energy

  Averages(StateLaw const& law, double T0, double k) : law(law), T0(T0), k(k) {
    lowest = highest = law.energy(T0);
    while (lowest * density(lowest) > 1e-18 * highest) lowest *= 0.95;
    while (density(highest) > 1e-18) highest *= 1.05;
  }
  double density(double energy) const {
    double const top = law.energy(T0);
    return std::exp((law.entropy(energy) - law.entropy(top)) / k - (energy - top) / (k * T0));
  }
  template <class F>
  double mass(F const& f, double to) const {
    auto const integrand = [&](double z) {  // over the energy's logarithm: nothing is singular at zero then
      double const energy = std::exp(z);
      return energy * f(energy) * density(energy);
    };
    return simpson(integrand, std::log(lowest), std::log(to), 20'000);
  }
};

// ---- energies, temperatures, entropies ----

TEST(StateLaw, ConstantHeatCapacity) {
  StateLaw const law(16);
  EXPECT_TRUE(law.constant());
  EXPECT_EQ(law.energy(300), 4800);
  EXPECT_EQ(law.temperature(4800), 300);
  EXPECT_EQ(law.heat_capacity(7), 16);
  EXPECT_EQ(law.entropy(1), 0);
  EXPECT_NEAR(law.entropy(2) - law.entropy(1), 16 * std::log(2.0), 1e-14);
  EXPECT_EQ(law.temperature(0), 0);
  EXPECT_EQ(law.temperature(-32), -2);
  EXPECT_TRUE(std::isnan(law.temperature(nan_value)));
}

TEST(StateLaw, ATableOfOneValueIsConstant) {
  StateLaw const law(16), table({20, 100, 101, 900}, {16, 16, 16, 16});
  EXPECT_FALSE(table.constant());
  for (double T = 0; T < 2000; T += 7.3) {
    EXPECT_NEAR(table.energy(T), law.energy(T), 1e-14 * law.energy(T));
    EXPECT_NEAR(table.temperature(law.energy(T)), T, 1e-14 * T);
    EXPECT_EQ(table.heat_capacity(T), 16);
    if (T > 0) {
      EXPECT_NEAR(table.entropy(law.energy(T)), 16 * std::log(T / 20), 1e-12);
    }
  }
  for (double const T0 : {5.0, 100.4, 300.0, 4000.0})
    for (double const u : {1e-14, 1e-3, 0.2, 0.5, 0.77, 1 - 1e-9}) {
      double const x = law.quantile(u, T0, 1);
      EXPECT_NEAR(table.quantile(u, T0, 1), x, 1e-13 * x);
      EXPECT_NEAR(table.distribution(x, T0, 1), u, 1e-12 * u);
    }
}

TEST(StateLaw, TemperaturesUndoEnergies) {
  for (StateLaw const& law : tables()) {
    double last = 0;
    for (double T = 0.25; T < 8000; T *= 1.01) {
      double const energy = law.energy(T);
      EXPECT_GT(energy, last);
      EXPECT_NEAR(law.temperature(energy), T, 1e-14 * T);
      last = energy;
    }
    for (double const T : {100.0, 250.0, 299.9, 300.0, 300.1, 320.0, 400.0, 1000.0})  // on the points themselves
      EXPECT_NEAR(law.temperature(law.energy(T)), T, 1e-14 * T);
    EXPECT_EQ(law.energy(0), 0);
    EXPECT_EQ(law.temperature(0), 0);
    EXPECT_LT(law.temperature(-1), 0);
    EXPECT_TRUE(std::isnan(law.temperature(nan_value)));
    EXPECT_EQ(law.temperature(infinity), infinity);
  }
}

TEST(StateLaw, DigitsAreKeptWhereTheSlopeIsSteepOrNone) {
  // Cv falls by nine orders: the square of its value at the far end is below rounding.
  StateLaw const falling({1, 2}, {1, 1e-9});
  for (double T = 1; T < 3; T += 0.01) EXPECT_NEAR(falling.temperature(falling.energy(T)), T, T < 1.9 ? 1e-13 : 2e-7);
  StateLaw const nearly({1, 2}, {1, 1 + 1e-15});
  for (double T = 0.5; T < 3; T += 0.01) EXPECT_NEAR(nearly.temperature(T), T, 3e-15);
  StateLaw const rising({1, 2}, {1e-9, 1});
  for (double T = 0.5; T < 3; T += 0.01) EXPECT_NEAR(rising.temperature(rising.energy(T)), T, 1e-13);
}

TEST(StateLaw, OneOverTemperatureIsTheSlopeOfTheEntropy) {
  std::vector<StateLaw> laws = tables();
  laws.emplace_back(16.0);
  for (StateLaw const& law : laws)
    for (double T = 20; T < 3000; T *= 1.037) {
      double const energy = law.energy(T), h = 1e-4 * energy;
      double const slope = (law.entropy(energy + h) - law.entropy(energy - h)) / (2 * h);
      // Cv may jump within h, so T needn't be linear there: but it is between those of the ends.
      double const low = law.temperature(energy - h), high = law.temperature(energy + h);
      EXPECT_LE(slope, 1 / low * (1 + 1e-9));
      EXPECT_GE(slope, 1 / high * (1 - 1e-9));
      EXPECT_NEAR(slope * T, 1, 1e-3);
      double const step = 1e-4 * T;  // and Cv that of the energy
      double const capacity = (law.energy(T + step) - law.energy(T - step)) / (2 * step);
      double const a = law.heat_capacity(T - step), b = law.heat_capacity(T), c = law.heat_capacity(T + step);
      EXPECT_GE(capacity, std::min({a, b, c}) * (1 - 1e-9));
      EXPECT_LE(capacity, std::max({a, b, c}) * (1 + 1e-9));
    }
}

TEST(StateLaw, EinsteinsSolidFromItsFormula) {
  Einstein const solid{18, 800};
  for (double const lowest : {60.0, 200.0}) {
    StateLaw const law([&](double T) { return solid.capacity(T); }, lowest, 3000);
    double const energy = law.energy(lowest);  // below the table Cv is constant: only differences are Einstein's
    for (double T = lowest; T < 3000; T *= 1.003) {
      EXPECT_NEAR(law.energy(T) - energy, solid.energy(T) - solid.energy(lowest), 1e-6 * solid.energy(T));
      EXPECT_NEAR(law.entropy(law.energy(T)), solid.entropy(T) - solid.entropy(lowest), 2e-6 * solid.entropy(T));
      EXPECT_NEAR(law.heat_capacity(T), solid.capacity(T), 3e-6 * solid.N);
    }
    EXPECT_EQ(law.entropy(energy), 0);
  }
}

TEST(StateLaw, TemperaturesTakeNanoseconds) {
  std::vector<double> T, capacity;
  for (int i = 0; i < 1000; ++i) T.push_back(10 + i), capacity.push_back(1 + 15 * std::tanh(T.back() / 300));
  StateLaw const law(T, capacity);
  std::vector<double> energies(4096);
  Stream stream(test_seed(1), 0, 0, Purpose::user);
  for (double& x : energies) x = law.energy(1200 * stream.uniform());
  double sum = 0, best = infinity;
  for (int repetition = 0; repetition < 20; ++repetition) {
    auto const start = std::chrono::steady_clock::now();
    for (double const x : energies) sum += law.temperature(x);
    best = std::min(best, std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count());
  }
  EXPECT_GT(sum, 0);
  RecordProperty("nanoseconds", std::to_string(best / 4096 * 1e9));
  EXPECT_LT(best / 4096, 400e-9);  // 10 ns without sanitizers and neighbours
}

// ---- the invariant law ----

TEST(InvariantLaw, GammaDistributionOfConstantHeatCapacity) {
  // Moments of Gamma(Cv / k + 1, k T) by quadrature over fractions, and <1 / T> = 1 / T0 exactly.
  double const k = 0.83, T0 = 300;
  for (double const alpha : {0.5, 3.0, 16.0, 150.0, 250.0, 4000.0}) {
    StateLaw const law(alpha * k);
    InvariantLaw const invariant(law, T0, k);
    double mean = 0, square = 0, inverse = 0;
    int const n = 100'000;
    for (int i = 0; i < n; ++i) {
      double const x = invariant.quantile((i + 0.5) / n);
      mean += x / n;
      square += x * x / n;
      inverse += 1 / law.temperature(x) / n;
    }
    double const unit = k * T0;
    EXPECT_NEAR(mean / (unit * (alpha + 1)), 1, 3e-5) << alpha;
    EXPECT_NEAR((square - mean * mean) / (unit * unit * (alpha + 1)), 1, 5e-4) << alpha;
    EXPECT_NEAR(inverse * T0, 1, alpha < 1 ? 0.03 : 1e-4) << alpha;
  }
}

TEST(InvariantLaw, QuantilesOfFortyDigitArithmetic) {
  StateLaw const law(16 * 0.5);
  double const unit = 0.5 * 3;  // k T
  for (auto const& [u, x] : {std::pair{0.05, 10.8321403562759875},
                             {0.5, 16.667853683739618},
                             {0.95, 24.3011836836470952},
                             {1e-6, 3.96264535523633007}}) {
    EXPECT_NEAR(law.quantile(u, 3, 0.5), unit * x, 1e-13 * unit * x);
    EXPECT_NEAR(law.distribution(unit * x, 3, 0.5), u, 1e-12 * u);
  }
  // Shapes with and without panels are one function of the shape: the median is a - 1/3 + 8/(405 a) + ...
  for (double const a : {150.0, 201.5, 1e4, 1e6 + 1}) {
    double const median = a - 1.0 / 3 + 8 / (405 * a) + 184 / (25515 * a * a);
    EXPECT_NEAR(StateLaw(a - 1).quantile(0.5, 1, 1), median, 1e-9) << a;
  }
}

TEST(InvariantLaw, QuantileUndoesDistribution) {
  std::vector<StateLaw> laws = tables();
  for (double const capacity : {0.5, 1.0, 16.0, 199.0, 201.0, 1e4, 1e6}) laws.emplace_back(capacity);
  for (StateLaw const& law : laws)
    for (double const T0 : {10.0, 260.0, 300.0, 700.0, 9000.0}) {
      InvariantLaw const invariant(law, T0, 1);
      double last = 0;
      for (double const u : {1e-300, 1e-40, 1e-15, 1e-6, 0.01, 0.1, 0.3, 0.5, 0.6, 0.9, 0.999, 1 - 1e-9, 1 - 1e-15}) {
        double const x = invariant.quantile(u);
        EXPECT_GE(x, last);
        EXPECT_NEAR(invariant.distribution(x) / u, 1, u < 1e-20 ? 2e-11 : 2e-12) << u << " at " << T0;
        last = x;
      }
      for (double const u : {0.013, 0.31, 0.5, 0.83}) {
        double const x = invariant.quantile(u);
        EXPECT_NEAR(invariant.quantile(invariant.distribution(x)) / x, 1, 1e-12);
      }
      EXPECT_EQ(invariant.distribution(0), 0);
      EXPECT_EQ(invariant.distribution(-1), 0);
      EXPECT_EQ(invariant.distribution(infinity), 1);
      EXPECT_TRUE(std::isnan(invariant.distribution(nan_value)));
    }
}

TEST(InvariantLaw, DistributionsAreIntegralsOfTheBoltzmannFactor) {
  for (StateLaw const& law : tables())
    for (double const T0 : {90.0, 300.0, 800.0}) {
      Averages const average(law, T0, 1);
      auto const one = [](double) { return 1.0; };
      double const total = average.mass(one, average.highest);
      for (double const u : {0.01, 0.2, 0.5, 0.9}) {
        double const x = law.quantile(u, T0, 1);
        EXPECT_NEAR(average.mass(one, x) / total, u, 1e-6) << "at " << T0;
      }
    }
}

TEST(InvariantLaw, TheMeanOfOneOverTemperatureIsThatOfTheBath) {
  // The derivative of exp(s / k - eps / k T0) is (1 / T - 1 / T0) / k times it, and integrates to zero.
  for (StateLaw const& law : tables())
    for (double const T0 : {90.0, 300.0, 800.0}) {
      Averages const average(law, T0, 1);
      // Below the table 1 / T = Cv / eps, and the integral from zero is k times the density.
      auto const inverse = [&](double energy) { return T0 / law.temperature(energy); };
      double const sum = average.mass(inverse, average.highest) + T0 * average.density(average.lowest);
      EXPECT_NEAR(sum / average.mass([](double) { return 1; }, average.highest), 1, 1e-6) << T0;

      if (law.heat_capacity(0) < 1) continue;  // draws of 1 / T have an infinite variance there
      InvariantLaw const invariant(law, T0, 1);
      int const n = 20'000;
      double mean = 0;
      for (int i = 0; i < n; ++i) mean += inverse(invariant.quantile((i + 0.5) / n)) / n;
      EXPECT_NEAR(mean, 1, 1e-3) << T0;
    }
}

TEST(InvariantLaw, DrawsAreDistributedByIt) {
  StateLaw const constant(16), peak = tables()[4];
  for (StateLaw const* law : {&constant, &peak}) {
    std::vector<double> sample;
    for (std::uint64_t i = 0; i < 2000; ++i) {
      Stream stream(test_seed(7), 0, i, Purpose::internal_energy), copy = stream;
      sample.push_back(law->draw(330, 1, stream));
      copy.uniform();  // one number of the stream
      EXPECT_EQ(stream.bits(), copy.bits());
    }
    std::sort(sample.begin(), sample.end());
    Averages const average(*law, 330, 1);
    auto const one = [](double) { return 1.0; };
    double const total = average.mass(one, average.highest);
    double distance = 0;
    for (std::size_t i = 0; i < sample.size(); i += 40)
      distance = std::max(distance, std::abs(average.mass(one, sample[i]) / total - i / 2000.0));
    EXPECT_LT(distance * std::sqrt(2000.0), 1.95);  // once in 1000 times
  }
}

// ---- what can't be ----

TEST(StateLaw, RefusesWhatIsNoHeatCapacity) {
  EXPECT_EQ(message([] { StateLaw(-1.5); }), "state law: the heat capacity must be positive and finite, it is -1.5");
  EXPECT_THROW(StateLaw(0.0), Error);
  EXPECT_THROW(StateLaw{nan_value}, Error);
  EXPECT_THROW(StateLaw{infinity}, Error);
  EXPECT_EQ(message([] { StateLaw({1, 2, 3}, {1, 2}); }), "state law: 3 temperatures, but 2 heat capacities");
  EXPECT_EQ(message([] { StateLaw(std::vector<double>{1}, std::vector<double>{1}); }),
            "state law: a table needs at least two temperatures, it has 1");
  EXPECT_EQ(message([] { StateLaw({1, 3, 2}, {1, 1, 1}); }), "state law: temperatures must ascend, but 2 follows 3");
  EXPECT_THROW(StateLaw({1, 1}, {1, 1}), Error);
  EXPECT_THROW(StateLaw({0, 1}, {1, 1}), Error);
  EXPECT_THROW(StateLaw({1, nan_value}, {1, 1}), Error);
  EXPECT_EQ(message([] {
              StateLaw({1, 2}, {1, 0});
            }),
            "state law: the heat capacity must be positive and finite, at the temperature 2 it is 0");
  EXPECT_THROW(StateLaw({1, 2}, {1e308, 1e308}), Error);
  EXPECT_EQ(message([] { StateLaw([](double T) { return T - 5; }, 1, 9); }),
            "state law: the heat capacity must be positive and finite, at the temperature 1 it is -4");
  EXPECT_THROW(StateLaw([](double) { return 1.0; }, 0, 9), Error);
  EXPECT_THROW(StateLaw([](double) { return 1.0; }, 9, 9), Error);
  EXPECT_THROW(StateLaw([](double) { return 1.0; }, 9, infinity), Error);
}

TEST(InvariantLaw, RefusesWhatIsNoBath) {
  StateLaw const law(16);
  Stream stream(test_seed(1), 0, 0, Purpose::user);
  EXPECT_EQ(message([&] { law.draw(0, 1, stream); }), "internal energies: the temperature must be positive, it is 0");
  EXPECT_THROW(law.draw(300, 0, stream), Error);
  EXPECT_THROW(law.draw(nan_value, 1, stream), Error);
  EXPECT_THROW(law.distribution(1, infinity, 1), Error);
  EXPECT_THROW(law.quantile(0, 300, 1), Error);
  EXPECT_THROW(law.quantile(1, 300, 1), Error);
  EXPECT_THROW(law.quantile(nan_value, 300, 1), Error);
}

TEST(StateLaw, FunctionsWithStepsAndKinksAreTabulatedToo) {
  StateLaw const step([](double T) { return T < 300 ? 5.0 : 25.0; }, 100, 500);
  EXPECT_NEAR(step.energy(500), 5 * 300 + 25 * 200, 0.2);
  EXPECT_NEAR(step.energy(290), 5 * 290, 1e-9);
}

}  // namespace
}  // namespace boltzmann::state_law_test
