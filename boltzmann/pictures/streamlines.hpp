// Streamlines: lines along a flow on a plane grid, evenly spaced.
#pragma once

#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <span>
#include <vector>

namespace boltzmann {

struct Streamline {
  bool closed;  ///< it returns to its start, and its last point repeats the first
  std::vector<double> x, y;
};

/// Lines along the flow with these components on the nodes, interpolated linearly. Their distance is `separation` at
/// their seeds, and at least half of it at their ends (B. Jobard and W. Lefer 1997). They end at the ends of the grid,
/// even periodic ones, and where the flow is zero. Throws Error if the grid is not two-dimensional, has not one value
/// of each component per node, or if the separation is not above a thousandth of its length.
std::vector<Streamline> streamlines(MeshGrid const& grid, std::span<double const> along_x,
                                    std::span<double const> along_y, double separation);

}  // namespace boltzmann
