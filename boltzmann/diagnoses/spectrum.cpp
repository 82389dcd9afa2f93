// Averaged windowed periodograms, and interpolation of particles on a line to a uniform grid.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/fourier.hpp>
#include <boltzmann/diagnoses/spectrum.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace boltzmann {
namespace {

/// The triangle that reaches 0 one half sample beyond both ends (section 5.2.3.5).
std::vector<double> parzen_window(std::size_t length) {
  double const middle = 0.5 * (static_cast<double>(length) - 1.0);
  double const half_width = 0.5 * (static_cast<double>(length) + 1.0);
  std::vector<double> window(length);
  for (std::size_t j = 0; j < length; ++j) window[j] = 1.0 - std::abs((static_cast<double>(j) - middle) / half_width);
  return window;
}

std::vector<double> sine_squared_window(std::size_t length) {
  std::vector<double> window(length);
  for (std::size_t j = 0; j < length; ++j) {
    double const sine = std::sin(std::numbers::pi * (static_cast<double>(j) + 0.5) / static_cast<double>(length));
    window[j] = sine * sine;
  }
  return window;
}

/// The average of the windowed periodograms of segments, all as long as the window.
Spectrum averaged_periodogram(std::span<std::span<double const> const> segments, std::span<double const> window,
                              double spacing) {
  std::size_t const length = window.size();
  double const window_power = std::inner_product(window.begin(), window.end(), window.begin(), 0.0);
  Spectrum spectrum;
  spectrum.resolution = 1.0 / (static_cast<double>(length) * spacing);
  spectrum.density.resize(length / 2 + 1);
  for (std::size_t k = 0; k < spectrum.density.size(); ++k)
    spectrum.frequency.push_back(static_cast<double>(k) * spectrum.resolution);

  LineTransform const transform(FourierKind::real_to_complex, length);
  FourierArray input(length), output(2 * (length / 2 + 1));
  for (auto const segment : segments) {
    for (std::size_t j = 0; j < length; ++j) input[j] = window[j] * segment[j];
    transform.execute(input.data(), output.data());
    for (std::size_t k = 0; k < spectrum.density.size(); ++k) {
      // k and length - k have the same power; 0 and Nyquist are their own partners.
      double const partners = k == 0 || 2 * k == length ? 1.0 : 2.0;
      spectrum.density[k] += partners * (output[2 * k] * output[2 * k] + output[2 * k + 1] * output[2 * k + 1]);
    }
  }
  double const scale = spacing / (window_power * static_cast<double>(segments.size()));
  for (double& density : spectrum.density) density *= scale;
  return spectrum;
}

void check_samples(std::span<double const> samples, double spacing) {
  if (samples.size() < 2)
    throw Error(fmt::format("power_spectrum: {} sample(s) given; a spectrum needs at least 2", samples.size()));
  if (samples.size() > static_cast<std::size_t>(std::numeric_limits<int>::max()))
    throw Error(fmt::format("power_spectrum: {} samples given; at most {} are allowed", samples.size(),
                            std::numeric_limits<int>::max()));
  if (!(spacing > 0.0 && std::isfinite(spacing)))
    throw Error(fmt::format("power_spectrum: the spacing of the samples is {}; it must be finite and > 0", spacing));
  for (std::size_t j = 0; j < samples.size(); ++j)
    if (!std::isfinite(samples[j]))
      throw Error(fmt::format("power_spectrum: sample {} is {}; all samples must be finite", j, samples[j]));
}

std::vector<double> without_mean(std::span<double const> samples) {
  double const mean = std::accumulate(samples.begin(), samples.end(), 0.0) / static_cast<double>(samples.size());
  std::vector<double> rest(samples.begin(), samples.end());
  for (double& value : rest) value -= mean;
  return rest;
}

}  // namespace

