// Trajectory views: beside trajectory.h5 a small file that shows all its ensembles as one, as MDAnalysis opens it.
#pragma once

#include <boltzmann/files/trajectory.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// Whether MDAnalysis (2.4 to 2.8) takes this unit, in H5MD's notation, of the elements "time", "position", "edges" and
/// "velocity"; of others it takes any.
bool mdanalysis_reads(std::string_view element, std::string_view unit);

/// Writes `path`, a file of HDF5's views into `trajectory`, a file in the same folder that a Trajectory with these options
/// writes of these ensembles, frame by frame: it need not be written again when there are more. The particles of all
/// ensembles stand one behind the other in the group that MDAnalysis looks for when it is given nothing else
/// (`particles/trajectory`), with positions, velocities where all have them, box, species, masses and charges; `times` of
/// the frames so far, as they are in the file, give the steps in time between them; unless it is finished more are expected,
/// up to twice as many, that follow like the last ones. Units are those of the trajectory where
/// MDAnalysis reads them; where it doesn't read one of them, all numbers stand as they are and are called angstrom, ps and
/// angstrom/ps, and `boltzmann_unit` says what they are. Error if it can't be written; then there is none.
void write_trajectory_view(std::string const& path, std::string const& trajectory, TrajectoryOptions const& options,
                           std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box,
                           std::span<double const> times, bool finished = false);

}  // namespace boltzmann
