// Trajectory units: in which units trajectory.h5 is. Private to this room.
#pragma once

#include <boltzmann/core/unit_system.hpp>

namespace boltzmann {

/// Those of results; of runs of atoms lengths, times and velocities in such that MDAnalysis knows (it takes angstrom/fs for
/// something else, and knows no bohr).
UnitSystem::Display trajectory_unit(UnitSystem const& units, Dimension dimension);

}  // namespace boltzmann
