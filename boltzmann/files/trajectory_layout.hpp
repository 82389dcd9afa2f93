// The file layout shared by the writer and the reader of trajectories. Private to this module.
#pragma once

#include <boltzmann/files/hdf5_file.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace boltzmann::layout {

/// The names of the ensembles in the order of writing. Throws Error if the file is not a trajectory of Boltzmann.
std::vector<std::string> ensembles(hdf5::File const& file);

struct Frames {
  std::vector<std::int64_t> steps;
  std::vector<double> times;
};

/// The complete frames: those that every dataset has.
Frames frames(hdf5::File const& file);

// Checksums. Each field has a checksum per frame beside its values. Beside the counts, there is one of all other data
// of a frame. A constant field has the attribute boltzmann_checksum. Files of version 0.1 have none.

/// The checksum of the values of a field in the file, without the padding columns of vectors.
std::uint64_t checksum(std::vector<double> const& values);
/// The checksum of a frame's data of an ensemble: step, time, number of particles, bounds of the box (low, then high).
std::uint64_t checksum(std::int64_t step, double time, std::int64_t count, std::span<double const> bounds);
/// Adds the checksum of a frame to the total. The order does not matter.
void add_checksum(std::uint64_t& all, std::uint64_t frame, std::uint64_t sum);
/// The total of the first frames. Throws Error if there are fewer.
std::uint64_t checksum_of_frames(hdf5::File const& file, std::uint64_t frames);

/// The number of leading frames with steps up to this one. Steps must ascend, because a frame damaged by a failing disk
/// may contain any step.
std::size_t frames_until(std::vector<std::int64_t> const& steps, std::int64_t last_step);

/// The periodic axes in the group of the box. Throws Error if they are missing.
std::array<bool, 3> periodic_axes(hdf5::File const& file, std::string const& box);

}  // namespace boltzmann::layout
