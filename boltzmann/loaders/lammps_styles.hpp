// The supported atom styles of LAMMPS, and code that its two formats share. Private to this module.
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
  bool spins = false;  ///< lines of Velocities have angular velocities, too
};
/// Null if it is not supported.
AtomStyle const* find_atom_style(std::string_view name);
std::vector<std::string> atom_style_names();
/// The styles whose atoms have this number of words, with or without image flags.
std::vector<std::string> atom_styles_of(std::size_t words);
/// "'hybrid' can't be read; those that can are ..."
std::string unknown_style(std::string_view name);

/// Sorts the particles by their identifiers; `order` has the identifiers with the rows.
void sort_by_identifier(ParticleFrame& frame, std::vector<std::pair<std::int64_t, std::size_t>> order);

}  // namespace boltzmann
