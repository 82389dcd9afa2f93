// The spectrum estimator against signals whose power is known, and against Parseval's theorem.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/diagnoses/spectrum.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <complex>
#include <functional>
#include <limits>
#include <numbers>
#include <numeric>
#include <string>
#include <thread>

namespace boltzmann::spectrum_test {
namespace {

using std::numbers::pi;
using Series = std::vector<double>;
constexpr SpectrumMethod methods[] = {SpectrumMethod::parzen_two_segments, SpectrumMethod::welch};

Series series(std::size_t n, double spacing, std::function<double(double)> const& signal, double start = 0.0) {
  Series samples(n);
  for (std::size_t j = 0; j < n; ++j) samples[j] = signal(start + static_cast<double>(j) * spacing);
  return samples;
}

Series noise(std::size_t n, double standard_deviation, std::uint64_t seed) {
  Stream stream(test_seed(seed), 0, 0, Purpose::user);
  Normal const variable(0.0, standard_deviation);
  Series samples(n);
  for (double& value : samples) value = variable(stream);
  return samples;
}

double power(Spectrum const& s, double from = 0.0, double to = 1e300) {
  double sum = 0;
  for (std::size_t k = 0; k < s.frequency.size(); ++k)
    if (s.frequency[k] >= from && s.frequency[k] < to) sum += s.density[k] * s.resolution;
  return sum;
}

double peak(Spectrum const& s) {
  auto const highest = std::max_element(s.density.begin(), s.density.end());
  return s.frequency[static_cast<std::size_t>(highest - s.density.begin())];
}

void expect_error(std::function<void()> const& action, std::string const& part) {
  std::string const line = message(action);
  EXPECT_NE(line.find(part), std::string::npos) << line;
}

/// The thesis' window, as printed.
double parzen(std::size_t j, std::size_t n) {
  double const size = static_cast<double>(n);
  return 1.0 - std::abs((static_cast<double>(j) - (size - 1) / 2) / ((size + 1) / 2));
}

TEST(PowerSpectrum, ASinusoidHasItsFrequencyAndItsPower) {
  double const amplitude = 3.0, frequency = 12.345, spacing = 0.01;
  for (SpectrumMethod const method : methods)
    for (std::size_t const n : {1000U, 1024U, 1361U}) {
      Series const samples =
          series(n, spacing, [&](double t) { return amplitude * std::sin(2 * pi * frequency * t + 0.4); });
      Spectrum const spectrum = power_spectrum(samples, spacing, method);
      EXPECT_NEAR(peak(spectrum), frequency, 0.5 * spectrum.resolution + 1e-12);
      EXPECT_NEAR(power(spectrum) / (0.5 * amplitude * amplitude), 1.0, 0.01) << n;
      double const width = 4 * spectrum.resolution;
      EXPECT_GT(power(spectrum, frequency - width, frequency + width) / power(spectrum), 0.99) << n;
    }
}

TEST(PowerSpectrum, FrequenciesReachFromZeroToNyquist) {
  Spectrum const even = power_spectrum(noise(200, 1.0, 1), 0.5);
  ASSERT_EQ(even.frequency.size(), 51U);  // two segments of 100
  EXPECT_EQ(even.density.size(), 51U);
  EXPECT_EQ(even.frequency.front(), 0.0);
  EXPECT_NEAR(even.frequency.back(), 1.0, 1e-14);
  EXPECT_NEAR(even.resolution, 0.02, 1e-16);
  Spectrum const welch = power_spectrum(noise(450, 1.0, 1), 0.5, SpectrumMethod::welch);
  EXPECT_NEAR(welch.resolution, 0.02, 1e-16);  // segments of N / 4.5 = 100
}

TEST(PowerSpectrum, WhiteNoiseIsFlatAtTwiceItsVarianceTimesTheSpacing) {
  double const spacing = 0.1, deviation = 2.0, level = 2 * deviation * deviation * spacing;
  for (SpectrumMethod const method : methods) {
    Spectrum const spectrum = power_spectrum(noise(200'000, deviation, 2), spacing, method);
    double const nyquist = 0.5 / spacing;
    for (int band = 0; band < 10; ++band)
      EXPECT_NEAR(power(spectrum, band * nyquist / 10, (band + 1) * nyquist / 10) / (nyquist / 10) / level, 1.0, 0.05)
          << band;
    EXPECT_NEAR(power(spectrum) / (deviation * deviation), 1.0, 0.015);
  }
}

TEST(PowerSpectrum, WelchIsLessNoisyThanTwoSegments) {
  // Relative variance of a density: 1/2 for two independent segments; about 1 / (8 segments) / 1.1 for Welch.
  auto const scatter = [](Spectrum const& s) {
    double sum = 0, squares = 0;
    for (std::size_t k = 4; k + 4 < s.density.size(); ++k) {
      sum += s.density[k];
      squares += s.density[k] * s.density[k];
    }
    double const count = static_cast<double>(s.density.size()) - 8;
    return squares / count / (sum / count * sum / count) - 1.0;
  };
  Series const samples = noise(100'000, 1.0, 3);
  EXPECT_NEAR(scatter(power_spectrum(samples, 1.0)), 0.5, 0.05);
  EXPECT_NEAR(scatter(power_spectrum(samples, 1.0, SpectrumMethod::welch)), 0.13, 0.025);
}

TEST(PowerSpectrum, ParsevalHoldsForSegmentsOfAnyLength) {
  for (std::size_t const n : {2U, 3U, 7U, 64U, 97U, 100U, 1001U}) {
    Series const first = noise(n, 1.0, 10 + n), second = noise(n, 3.0, 20 + n);
    double weighted = 0, window_power = 0;
    for (std::size_t j = 0; j < n; ++j) {
      double const w = parzen(j, n);
      weighted += 0.5 * w * w * (first[j] * first[j] + second[j] * second[j]);
      window_power += w * w;
    }
    EXPECT_NEAR(power(power_spectrum(first, second, 0.25)) / (weighted / window_power), 1.0, 1e-13) << n;
  }
}

TEST(PowerSpectrum, EqualsTheDefinitionTermByTerm) {
  std::size_t const n = 15;
  double const spacing = 0.2;
  Series const first = noise(n, 1.0, 5), second = noise(n, 1.0, 6);
  Spectrum const spectrum = power_spectrum(first, second, spacing);
  double window_power = 0;
  for (std::size_t j = 0; j < n; ++j) window_power += parzen(j, n) * parzen(j, n);
  ASSERT_EQ(spectrum.density.size(), 8U);
  for (std::size_t k = 0; k < 8; ++k) {
    double const f = spectrum.frequency[k];
    double expected = 0;  // |H(f)|^2 + |H(-f)|^2
    for (double const sign : {1.0, -1.0})
      for (Series const* segment : {&first, &second}) {
        std::complex<double> h = 0;
        for (std::size_t j = 0; j < n; ++j)
          h += parzen(j, n) * (*segment)[j] * std::polar(1.0, sign * 2 * pi * f * static_cast<double>(j) * spacing);
        if (k > 0 || sign > 0) expected += 0.5 * std::norm(h) * spacing / window_power;
      }
    EXPECT_NEAR(spectrum.density[k], expected, 1e-13);
  }
}

TEST(PowerSpectrum, OneSeriesIsItsTwoHalves) {
  Series const samples = noise(101, 1.0, 7);
  std::span<double const> const all = samples;
  Spectrum const one = power_spectrum(samples, 0.1);
  Spectrum const two = power_spectrum(all.first(51), all.last(51), 0.1);  // the sample in the middle is in both
  EXPECT_EQ(one.density, two.density);
  EXPECT_EQ(one.frequency, two.frequency);
}

TEST(PowerSpectrum, TwoSinusoidsAreResolved) {
  double const spacing = 0.01;
  for (SpectrumMethod const method : methods) {
    Series const samples =
        series(2000, spacing, [](double t) { return 2 * std::sin(2 * pi * 10 * t) + std::cos(2 * pi * 13 * t); });
    Spectrum const spectrum = power_spectrum(samples, spacing, method);
    EXPECT_NEAR(power(spectrum, 8.5, 11.5), 2.0, 0.03);
    EXPECT_NEAR(power(spectrum, 11.5, 14.5), 0.5, 0.0125);
    auto const density = [&](double f) {
      return spectrum.density.at(static_cast<std::size_t>(std::lround(f / spectrum.resolution)));
    };
    EXPECT_GT(density(10.0), 100 * density(11.5));
    EXPECT_GT(density(13.0), 25 * density(11.5));
  }
}

TEST(PowerSpectrum, TheMeanIsKeptUnlessAskedFor) {
  Series const samples = series(400, 0.01, [](double t) { return 5.0 + std::sin(2 * pi * 20 * t); });
  EXPECT_EQ(peak(power_spectrum(samples, 0.01)), 0.0);
  EXPECT_NEAR(power(power_spectrum(samples, 0.01)), 25.5, 0.1);
  for (SpectrumMethod const method : methods) {
    Spectrum const spectrum = power_spectrum(samples, 0.01, method, true);
    EXPECT_NEAR(peak(spectrum), 20.0, spectrum.resolution / 2 + 1e-12);
    EXPECT_NEAR(power(spectrum), 0.5, 0.005);
  }
  Series const first(100, 3.0), second(100, -4.0);
  EXPECT_EQ(power(power_spectrum(first, second, 1.0, true)), 0.0);
  EXPECT_NEAR(power(power_spectrum(first, second, 1.0)), 12.5, 1e-12);
}

TEST(PowerSpectrum, SmallestSeries) {
  Spectrum const pair = power_spectrum(Series{3.0, 4.0}, 0.5);
  ASSERT_EQ(pair.density.size(), 1U);  // two segments of one sample
  EXPECT_NEAR(power(pair), 12.5, 1e-14);
  for (std::size_t n = 2; n < 40; ++n)
    for (SpectrumMethod const method : methods)
      EXPECT_NEAR(power(power_spectrum(Series(n, 2.0), 0.1, method)), 4.0, 1e-13) << n;
}

TEST(PowerSpectrum, WrongInput) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  expect_error([] { power_spectrum(Series{}, 1.0); }, "0 sample(s)");
  expect_error([] { power_spectrum(Series{1.0}, 1.0); }, "1 sample(s)");
  expect_error([&] { power_spectrum(Series{1.0, 2.0, nan}, 1.0); }, "sample 2");
  expect_error([] { power_spectrum(Series{1.0, 2.0}, 0.0); }, "spacing");
  expect_error([&] { power_spectrum(Series{1.0, 2.0}, nan); }, "spacing");
  expect_error([] { power_spectrum(Series(5, 0.0), Series(6, 0.0), 1.0); }, "5 and 6");
  expect_error([] { power_spectrum(Series(1, 0.0), Series(1, 0.0), 1.0); }, "at least 2");
  expect_error([&] { power_spectrum(Series{1.0, 2.0}, Series{1.0, nan}, 1.0); }, "sample 1");
}

TEST(PowerSpectrum, RunsInManyThreads) {
  Series const samples = noise(1000, 1.0, 8);
  Spectrum const expected = power_spectrum(samples, 0.1);
  std::vector<std::thread> threads;
  std::vector<int> same(4, 0);
  for (std::size_t t = 0; t < same.size(); ++t)
    threads.emplace_back([&, t] {
      for (int i = 0; i < 50; ++i) same[t] += power_spectrum(samples, 0.1).density == expected.density ? 1 : 0;
    });
  for (auto& thread : threads) thread.join();
  EXPECT_EQ(same, std::vector<int>(4, 50));
}

// ---- Particles on a line ----

TEST(SampleUniformly, UniformParticlesInAnyOrderGiveTheirOwnValues) {
  std::size_t const n = 101;
  Series positions(n), values(n);
  for (std::size_t i = 0; i < n; ++i) {
    std::size_t const place = i * 37 % n;  // a permutation
    positions[i] = -1.0 + 0.02 * static_cast<double>(place);
    values[i] = static_cast<double>(place * place);
  }
  UniformSamples const samples = sample_uniformly(positions, values, n);
  EXPECT_EQ(samples.first, -1.0);
  EXPECT_NEAR(samples.spacing, 0.02, 1e-15);
  EXPECT_NEAR(samples.largest_gap, 0.02, 1e-15);
  ASSERT_EQ(samples.value.size(), n);
  for (std::size_t j = 0; j < n; ++j) EXPECT_NEAR(samples.value[j], static_cast<double>(j * j), 1e-9) << j;
}

TEST(SampleUniformly, AStraightLineStaysStraight) {
  Stream stream(test_seed(9), 0, 0, Purpose::position);
  Series positions(300), values(300);
  for (std::size_t i = 0; i < 300; ++i) {
    positions[i] = 10 * stream.uniform();
    values[i] = 3 * positions[i] - 1;
  }
  UniformSamples const samples = sample_uniformly(positions, values, 77);
  for (std::size_t j = 0; j < 77; ++j)
    EXPECT_NEAR(samples.value[j], 3 * (samples.first + static_cast<double>(j) * samples.spacing) - 1, 1e-12);
  EXPECT_GT(samples.largest_gap, 10.0 / 300);
  EXPECT_LT(samples.largest_gap, 0.5);
}

TEST(SampleUniformly, GivesTheWaveOfDisplacedParticles) {
  // A wave of 8 periods on [0, 1] carried by 400 particles that are displaced by up to a third of their distance.
  Stream stream(test_seed(10), 0, 0, Purpose::position);
  Series positions, values;
  for (int i = 0; i < 400; ++i) {
    positions.push_back((i + 0.5 + (stream.uniform() - 0.5) / 1.5) / 400);
    values.push_back(0.7 * std::sin(2 * pi * 8 * positions.back()));
  }
  UniformSamples const samples = sample_uniformly(positions, values, 400);
  Spectrum const spectrum = power_spectrum(samples.value, samples.value, samples.spacing);
  EXPECT_NEAR(peak(spectrum), 8.0, spectrum.resolution / 2);
  EXPECT_NEAR(power(spectrum) / (0.5 * 0.49), 1.0, 0.01);
}

TEST(SampleUniformly, ParticlesAtOnePositionCountWithTheirMean) {
  UniformSamples const samples = sample_uniformly(Series{1, 0, 1, 2}, Series{10, 0, 20, 5}, 3);
  EXPECT_EQ(samples.value, (Series{0, 15, 5}));
  EXPECT_EQ(sample_uniformly(Series{0, 1}, Series{2, 4}, 2).value, (Series{2, 4}));
}

TEST(SampleUniformly, WrongInput) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  expect_error([] { sample_uniformly(Series{}, Series{}, 4); }, "0 particle(s)");
  expect_error([] { sample_uniformly(Series{1}, Series{1}, 4); }, "1 particle(s)");
  expect_error([] { sample_uniformly(Series{1, 1}, Series{1, 2}, 4); }, "1 different position(s)");
  expect_error([] { sample_uniformly(Series{1, 2}, Series{1}, 4); }, "2 positions but 1 values");
  expect_error([] { sample_uniformly(Series{1, 2}, Series{1, 2}, 1); }, "at least 2");
  expect_error([&] { sample_uniformly(Series{1, nan}, Series{1, 2}, 4); }, "particle 1");
  expect_error([&] { sample_uniformly(Series{1, 2}, Series{nan, 2}, 4); }, "particle 0");
}

}  // namespace
}  // namespace boltzmann::spectrum_test
