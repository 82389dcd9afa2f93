// Heat through a layer between two walls of prescribed temperature: conduction, convection, and Nusselt's number.
#pragma once

#include <boltzmann/diagnoses/diagnosis.hpp>

#include <cstddef>

namespace boltzmann {

struct HeatFluxOptions {
  int axis = 1;             ///< across the layer
  double conductivity = 0;  ///< of the matter between the walls
  double since = 0;         ///< start of means and standard deviations
};

/// Temperature of the wall at the low end of an axis minus that at its high end. Error if these are missing or equal.
double temperature_difference(Box const& box, int axis);

/// Means over the whole layer of length L between walls at temperatures T0 (low end) and T1 (high end):
///   conductive  conductivity (T0 - T1) / L: the volume average of -conductivity dT/dx, by Gauss' theorem
///   convective  (1 / V) Sum m v (h - <h>), v the velocity along the axis, h = e + P / rho the enthalpy per mass and
///   <h>
///               its mean over the mass (this excludes transport by the sloshing of the whole layer, which averages
///               out)
///   Nusselt     (conductive + convective) / conductive
/// of all ensembles of smooth particles, and the mean and the standard deviation of Nusselt's number over the samples
/// since a time (NaN before).
class HeatFlux final : public Diagnosis {
 public:
  using Options = HeatFluxOptions;
  /// Error if the conductivity is not above 0, or an ensemble does not consist of smooth particles in a space with that
  /// axis.
  HeatFlux(std::vector<AnyEnsemble const*> const& ensembles, HeatFluxOptions const& options);

  std::vector<Column> columns() const override;
  double since() const { return options_.since; }
  /// Error if the axis has no walls with different temperatures.
  void measure(Sample const& sample, std::vector<double>& values) override;
  std::vector<double> state() const override { return {count_, mean_, squares_}; }
  void restore(std::span<double const> state) override;

  double mean() const;    ///< of Nusselt's number
  double spread() const;  ///< its standard deviation

 private:
  HeatFluxOptions options_;
  int dimension_;
  double count_ = 0, mean_ = 0, squares_ = 0;
};

}  // namespace boltzmann
