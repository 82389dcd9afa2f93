// Profiles along an axis, and their spectra.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/spectrum_of.hpp>

#include <fmt/format.h>

#include <utility>

namespace boltzmann {

UniformSamples profile_of(AnyEnsemble const& ensemble, std::string_view name, int axis, std::size_t n) {
  if (axis < 0 || axis >= ensemble.dimension())
    throw Error(fmt::format("ensemble '{}' has {} axes, numbered from 0; there is no axis {}", ensemble.name(),
                            ensemble.dimension(), axis));
  auto const values = quantity(ensemble, name);
  auto const positions = ensemble.column(ensemble.field("position"), axis);
  if (positions.size() < 2)
    throw Error(fmt::format("a spectrum needs at least two particles, ensemble '{}' has {}", ensemble.name(),
                            positions.size()));
  return sample_uniformly(positions, values, n == 0 ? positions.size() : n);
}

Spectrum spectrum_of(AnyEnsemble const& ensemble, std::string_view name, int axis, std::size_t n, SpectrumMethod method,
                     bool subtract_mean) {
  UniformSamples const profile = profile_of(ensemble, name, axis, n);
  return power_spectrum(profile.value, profile.spacing, method, subtract_mean);
}

Spectrum SpectrumOverSteps::look(AnyEnsemble const& ensemble) {
  UniformSamples profile = profile_of(ensemble, quantity_, axis_, n_);
  Spectrum spectrum =
      last_ && last_->value.size() == profile.value.size()
          ? power_spectrum(last_->value, profile.value, 0.5 * (last_->spacing + profile.spacing), subtract_mean_)
          : power_spectrum(profile.value, profile.spacing, SpectrumMethod::parzen_two_segments, subtract_mean_);
  last_ = std::move(profile);
  return spectrum;
}

}  // namespace boltzmann
