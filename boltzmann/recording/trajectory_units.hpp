// Trajectory units: the units of trajectory.h5. Private to this module.
#pragma once

#include <boltzmann/core/unit_system.hpp>

namespace boltzmann {

/// The units of results. For runs of atoms, lengths, times and velocities are in units that MDAnalysis supports: it
/// misreads angstrom/fs and has no bohr.
UnitSystem::Display trajectory_unit(UnitSystem const& units, Dimension dimension);

}  // namespace boltzmann
