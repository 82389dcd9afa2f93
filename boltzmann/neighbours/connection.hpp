// Connections: influences between fixed pairs of particles (section 4.3).
#pragma once

#include <boltzmann/neighbours/neighbour_list.hpp>

#include <cstddef>
#include <span>

namespace boltzmann {

/// (first : last : interval): the pairs (first, first + interval), (first + interval, first + 2 interval), ... up to
/// last.
struct Connection {
  std::size_t first, last, interval = 1;
};

/// The union of connections among `size` particles as a full list in the order of partners' numbers, padded with each
/// particle's own number. Error if a connection names a particle that does not exist, runs backwards, or has interval
/// 0.
NeighbourList connected_pairs(std::span<Connection const> connections, std::size_t size);

}  // namespace boltzmann
