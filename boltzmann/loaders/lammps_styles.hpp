// LAMMPS' atom styles that can be read, and what its two formats share. Private to this room.
#pragma once

#include <boltzmann/loaders/particle_frame.hpp>

#include <cstdint>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

struct AtomStyle {
  std::string_view name, columns;
  bool spins = false;  ///< lines of Velocities hold angular velocities, too
};
/// Null if it can't be read.
AtomStyle const* find_atom_style(std::string_view name);
std::vector<std::string> atom_style_names();
/// The styles whose atoms have so many words, with image flags or without.
std::vector<std::string> atom_styles_of(std::size_t words);
/// "'hybrid' can't be read; those that can are ..."
std::string unknown_style(std::string_view name);

/// Puts the particles into the order of their identifiers; `order` has these with the rows.
void sort_by_identifier(ParticleFrame& frame, std::vector<std::pair<std::int64_t, std::size_t>> order);

}  // namespace boltzmann
