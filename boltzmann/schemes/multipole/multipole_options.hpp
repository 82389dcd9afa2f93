// Multipole options: what scenarios say of multipoles, with their keys.
#pragma once

#include <boltzmann/core/options.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// The law and whom it acts on are read by the reader of the scenario.
struct MultipoleOptions {
  double tolerance = 1e-4;
  bool background = false;
  std::int64_t every = 1;  ///< steps between two calculations (Simulation::every)
  std::vector<std::size_t> grid = {};
};
OptionTable const& multipole_options();

}  // namespace boltzmann
