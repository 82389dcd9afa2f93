// Smooth options: the keys in scenarios for a continuum.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/schemes/smooth/rezone.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>

#include <array>
#include <cstdint>
#include <optional>

namespace boltzmann {

struct SmoothOptions {
  WeightShape weight = WeightShape::lucy;
  DensityFrom density = DensityFrom::summation;
  MeanDensity mean_density = MeanDensity::arithmetic;
  Heating heating = Heating::shared;
  std::optional<ArtificialViscosity> artificial_viscosity;
  std::optional<VariableRange> variable_range;
  std::optional<double> skin;
};
OptionTable const& smooth_options();

/// A rezoning, and its interval. The reader of the scenario finds the ensemble.
struct RezoneOptions {
  std::int64_t every = 1;
  Rezoning policy;
  std::optional<std::array<double, 3>> low, high;  ///< corners of its block
};
OptionTable const& rezone_options();

}  // namespace boltzmann
