// Particles along a random path: the initial state of a melt of chains, without overlaps.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <cstdint>

namespace boltzmann {

struct PathOptions {
  std::array<std::size_t, 3> counts{1, 1, 1};  ///< sites along each axis; the number of particles equals that of sites
  std::uint64_t seed = 1;
};

/// A simple lattice that fills the box. Successive particles are on successive sites of a random path that visits all
/// sites once, from neighbour to neighbour, never across the box's ends. So every part of the path is a chain with
/// bonds of one spacing, folded like chains of a dense melt. The path is made by backbite moves of its ends (M. L.
/// Mansfield, J. Chem. Phys. 77, 1554 (1982)), 20 for each site, each of which reverses half of the path: 10,000
/// particles take a second, 100,000 two minutes. Error if the numbers don't fit.
void path_load(AnyEnsemble& ensemble, Box const& box, PathOptions const& options);

}  // namespace boltzmann
