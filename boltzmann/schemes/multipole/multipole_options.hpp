// Multipole options: what scenarios say of multipoles, with their keys.
#pragma once

#include <boltzmann/core/options.hpp>

#include <cstdint>

namespace boltzmann {

/// The law and whom it acts on are read by the reader of the scenario.
struct MultipoleOptions {
  double tolerance = 1e-4;
  bool background = false;
  std::int64_t every = 1;  ///< steps between two calculations (Simulation::every)
};
OptionTable const& multipole_options();

}  // namespace boltzmann
