// From profiles at equal times to power over wave number and frequency.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/fourier.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/wave_spectrum.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t usual_modes = 256;
constexpr std::size_t min_looks = 4;

}  // namespace

WaveSpectrum::WaveSpectrum(std::string quantity, int axis, std::size_t modes)
    : quantity_(std::move(quantity)), axis_(axis), modes_wanted_(modes) {}

void WaveSpectrum::measure(Sample const& sample, std::vector<double>&) {
  MeshQuantity const quantity = mesh_quantity(sample.mesh_fields, quantity_);
  MeshGrid const& grid = quantity.grid();
  auto const line = profile(quantity, axis_);
  if (!grid.periodic[axis_])
    throw Error(fmt::format("wave spectrum: the axis {} is not periodic, so that no waves belong to it", "xyz"[axis_]));
  std::size_t const n = line.size(), most = modes_wanted_ > 0 ? modes_wanted_ : usual_modes;
  std::size_t const modes = std::min(n / 2, most);
  if (looks_ > 0 && modes != modes_)
    throw Error(fmt::format("wave spectrum: the mesh shows {} modes now, it was {}", modes, modes_));
  if (looks_ == 1) interval_ = sample.time - first_;
  if (looks_ > 1 && std::abs(sample.time - last_ - interval_) > 1e-6 * std::abs(interval_))
    throw Error(
        fmt::format("wave spectrum: sampling intervals must be equal; {} follows {}, before that the interval was {}",
                    sample.time, last_, interval_));
  if (looks_ == 0) first_ = sample.time;
  last_ = sample.time;
  modes_ = modes;
  length_ = static_cast<double>(n) * grid.spacing[axis_];
  dimension_ = quantity.dimension();

  FourierArray input(n), output(2 * (n / 2 + 1));
  std::copy(line.begin(), line.end(), input.data());
  LineTransform(FourierKind::real_to_complex, n).execute(input.data(), output.data());
  for (std::size_t k = 0; k < 2 * (modes + 1); ++k) amplitudes_.push_back(output[k] / static_cast<double>(n));
  ++looks_;
}

std::vector<double> WaveSpectrum::state() const {
  std::vector<double> state{static_cast<double>(modes_),
                            static_cast<double>(looks_),
                            length_,
                            first_,
                            last_,
                            interval_,
                            static_cast<double>(dimension_.length),
                            static_cast<double>(dimension_.mass),
                            static_cast<double>(dimension_.time),
                            static_cast<double>(dimension_.temperature),
                            static_cast<double>(dimension_.charge)};
  state.insert(state.end(), amplitudes_.begin(), amplitudes_.end());
  return state;
}

void WaveSpectrum::restore(std::span<double const> state) {
  constexpr std::size_t head = 11;
  auto const whole = [&](std::size_t k) {
    return state[k] >= 0 && state[k] < 9e15 ? static_cast<std::size_t>(state[k]) : 0;
  };
  if (state.size() < head || state.size() - head != (whole(1) == 0 ? 0 : whole(1) * 2 * (whole(0) + 1)))
    throw Error("the checkpoint does not fit this diagnosis: its wave spectrum has another length");
  modes_ = whole(0);
  looks_ = whole(1);
  length_ = state[2], first_ = state[3], last_ = state[4], interval_ = state[5];
  auto const exponent = [&](std::size_t k) { return static_cast<signed char>(state[k]); };
  dimension_ = {exponent(6), exponent(7), exponent(8), exponent(9), exponent(10)};
  amplitudes_.assign(state.begin() + head, state.end());
}

bool WaveSpectrum::enough() const { return looks_ >= min_looks && std::abs(interval_) > 0; }

WavePower WaveSpectrum::power() const {
  if (!enough())
    throw Error(fmt::format("a wave spectrum needs {} or more samples at different times, not {}", min_looks, looks_));
  std::size_t const looks = looks_, columns = 2 * modes_ + 1, rows = looks / 2 + 1;
  WavePower result;
  result.dimension = dimension_;
  for (std::size_t c = 0; c < columns; ++c)
    result.wave_number.push_back(2 * std::numbers::pi * (static_cast<double>(c) - static_cast<double>(modes_)) /
                                 length_);
  for (std::size_t r = 0; r < rows; ++r)
    result.frequency.push_back(2 * std::numbers::pi * static_cast<double>(r) /
                               (static_cast<double>(looks) * std::abs(interval_)));
  std::vector<double> window(looks);
  double window_power = 0;
  for (std::size_t t = 0; t < looks; ++t) {
    double const sine = std::sin(std::numbers::pi * (static_cast<double>(t) + 0.5) / static_cast<double>(looks));
    window[t] = sine * sine;
    window_power += window[t] * window[t];
  }
  result.power.assign(rows * columns, 0.0);
  // exp(-i omega t) and exp(i k x): the transform in time is backward.
  LineTransform const transform(FourierKind::complex_backward, looks);
  FourierArray input(2 * looks), output(2 * looks);
  for (std::size_t c = 0; c < columns; ++c) {
    std::size_t const mode = c < modes_ ? modes_ - c : c - modes_;
    double const sign = c < modes_ ? -1 : 1;  // the amplitude of -k is the conjugate of that of k
    for (std::size_t t = 0; t < looks; ++t) {
      double const* amplitude = amplitudes_.data() + 2 * (t * (modes_ + 1) + mode);
      input[2 * t] = window[t] * amplitude[0];
      input[2 * t + 1] = window[t] * sign * amplitude[1];
    }
    transform.execute(input.data(), output.data());
    for (std::size_t r = 0; r < rows; ++r) {
      // (k, omega) and (-k, -omega) are one wave.
      double const partners = r == 0 || 2 * r == looks ? 1 : 2;
      result.power[r * columns + c] = partners *
                                      (output[2 * r] * output[2 * r] + output[2 * r + 1] * output[2 * r + 1]) /
                                      (static_cast<double>(looks) * window_power);
    }
  }
  return result;
}

}  // namespace boltzmann
