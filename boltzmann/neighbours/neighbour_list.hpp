// Neighbour lists: for each particle, all that are near, in a fixed order.
#pragma once

#include <boltzmann/neighbours/mirror.hpp>

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// Row i's neighbours are index[start[i]] ... index[start[i + 1] - 1]; each row is padded to a multiple of `padding`
/// with an index that its user masks.
struct NeighbourList {
  static constexpr std::size_t padding = 8;
  std::vector<std::size_t> start;
  std::vector<std::uint32_t> index;
};

/// The full list: for every owned row of `target` the rows of `source`, owned and ghosts, within `reach` at the last
/// build; not itself. Padded with the source's sentinel.
NeighbourList near_pairs(Mirror const& target, Mirror const& source, double reach, int threads);

}  // namespace boltzmann
