// Multipole options: the keys in scenarios for multipoles.
#pragma once

#include <boltzmann/core/options.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// The reader of the scenario processes the law and the ensembles on which it acts.
struct MultipoleOptions {
  double tolerance = 1e-4;
  bool background = false;
  std::int64_t every = 1;  ///< steps between two calculations (Simulation::every)
  std::vector<std::size_t> grid = {};
};
OptionTable const& multipole_options();

}  // namespace boltzmann