Spectrum power_spectrum(std::span<double const> samples, double spacing, SpectrumMethod method, bool subtract_mean) {
  check_samples(samples, spacing);
  if (subtract_mean) return power_spectrum(without_mean(samples), spacing, method, false);

  std::size_t const n = samples.size();
  std::size_t length = 0;
  std::size_t count = 0;
  std::vector<double> window;
  switch (method) {
    case SpectrumMethod::parzen_two_segments:
      length = (n + 1) / 2;  // for an odd number of samples, both segments have the one in the middle
      count = 2;
      window = parzen_window(length);
      break;
    case SpectrumMethod::welch:
      count = n < 16 ? 1 : 8;
      length = n < 16 ? n : (2 * n + 8) / 9;  // eight half-overlapping segments span 4.5 lengths
      window = sine_squared_window(length);
      break;
  }
  std::vector<std::span<double const>> segments;
  for (std::size_t i = 0; i < count; ++i)
    segments.push_back(samples.subspan(count == 1 ? 0 : i * (n - length) / (count - 1), length));
  return averaged_periodogram(segments, window, spacing);
}

Spectrum power_spectrum(std::span<double const> first, std::span<double const> second, double spacing,
                        bool subtract_mean) {
  if (first.size() != second.size())
    throw Error(fmt::format("power_spectrum: the two segments have {} and {} samples; they must be of the same length",
                            first.size(), second.size()));
  check_samples(first, spacing);
  check_samples(second, spacing);
  if (subtract_mean) return power_spectrum(without_mean(first), without_mean(second), spacing, false);
  std::array<std::span<double const>, 2> const segments{first, second};
  return averaged_periodogram(segments, parzen_window(first.size()), spacing);
}

UniformSamples sample_uniformly(std::span<double const> positions, std::span<double const> values, std::size_t n) {
  if (positions.size() != values.size())
    throw Error(fmt::format("sample_uniformly: {} positions but {} values; there must be one value for each position",
                            positions.size(), values.size()));
  if (n < 2) throw Error(fmt::format("sample_uniformly: {} point(s) requested; at least 2 are needed", n));
  for (std::size_t i = 0; i < positions.size(); ++i)
    if (!std::isfinite(positions[i]) || !std::isfinite(values[i]))
      throw Error(fmt::format("sample_uniformly: particle {} has position {} and value {}; both must be finite", i,
                              positions[i], values[i]));

  std::vector<std::size_t> order(positions.size());
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(),
                   [&](std::size_t i, std::size_t j) { return positions[i] < positions[j]; });

  struct Knot {
    double position;
    double value;
  };
  std::vector<Knot> knots;
  for (std::size_t i = 0; i < order.size();) {
    double const position = positions[order[i]];
    double sum = 0.0;
    std::size_t count = 0;
    for (; i < order.size() && positions[order[i]] == position; ++i, ++count) sum += values[order[i]];
    knots.push_back({position, sum / static_cast<double>(count)});
  }
  if (knots.size() < 2)
    throw Error(
        fmt::format("sample_uniformly: {} particle(s) at {} different position(s); at least 2 positions must differ",
                    positions.size(), knots.size()));

  UniformSamples samples;
  samples.first = knots.front().position;
  double const extent = knots.back().position - knots.front().position;
  samples.spacing = extent / static_cast<double>(n - 1);
  for (std::size_t i = 1; i < knots.size(); ++i)
    samples.largest_gap = std::max(samples.largest_gap, knots[i].position - knots[i - 1].position);

  std::size_t left = 0;
  for (std::size_t j = 0; j < n; ++j) {
    double const x = samples.first + extent * (static_cast<double>(j) / static_cast<double>(n - 1));
    while (left + 2 < knots.size() && knots[left + 1].position <= x) ++left;
    Knot const& a = knots[left];
    Knot const& b = knots[left + 1];
    double const fraction = std::clamp((x - a.position) / (b.position - a.position), 0.0, 1.0);
    samples.value.push_back((1.0 - fraction) * a.value + fraction * b.value);
  }
  return samples;
}

}  // namespace boltzmann
