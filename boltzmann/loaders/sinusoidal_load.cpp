// Waves in density and velocity.
#include <boltzmann/core/random.hpp>
#include <boltzmann/loaders/ensemble_seed.hpp>
#include <boltzmann/loaders/placing.hpp>
#include <boltzmann/loaders/quiet_start.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace boltzmann {
namespace {

void check_wave(Box const& box, Wave const& wave, double amplitude, char const* loader) {
  if (wave.axis < 0 || wave.axis >= box.dimension())
    throw Error(
        fmt::format("{}: the box has no axis {}, it has {} of them, from 0 on", loader, wave.axis, box.dimension()));
  if (!std::isfinite(wave.wave_number) || !std::isfinite(wave.phase) || !std::isfinite(amplitude))
    throw Error(fmt::format("{}: wave number {}, phase {} and amplitude {} must be finite", loader, wave.wave_number,
                            wave.phase, amplitude));
}

Ripple density_of(Box const& box, auto const& options, char const* loader) {
  auto const& [axis, wave_number, phase] = options.wave;
  double const amplitude = options.amplitude;
  check_wave(box, options.wave, amplitude, loader);
  if (std::abs(amplitude) > 1)
    throw Error(
        fmt::format("{}: the amplitude {} would make the density negative; it is between -1 and 1", loader, amplitude));
  // Relative to 0, so that positions far from 0 keep their accuracy.
  return {0, box.length(axis), wave_number, phase, amplitude, 1};
}

}  // namespace

Wave wave_of_mode(Box const& box, int axis, double mode, double phase) {
  check_wave(box, {axis, mode, phase}, 0, "wave");
  return {axis, 2 * std::numbers::pi * mode / box.length(axis), phase};
}

void sinusoidal_load(AnyEnsemble& ensemble, Box const& box, SinusoidalOptions const& options) {
  check_dimension(ensemble, box, "sinusoidal load");
  Ripple const variable = density_of(box, options, "sinusoidal load");
  std::uint64_t const key = ensemble_seed(options.seed, ensemble.name(), "ripple");
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    Stream stream(key, 0, i, Purpose::position);
    std::array<double, 3> x{};
    int draws = 0;
    do {
      if (++draws > longest_search)
        throw Error(
            fmt::format("sinusoidal load: the regions leave no place for particle {} of '{}'", i, ensemble.name()));
      for (int a = 0; a < box.dimension(); ++a)
        x[a] = a == options.wave.axis ? below_edge(box, a, box.low(a) + variable(stream))
                                      : on_axis(box, a, stream.uniform());
    } while (!allowed(box, x.data()));
    std::copy_n(x.data(), box.dimension(), ensemble.row(i));
  }
}

void quiet_load(AnyEnsemble& ensemble, Box const& box, QuietOptions const& options) {
  check_dimension(ensemble, box, "quiet load");
  Ripple const variable = density_of(box, options, "quiet load");
  if (!box.regions().empty())
    throw Error("quiet load: the box has regions, which would leave gaps in the order; load at random");
  std::size_t const size = ensemble.size();
  for (std::size_t i = 0; i < size; ++i) {
    int direction = 0;
    for (int a = 0; a < box.dimension(); ++a) {
      if (a != options.wave.axis) {
        ensemble.row(i)[a] = on_axis(box, a, quiet_fraction(i, size, direction++));
        continue;
      }
      double const fraction = (static_cast<double>(i) + 0.5) / static_cast<double>(size);
      ensemble.row(i)[a] = options.amplitude == 0 ? on_axis(box, a, fraction)
                                                  : below_edge(box, a, box.low(a) + variable.quantile(fraction));
    }
  }
}

void velocity_ripple(AnyEnsemble& ensemble, Box const& box, VelocityRipple const& ripple) {
  auto const& [wave, amplitude, component] = ripple;
  check_dimension(ensemble, box, "velocity ripple");
  check_wave(box, wave, amplitude, "velocity ripple");
  Field const& velocity = ensemble.field("velocity");
  if (component < 0 || component >= velocity.components)
    throw Error(fmt::format("velocity ripple: the velocity of '{}' has {} component{}, there is no component {}",
                            ensemble.name(), velocity.components, velocity.components == 1 ? "" : "s", component));
  for (std::size_t i = 0; i < ensemble.size(); ++i) {
    double* row = ensemble.row(i);
    row[velocity.offset + component] +=
        amplitude * std::sin(wave.wave_number * (row[wave.axis] - box.low(wave.axis)) + wave.phase);
  }
}

}  // namespace boltzmann
