// Power spectra of quantities of particles, along an axis of space (section 5.2.3.5): from an ensemble to a Spectrum.
#pragma once

#include <boltzmann/diagnoses/spectrum.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace boltzmann {

/// A quantity (any name for quantity()) over the positions along an axis (0, 1, 2), on n uniformly spaced points; n = 0
/// uses as many points as there are particles. Error for an unknown quantity or axis, n = 1, or fewer than two
/// positions.
UniformSamples profile_of(AnyEnsemble const& ensemble, std::string_view quantity, int axis = 0, std::size_t n = 0);

/// The power spectrum of such a profile; frequencies are in cycles per length (wave number / 2 pi).
Spectrum spectrum_of(AnyEnsemble const& ensemble, std::string_view quantity, int axis = 0, std::size_t n = 0,
                     SpectrumMethod method = SpectrumMethod::parzen_two_segments, bool subtract_mean = false);

/// The estimator of 1990, over two consecutive steps: each sample uses the profiles of this and the last step as the
/// two segments. The first sample, and one after the number of particles has changed, give the spectrum of the single
/// profile.
class SpectrumOverSteps {
 public:
  explicit SpectrumOverSteps(std::string quantity, int axis = 0, std::size_t n = 0, bool subtract_mean = false)
      : quantity_(std::move(quantity)), axis_(axis), n_(n), subtract_mean_(subtract_mean) {}

  Spectrum look(AnyEnsemble const& ensemble);

 private:
  std::string quantity_;
  int axis_;
  std::size_t n_;
  bool subtract_mean_;
  std::optional<UniformSamples> last_;
};

}  // namespace boltzmann
