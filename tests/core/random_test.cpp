// Random streams against Random123, and random variables against their exact distribution functions. The numbers of a
// seed are the same on every processor; over seeds, bounds are five standard errors.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <tests/message.hpp>

#include <Random123/philox.h>
#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <numbers>
#include <string>
#include <thread>
#include <type_traits>
#include <vector>

namespace boltzmann::random_test {
namespace {

using std::numbers::pi;
constexpr double nan = std::numeric_limits<double>::quiet_NaN();
constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr int draws = 200'000;

std::vector<double> sample(auto const& variable, std::uint64_t seed, int count = draws) {
  Stream stream(test_seed(seed), 0, 0, Purpose::user);
  std::vector<double> numbers(static_cast<std::size_t>(count));
  for (double& x : numbers) x = variable(stream);
  return numbers;
}

double mean(std::vector<double> const& x) {
  double sum = 0;
  for (double const v : x) sum += v;
  return sum / static_cast<double>(x.size());
}

double variance(std::vector<double> const& x) {
  double const m = mean(x);
  double sum = 0;
  for (double const v : x) sum += (v - m) * (v - m);
  return sum / static_cast<double>(x.size() - 1);
}

/// sqrt(N) times the greatest distance between the empirical and the exact distribution function.
double kolmogorov_smirnov(std::vector<double> x, std::function<double(double)> const& distribution) {
  std::sort(x.begin(), x.end());
  double const n = static_cast<double>(x.size());
  double distance = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    double const exact = distribution(x[i]);
    distance = std::max({distance, static_cast<double>(i + 1) / n - exact, exact - static_cast<double>(i) / n});
  }
  return distance * std::sqrt(n);
}
/// Exceeded once in 2 million times: 2 exp(-2 x^2).
constexpr double kolmogorov_smirnov_limit = 2.74;

double normal_distribution(double x) { return 0.5 * std::erfc(-x / std::numbers::sqrt2); }

double correlation(Stream a, Stream b, int count = 100'000) {
  double sum = 0;
  for (int i = 0; i < count; ++i) sum += (a.uniform() - 0.5) * (b.uniform() - 0.5);
  return 12.0 * sum / count;
}

void expect_one_line(std::function<void()> const& action, std::string const& part) {
  std::string const line = message(action);
  EXPECT_NE(line.find(part), std::string::npos) << line;
  EXPECT_EQ(line.find('\n'), std::string::npos) << line;
}

// ---- Philox ----

TEST(Philox, PublishedKnownAnswers) {
  using Words = std::array<std::uint64_t, 4>;
  EXPECT_EQ(philox({0, 0, 0, 0}, {0, 0}),
            (Words{0x16554d9eca36314c, 0xdb20fe9d672d0fdc, 0xd7e772cee186176b, 0x7e68b68aec7ba23b}));
  constexpr std::uint64_t ones = ~std::uint64_t{0};
  EXPECT_EQ(philox({ones, ones, ones, ones}, {ones, ones}),
            (Words{0x87b092c3013fe90b, 0x438c3c67be8d0224, 0x9cc7d7c69cd777b6, 0xa09caebf594f0ba0}));
  EXPECT_EQ(philox({0x243f6a8885a308d3, 0x13198a2e03707344, 0xa4093822299f31d0, 0x082efa98ec4e6c89},
                   {0x452821e638d01377, 0xbe5466cf34e90c6c}),
            (Words{0xa528f45403e61d95, 0x38c72dbd566e9788, 0xa5a1610e72fd18b5, 0x57bd43b5e52b7fe6}));
}

TEST(Philox, EqualsRandom123) {
  Stream random(1, 2, 3, Purpose::user);
  for (int i = 0; i < 1000; ++i) {
    std::array<std::uint64_t, 4> const counter{random.bits(), random.bits(), random.bits(), random.bits()};
    std::array<std::uint64_t, 2> const key{random.bits(), random.bits()};
    auto const theirs = r123::Philox4x64()({{counter[0], counter[1], counter[2], counter[3]}}, {{key[0], key[1]}});
    auto const ours = philox(counter, key);
    for (unsigned j = 0; j < 4; ++j) ASSERT_EQ(ours[j], theirs[j]);
  }
}

// ---- Streams ----

TEST(Stream, KeyGoesWholeIntoPhilox) {
  Stream stream(11, 22, 33, 44);
  for (std::uint64_t block = 0; block < 3; ++block)
    for (std::uint64_t const word : philox({block, 22, 33, 0}, {11, 44})) EXPECT_EQ(stream.bits(), word);
  static_assert(Stream(11, 22, 33, 44).bits() == philox({0, 22, 33, 0}, {11, 44})[0]);
  static_assert(std::is_trivially_copyable_v<Stream>);
}

TEST(Stream, SameKeySameBitsOnAnyThreadInAnyOrder) {
  constexpr std::size_t particles = 4000;
  auto const velocity = [](std::size_t i) {
    Stream stream(7, 3, i, Purpose::velocity);
    return Maxwellian(2.0, 3.0)(stream) + stream.uniform() + stream.normal();
  };
  std::vector<double> serial(particles), parallel(particles);
  for (std::size_t i = 0; i < particles; ++i) serial[i] = velocity(i);
  std::vector<std::thread> threads;
  for (std::size_t t = 0; t < 4; ++t)
    threads.emplace_back([&, t] {
      for (std::size_t i = particles - 1 - t; i < particles; i -= 4) parallel[i] = velocity(i);
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(serial, parallel);
}

TEST(Stream, CopyContinuesWhereTheOriginalIs) {
  Stream stream(1, 1, 1, Purpose::user);
  stream.normal();
  Stream copy = stream;
  for (int i = 0; i < 20; ++i) EXPECT_EQ(stream.normal(), copy.normal());
}

TEST(Stream, KeysThatDifferAreIndependent) {
  std::uint64_t const one = test_seed(1), two = test_seed(2);
  Stream const reference(one, 1, 1, Purpose::position);
  double const limit = 5.0 / std::sqrt(100'000.0);
  EXPECT_NEAR(correlation(reference, reference), 1.0, 0.02);
  EXPECT_NEAR(correlation(reference, {two, 1, 1, Purpose::position}), 0.0, limit);
  EXPECT_NEAR(correlation(reference, {one, 2, 1, Purpose::position}), 0.0, limit);
  EXPECT_NEAR(correlation(reference, {one, 1, 2, Purpose::position}), 0.0, limit);
  EXPECT_NEAR(correlation(reference, {one, 1, 1, Purpose::velocity}), 0.0, limit);
  EXPECT_NEAR(correlation(reference, Stream::pair(one, 1, 1, 0, Purpose::position)), 0.0, limit);
}

TEST(Stream, FirstDrawsOfNeighbouringParticlesAndStepsAreIndependent) {
  std::vector<double> over_particles, over_steps;
  double particle_sum = 0, step_sum = 0;
  for (std::uint64_t i = 0; i < draws; ++i) {
    over_particles.push_back(Stream(test_seed(5), 0, i, Purpose::position).uniform());
    over_steps.push_back(Stream(test_seed(5), i, 0, Purpose::position).uniform());
  }
  for (std::size_t i = 1; i < draws; ++i) {
    particle_sum += (over_particles[i] - 0.5) * (over_particles[i - 1] - 0.5);
    step_sum += (over_steps[i] - 0.5) * (over_steps[i - 1] - 0.5);
  }
  EXPECT_NEAR(12.0 * particle_sum / draws, 0.0, 5.0 / std::sqrt(draws));
  EXPECT_NEAR(12.0 * step_sum / draws, 0.0, 5.0 / std::sqrt(draws));
  auto const uniform = [](double x) { return x; };
  EXPECT_LT(kolmogorov_smirnov(over_particles, uniform), kolmogorov_smirnov_limit);
  EXPECT_LT(kolmogorov_smirnov(over_steps, uniform), kolmogorov_smirnov_limit);
}

TEST(Stream, PairIsSymmetricAndItsOwn) {
  Stream ij = Stream::pair(1, 2, 10, 20), ji = Stream::pair(1, 2, 20, 10);
  Stream single(1, 2, 10, Purpose::pair_noise), other = Stream::pair(1, 2, 10, 21), next = Stream::pair(1, 3, 10, 20);
  double const number = ij.normal();
  EXPECT_EQ(number, ji.normal());
  EXPECT_NE(number, single.normal());
  EXPECT_NE(number, other.normal());
  EXPECT_NE(number, next.normal());
  EXPECT_NE(Stream::pair(1, 2, 10, 0).bits(), Stream(1, 2, 0, Purpose::pair_noise).bits());
}

TEST(Stream, PurposesOfUsersAreApart) {
  EXPECT_EQ(static_cast<std::uint32_t>(user_purpose(3)), 0x10003U);
  EXPECT_EQ(Stream(1, 2, 3, user_purpose(3)).bits(), Stream(1, 2, 3, 0x10003U).bits());
  EXPECT_NE(Stream(1, 2, 3, user_purpose(3)).bits(), Stream(1, 2, 3, user_purpose(4)).bits());
}

TEST(Stream, UniformIsInsideTheOpenInterval) {
  Stream stream(2, 0, 0, Purpose::user), words(2, 0, 0, Purpose::user);
  for (int i = 0; i < 1000; ++i) {
    double const u = stream.uniform();
    EXPECT_GT(u, 0.0);
    EXPECT_LT(u, 1.0);
    EXPECT_NEAR(u, static_cast<double>(words.bits()) * 0x1p-64, 0x1p-52);
    EXPECT_EQ(1.0 - (1.0 - u), u);
  }
}

TEST(Stream, BelowIsEvenAndChecksItsCount) {
  Stream stream(test_seed(3), 0, 0, Purpose::selection);
  std::array<int, 7> count{};
  for (int i = 0; i < 210'000; ++i) ++count.at(stream.below(7));
  double chi_squared = 0;
  for (int const c : count) chi_squared += (c - 30'000.0) * (c - 30'000.0) / 30'000.0;
  EXPECT_LT(chi_squared, 40);  // 6 degrees of freedom: exceeded once in 2 million times; 5 % too many of one make 75
  EXPECT_EQ(stream.below(1), 0U);
  // A count of 3/4 of 2^64: a mere remainder would be below 2^62 in half of all draws, not in a third.
  int low = 0;
  for (int i = 0; i < 30'000; ++i) low += stream.below(std::uint64_t{3} << 62) < (std::uint64_t{1} << 62) ? 1 : 0;
  EXPECT_NEAR(low / 30'000.0, 1.0 / 3.0, 5 * std::sqrt(2.0 / 9 / 30'000));
  expect_one_line([&] { stream.below(0); }, "below(0)");
}

// ---- Random variables: moments within 5 standard errors, and Kolmogorov and Smirnov's distance ----

TEST(Uniform, MomentsAndDistribution) {
  auto const x = sample(Uniform(-1.0, 3.0), 101);
  EXPECT_NEAR(mean(x), 1.0, 5 * std::sqrt(16.0 / 12.0 / draws));
  EXPECT_NEAR(variance(x), 16.0 / 12.0, 5 * 16.0 / 12.0 * std::sqrt(0.8 / draws));
  EXPECT_LT(kolmogorov_smirnov(x, [](double v) { return (v + 1.0) / 4.0; }), kolmogorov_smirnov_limit);
  EXPECT_EQ(Uniform(-1.0, 3.0).quantile(0.25), 0.0);
  EXPECT_EQ(Uniform(-1.0, 3.0).quantile(1.0), 3.0);
  Stream stream(0, 0, 0, Purpose::user);
  EXPECT_EQ(Uniform(2.0, 2.0)(stream), 2.0);
}

TEST(Normal, MomentsAndDistribution) {
  auto const x = sample(Normal(5.0, 2.0), 102);
  EXPECT_NEAR(mean(x), 5.0, 5 * 2.0 / std::sqrt(draws));
  EXPECT_NEAR(variance(x), 4.0, 5 * 4.0 * std::sqrt(2.0 / draws));  // the second parameter is no variance
  EXPECT_LT(kolmogorov_smirnov(x, [](double v) { return normal_distribution((v - 5.0) / 2.0); }),
            kolmogorov_smirnov_limit);
  double fourth = 0, tail = 0;
  for (double const v : x) {
    fourth += std::pow((v - 5.0) / 2.0, 4) / draws;
    tail += std::abs(v - 5.0) > 6.0 ? 1.0 / draws : 0.0;
  }
  EXPECT_NEAR(fourth, 3.0, 5 * std::sqrt(96.0 / draws));
  EXPECT_NEAR(tail, 2.0 * normal_distribution(-3.0), 5 * std::sqrt(0.0027 / draws));
}

TEST(Normal, SuccessiveDrawsAreIndependent) {
  auto const x = sample(Normal(0.0, 1.0), 103);
  for (std::size_t lag = 1; lag <= 4; ++lag) {
    double product = 0, squares = 0;
    for (std::size_t i = lag; i < x.size(); ++i) {
      product += x[i] * x[i - lag];
      squares += (x[i] * x[i] - 1.0) * (x[i - lag] * x[i - lag] - 1.0);
    }
    EXPECT_NEAR(product / draws, 0.0, 5 / std::sqrt(draws)) << lag;
    EXPECT_NEAR(squares / draws, 0.0, 5 * 2 / std::sqrt(draws)) << lag;
  }
}

TEST(Normal, QuantileAgainstPublishedValues) {
  Normal const z(0.0, 1.0);
  EXPECT_NEAR(z.quantile(0.975), 1.959963984540054, 2e-15);
  EXPECT_NEAR(z.quantile(0.995), 2.575829303548901, 4e-15);
  EXPECT_NEAR(z.quantile(0.75), 0.6744897501960817, 1e-15);
  EXPECT_NEAR(z.quantile(0.5), 0.0, 1e-15);
  EXPECT_NEAR(z.quantile(1e-9), -5.997807015007686871562, 5e-15);
  EXPECT_EQ(z.quantile(0.0), -infinity);
  EXPECT_EQ(z.quantile(1.0), infinity);
  for (double const u : {1e-300, 1e-20, 1e-5, 0.02, 0.3, 0.5})
    EXPECT_NEAR(normal_distribution(z.quantile(u)) / u, 1.0, 1e-12) << u;
  EXPECT_NEAR(Normal(5.0, 2.0).quantile(0.025), 5.0 - 2.0 * 1.959963984540054, 1e-14);
  EXPECT_EQ(Normal(5.0, 0.0).quantile(0.0), 5.0);
}

TEST(Maxwellian, KineticEnergyIsHalfKT) {
  double const boltzmann_constant = 1.380649e-16, temperature = 16'000.0, mass = 9.1093837e-28;  // electrons, cgs
  Maxwellian const variable(temperature, mass, boltzmann_constant);
  auto const v = sample(variable, 104);
  double energy = 0;
  for (double const x : v) energy += 0.5 * mass * x * x / draws;
  EXPECT_NEAR(energy / (0.5 * boltzmann_constant * temperature), 1.0, 5 * std::sqrt(2.0 / draws));
  double const s = std::sqrt(boltzmann_constant * temperature / mass);
  EXPECT_NEAR(mean(v) / s, 0.0, 5 / std::sqrt(draws));
  EXPECT_LT(kolmogorov_smirnov(v, [&](double x) { return normal_distribution(x / s); }), kolmogorov_smirnov_limit);
  EXPECT_NEAR(variable.quantile(0.975) / s, 1.959963984540054, 1e-14);
  EXPECT_EQ(Maxwellian(8.0, 2.0).standard_deviation(), 2.0);  // (temperature, mass), k = 1
  Stream stream(0, 0, 0, Purpose::velocity);
  EXPECT_EQ(Maxwellian(0.0, 2.0)(stream), 0.0);
}

TEST(Exponential, MomentsAndDistribution) {
  Exponential const variable(4.0);
  auto const x = sample(variable, 105);
  EXPECT_NEAR(mean(x), 0.25, 5 * 0.25 / std::sqrt(draws));
  EXPECT_NEAR(variance(x), 0.0625, 5 * 0.0625 * std::sqrt(8.0 / draws));
  EXPECT_GT(*std::min_element(x.begin(), x.end()), 0.0);
  EXPECT_LT(kolmogorov_smirnov(x, [](double v) { return 1.0 - std::exp(-4.0 * v); }), kolmogorov_smirnov_limit);
  EXPECT_NEAR(variable.quantile(0.5), std::numbers::ln2 / 4.0, 1e-16);
  EXPECT_EQ(variable.quantile(0.0), 0.0);
  EXPECT_EQ(variable.quantile(1.0), infinity);
}

/// The textbook integral of nu + mu sin(alpha x + beta), alpha != 0.
double ripple_distribution(Ripple const& r, double x) {
  auto const integral = [&](double end) {
    return r.nu * (end - r.a) - r.mu / r.alpha * (std::cos(r.alpha * end + r.beta) - std::cos(r.alpha * r.a + r.beta));
  };
  return integral(x) / integral(r.b);
}

TEST(Ripple, MomentsAndDistribution) {
  Ripple const whole_waves(0.0, 2.0, 3 * pi, 0.0, 0.2, 1.0);  // appendix A.4: three waves on [0, L]
  Ripple const part(-1.0, 4.0, 1.3, 0.7, -0.9, 1.1);
  for (Ripple const& variable : {whole_waves, part}) {
    auto const x = sample(variable, 106);
    EXPECT_LT(kolmogorov_smirnov(x, [&](double v) { return ripple_distribution(variable, v); }),
              kolmogorov_smirnov_limit);
    EXPECT_GE(*std::min_element(x.begin(), x.end()), variable.a);
    EXPECT_LE(*std::max_element(x.begin(), x.end()), variable.b);
    double exact_mean = 0;  // by the midpoint rule
    for (int i = 0; i < 10'000; ++i) {
      double const v = variable.a + (i + 0.5) * (variable.b - variable.a) / 10'000;
      exact_mean += v * variable.density(v) * (variable.b - variable.a) / 10'000;
    }
    EXPECT_NEAR(mean(x), exact_mean, 5 * (variable.b - variable.a) / std::sqrt(12.0 * draws));
  }
  auto const x = sample(whole_waves, 107);
  double first = 0;
  for (double const v : x) first += std::sin(3 * pi * v) / draws;
  EXPECT_NEAR(first, 0.1, 5 * std::sqrt(0.5 / draws));  // <sin(alpha x + beta)> = mu / (2 nu) over whole waves
}

TEST(Ripple, QuantileInvertsTheDistributionToRounding) {
  for (Ripple const& r : {Ripple(0.0, 2.0, 3 * pi, 0.0, 0.2, 1.0), Ripple(-1.0, 4.0, 1.3, 0.7, -0.9, 1.1),
                          Ripple(0.0, 1.0, 200 * pi, 1.0, 3.0, 3.0), Ripple(1e5, 1e5 + 1.0, 6 * pi, 0.0, 0.5, 1.0)}) {
    double const rounding = 1e-15 + 4e-16 * std::max(std::abs(r.a), std::abs(r.b)) * r.alpha;
    double previous = r.a;
    for (int i = 0; i <= 1000; ++i) {
      double const u = i / 1000.0, x = r.quantile(u);
      EXPECT_NEAR(ripple_distribution(r, x), u, 10 * rounding);
      EXPECT_NEAR(r.distribution(x), u, 10 * rounding);
      EXPECT_GE(x, previous);
      previous = x;
    }
    EXPECT_EQ(r.quantile(0.0), r.a);
    EXPECT_EQ(r.quantile(1.0), r.b);
  }
}

TEST(Ripple, QuietStartHasOnlyItsOwnWave) {
  // Fourier coefficients of the exact density: mu / (2 nu) in the wave itself, nothing in the cosine and the other
  // waves.
  Ripple const variable(0.0, 2.0, 3 * pi, 0.0, 0.2, 1.0);
  int const n = 1000;
  double sine = 0, cosine = 0, first_wave = 0;
  for (int i = 0; i < n; ++i) {
    double const x = variable.quantile((i + 0.5) / n);
    sine += std::sin(3 * pi * x) / n;
    cosine += std::cos(3 * pi * x) / n;
    first_wave += std::sin(pi * x) / n;
  }
  EXPECT_NEAR(sine, 0.1, 1e-13);
  EXPECT_NEAR(cosine, 0.0, 1e-13);
  EXPECT_NEAR(first_wave, 0.0, 1e-13);
}

TEST(Ripple, LimitsOfItsParameters) {
  Ripple const flat(2.0, 6.0, 1.0, 0.0, 0.0, 5.0);
  EXPECT_NEAR(flat.quantile(0.25), 3.0, 1e-15);
  EXPECT_NEAR(flat.density(3.0), 0.25, 1e-15);
  EXPECT_EQ(flat.density(1.9), 0.0);
  EXPECT_EQ(flat.distribution(1.0), 0.0);
  EXPECT_EQ(flat.distribution(7.0), 1.0);
  Ripple const constant(0.0, 1.0, 0.0, 0.3, 0.5, 1.0);
  EXPECT_NEAR(constant.quantile(0.7), 0.7, 1e-15);
  // alpha so small that (cos - cos) / alpha keeps four digits; the density is constant to 1e-12
  Ripple const slope(0.0, 1.0, 1e-12, pi / 6, 1.0, 1.0);
  EXPECT_NEAR(slope.quantile(0.36), 0.36, 1e-11);
  // A density that vanishes at both ends, 1 - cos(2 pi x): symmetric, and cubic at 0: distribution ~ (2/3) pi^2 x^3.
  Ripple const humps(0.0, 1.0, 2 * pi, -pi / 2, 1.0, 1.0);
  EXPECT_NEAR(humps.quantile(0.5), 0.5, 1e-15);
  EXPECT_NEAR(humps.quantile(0.2) + humps.quantile(0.8), 1.0, 1e-14);
  EXPECT_NEAR(humps.quantile(1e-9) / std::cbrt(1.5e-9 / (pi * pi)), 1.0, 1e-5);
}

TEST(RandomVariables, WrongParametersAreOneReadableLine) {
  expect_one_line([] { Uniform(3.0, 1.0); }, "Uniform(low = 3, high = 1)");
  expect_one_line([] { Uniform(nan, 1.0); }, "low <= high");
  expect_one_line([] { Uniform(0.0, infinity); }, "finite");
  expect_one_line([] { Normal(0.0, -1.0); }, "standard_deviation >= 0");
  expect_one_line([] { Normal(0.0, nan); }, "finite");
  expect_one_line([] { Maxwellian(-1.0, 1.0); }, "temperature >= 0");
  expect_one_line([] { Maxwellian(1.0, 0.0); }, "mass > 0");
  expect_one_line([] { Maxwellian(1.0, 1.0, 0.0); }, "boltzmann_constant > 0");
  expect_one_line([] { Maxwellian(nan, 1.0); }, "finite");
  expect_one_line([] { Exponential(0.0); }, "rate");
  expect_one_line([] { Exponential(-2.0); }, "rate = -2");
  expect_one_line([] { Exponential{nan}; }, "finite");
  expect_one_line([] { Ripple(0, 1, 1, 0, 1.5, 1.0); }, "|mu|");
  expect_one_line([] { Ripple(0, 1, 1, 0, 0.5, -1.0); }, "|mu|");
  expect_one_line([] { Ripple(0, 1, 1, 0, 0.0, 0.0); }, "zero everywhere");
  expect_one_line([] { Ripple(1, 1, 1, 0, 0.5, 1.0); }, "smaller than b");
  expect_one_line([] { Ripple(0, 1, nan, 0, 0.5, 1.0); }, "finite");
  expect_one_line([] { Ripple(0, 1, 1, 0, 0.5, 1.0).quantile(1.5); }, "[0, 1]");
  expect_one_line([] { Normal(0, 1).quantile(nan); }, "[0, 1]");
  expect_one_line([] { Uniform(0, 1).quantile(-0.1); }, "[0, 1]");
  expect_one_line([] { Exponential(1).quantile(2.0); }, "[0, 1]");
  expect_one_line([] { Maxwellian(1, 1).quantile(2.0); }, "[0, 1]");
}

}  // namespace
}  // namespace boltzmann::random_test
