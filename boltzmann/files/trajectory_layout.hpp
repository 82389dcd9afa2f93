// What the writer and the reader of trajectories both know of the file. Private to this room.
#pragma once

#include <boltzmann/files/hdf5_file.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace boltzmann::layout {

/// The names of the ensembles in the order in which they were written. Error if the file is no trajectory of ours.
std::vector<std::string> ensembles(hdf5::File const& file);

struct Frames {
  std::vector<std::int64_t> steps;
  std::vector<double> times;
};

/// The frames that are complete: those that every dataset has.
Frames frames(hdf5::File const& file);

}  // namespace boltzmann::layout
