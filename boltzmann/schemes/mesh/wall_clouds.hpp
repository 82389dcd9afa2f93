// The effect of a wall on the density of nearby clouds on nodes.
#pragma once

#include <cstddef>
#include <vector>

namespace boltzmann {

/// Coefficients of an order of assignment, for the nodes from a wall inward within the range of clouds beyond the wall:
/// nodes_before(order) + 1 of them.
struct WallClouds {
  /// Beside a grounded wall, where ghosts are extrapolated (Ghosts), a uniform density of 1 is measured as 1 +
  /// smear[j].
  std::vector<double> smear;
  /// Beside a mirror, the density x/h, with x the distance from the wall, is measured as slope[j].
  std::vector<double> slope;
};
WallClouds wall_clouds(int order);

/// Extrapolates densities on the `count` nodes of a line, `stride` apart, to its low (high) end, which is a mirror.
/// Nodes beside it hold the mean over clouds and their images, which is only of first order if the density has a slope.
/// Uniform densities keep their bits.
void extrapolate_to_wall(WallClouds const& clouds, double* line, std::size_t count, std::size_t stride, bool high);

}  // namespace boltzmann
