// Trajectory views: a small file beside trajectory.h5 that shows all its ensembles as one, in a form that MDAnalysis
// opens.
#pragma once

#include <boltzmann/files/trajectory.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// True if MDAnalysis (2.4 to 2.8) reads this unit, in H5MD's notation, for the elements "time", "position", "edges"
/// and "velocity". It accepts any unit for other elements.
bool mdanalysis_reads(std::string_view element, std::string_view unit);

/// Writes `path`, a file of HDF5 views into `trajectory`. That file is in the same folder, written frame by frame by a
/// Trajectory with these options and ensembles. The view remains valid when frames are added. The particles of all
/// ensembles are concatenated in the group that MDAnalysis opens by default (`particles/trajectory`), with positions,
/// velocities if all have them, box, species, masses and charges.
/// `times` are the times of the frames so far, as in the file; they give the intervals. Unless the view is finished, up
/// to twice as many frames are expected, with the last interval. Units are those of the trajectory if MDAnalysis reads
/// them. If it doesn't read one of them, all numbers are unchanged and labelled angstrom, ps and angstrom/ps, and
/// `boltzmann_unit` has the true units. Throws Error if the view can't be written; then no file is left.
void write_trajectory_view(std::string const& path, std::string const& trajectory, TrajectoryOptions const& options,
                           std::span<AnyEnsemble const* const> ensembles, BoxEdges const& box,
                           std::span<double const> times, bool finished = false);

}  // namespace boltzmann
