// Connections: influences between fixed pairs of particles (section 4.3).
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>
#include <vector>

namespace boltzmann {

/// (first : last : interval): the pairs (first, first + interval), (first + interval, first + 2 interval), ... up to
/// last.
struct Connection {
  std::size_t first, last, interval = 1;
};

/// Particle i's partners are index[start[i]] ... index[start[i + 1] - 1]; each row is padded to a multiple of `padding`
/// with i itself.
struct PartnerList {
  static constexpr std::size_t padding = 8;
  std::vector<std::size_t> start;
  std::vector<std::uint32_t> index;
};

/// The union of connections among `size` particles as a full list in the order of partners' numbers, padded with each
/// particle's own number. Error if a connection names a particle that does not exist, runs backwards, or has interval
/// 0, or if a pair is in two of them.
PartnerList connected_pairs(std::span<Connection const> connections, std::size_t size);

}  // namespace boltzmann
