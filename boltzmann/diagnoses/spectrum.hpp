// Power spectra of uniformly sampled series: the waves of the particles (section 5.2.3.5 of the 1990 thesis).
#pragma once

#include <cstddef>
#include <span>
#include <vector>

namespace boltzmann {

enum class SpectrumMethod {
  /// The estimator of 1990: two segments, the triangular data window (called Parzen's there), the two periodograms
  /// averaged.
  parzen_two_segments,
  /// Welch (1967): eight segments that overlap by about half, a sin^2 data window, the periodograms averaged. Less
  /// noise, and a
  /// resolution of N / 4.5 samples instead of N / 2. Series of fewer than 16 samples are one segment.
  welch,
};

/// A one-sided power spectral density: the power at f and -f together, at frequency[k] = k df >= 0 up to Nyquist's 1 /
/// (2 spacing). Unit of frequency: cycles per unit of the spacing (time: frequency; length: wave number / 2 pi); unit
/// of density: value^2 / frequency. Normalised so that Sum density df is the mean square of the samples, weighted with
/// the square of the data window and exact as such.
struct Spectrum {
  std::vector<double> frequency;
  std::vector<double> density;

  /// df, the spacing of the frequencies.
  double resolution = 0.0;
};

/// The power spectrum of one series, by segments of any length (not only powers of two); every sample is used. The mean
/// is part of the signal and appears at frequency 0 and, through the window, beside it; with subtract_mean it is
/// subtracted from the whole series first. Throws Error for fewer than 2 samples, a sample that is not finite, or a
/// spacing that is not positive.
Spectrum power_spectrum(std::span<double const> samples, double spacing,
                        SpectrumMethod method = SpectrumMethod::parzen_two_segments, bool subtract_mean = false);

/// The estimator of the thesis: `first` and `second` are the two segments, of the same length N (the velocities across
/// space at two consecutive steps). Each is multiplied by the window 1 - |(j - (N-1)/2) / ((N+1)/2)|, j = 0..N-1, and
/// the two periodograms are averaged; with subtract_mean, the mean of each segment is subtracted first. Throws Error as
/// above, and for segments of different lengths.
Spectrum power_spectrum(std::span<double const> first, std::span<double const> second, double spacing,
                        bool subtract_mean = false);

/// Values on a uniform grid: value[j] belongs to the position first + j spacing.
struct UniformSamples {
  std::vector<double> value;
  double first = 0.0;
  double spacing = 0.0;
  /// The widest gap between neighbouring particles. If it is far above `spacing`, the values inside the gap are only
  /// interpolated.
  double largest_gap = 0.0;
};

/// Interpolates the values of particles on a line, in any order, to n uniformly spaced points from the smallest to the
/// greatest position. It sorts by position, then interpolates linearly between the two neighbours of each point.
/// Particles at the same position count as one with their mean value. For n uniformly spaced particles it returns their
/// own values. Interpolation between randomly placed particles lowers the spectrum at wave lengths near and below their
/// distance: check `largest_gap`. Throws Error if the lengths differ, a number is not finite, n < 2, or fewer than two
/// positions differ.
UniformSamples sample_uniformly(std::span<double const> positions, std::span<double const> values, std::size_t n);

}  // namespace boltzmann
