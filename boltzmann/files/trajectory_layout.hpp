// What the writer and the reader of trajectories both know of the file. Private to this room.
#pragma once

#include <boltzmann/files/hdf5_file.hpp>

#include <array>
#include <cstdint>
#include <span>
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

// Beside each field's values stands a checksum of each frame, beside the counts one of all else that a frame says, with
// a constant field the attribute boltzmann_checksum. Files of version 0.1 have none.

/// Of the values of a field as they stand in the file, without the columns that pad vectors.
std::uint64_t checksum(std::vector<double> const& values);
/// Of what a frame says of an ensemble: step, time, number of particles, bounds of the box (low, then high).
std::uint64_t checksum(std::int64_t step, double time, std::int64_t count, std::span<double const> bounds);
/// Adds one of a frame to those of all, in any order.
void add_checksum(std::uint64_t& all, std::uint64_t frame, std::uint64_t sum);
/// All of the first frames together. Error if there are not so many.
std::uint64_t checksum_of_frames(hdf5::File const& file, std::uint64_t frames);

/// How many of the first frames are of steps up to this one. A frame that a failing disk has left half written may say
/// any step: frames ascend.
std::size_t frames_until(std::vector<std::int64_t> const& steps, std::int64_t last_step);

/// Which axes the box's group says are periodic. Error if it doesn't.
std::array<bool, 3> periodic_axes(hdf5::File const& file, std::string const& box);

}  // namespace boltzmann::layout
