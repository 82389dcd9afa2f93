// The state of a gas in exact solutions.
#pragma once

namespace boltzmann::exact {

/// Density, velocity (along x, or outwards) and pressure, in any consistent units.
struct GasState {
  double density, velocity, pressure;
};

}  // namespace boltzmann::exact
