// What the clouds of particles beside a wall make of a density on the nodes there.
#pragma once

#include <cstddef>
#include <vector>

namespace boltzmann {

/// Numbers of an order of assignment, for the nodes from a wall inward that clouds beyond the wall reach:
/// nodes_before(order) + 1 of them.
struct WallClouds {
  /// A uniform density of 1 comes out as 1 + smear[j] beside a grounded wall, where ghosts are extrapolated (Ghosts).
  std::vector<double> smear;
  /// The density x/h, with x the distance from the wall, comes out as slope[j] beside a mirror.
  std::vector<double> slope;
};
WallClouds wall_clouds(int order);

/// Extrapolates densities on the `count` nodes of a line, `stride` apart, to its low (high) end, which is a mirror: nodes
/// beside it hold the mean over clouds and their images, which is of first order where the density has a slope.
/// Uniform densities keep their bits.
void extrapolate_to_wall(WallClouds const& clouds, double* line, std::size_t count, std::size_t stride, bool high);

}  // namespace boltzmann
