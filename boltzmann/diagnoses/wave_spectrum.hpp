// Wave spectrum: the waves along an axis of a mesh, by wave number and frequency.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace boltzmann {

/// Power over wave number and angular frequency. A wave A cos(k x - omega t), which moves towards positive x for k > 0,
/// has the power A^2/2, spread by the data window over the neighbouring frequencies; the sum over all is the mean
/// square of the quantity, weighted with the square of the window.
struct WavePower {
  std::vector<double> wave_number;  ///< from -k to k
  std::vector<double> frequency;    ///< angular, from 0 to Nyquist's pi / (sampling interval)
  std::vector<double> power;        ///< a row of wave numbers for each frequency
  Dimension dimension;              ///< of the quantity; the power has its square
};

/// Records a quantity of the mesh at every sample, averaged over all axes but one; it adds no columns to a table.
/// Sampling intervals must be equal.
class WaveSpectrum final : public Diagnosis {
 public:
  /// `quantity`: a name for mesh_quantity(). `modes`: waves with up to this number of periods in the box are recorded;
  /// 0: all that the mesh resolves, but at most 256.
  explicit WaveSpectrum(std::string quantity = "field.x", int axis = 0, std::size_t modes = 0);

  std::vector<Column> columns() const override { return {}; }
  bool needs_mesh() const override { return true; }
  /// Error if there is no mesh, no such quantity, the axis is not periodic, or the sampling intervals differ.
  void measure(Sample const& sample, std::vector<double>& values) override;
  /// All samples so far.
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;

  std::string const& quantity() const { return quantity_; }
  int axis() const { return axis_; }
  std::size_t looks() const { return looks_; }
  /// True if there are enough samples for power().
  bool enough() const;
  /// The spectrum of all samples so far, through Hann's window. Error for fewer than 4 samples.
  WavePower power() const;

 private:
  std::string quantity_;
  int axis_;
  std::size_t modes_wanted_;
  std::size_t modes_ = 0, looks_ = 0;
  double length_ = 0, first_ = 0, last_ = 0, interval_ = 0;
  Dimension dimension_{};
  std::vector<double> amplitudes_;  // of each sample: real and imaginary parts of modes 0, 1, ..., modes_
};

}  // namespace boltzmann
