// Streamlines: lines along a flow on a plane grid, evenly spaced.
#pragma once

#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <span>
#include <vector>

namespace boltzmann {

struct Streamline {
  bool closed;  ///< it comes back to where it began, which is its last point once more
  std::vector<double> x, y;
};

/// Lines that follow the flow with these components on the nodes, linear between them, a distance of `separation` from
/// each other where they begin and half of it at least where they end (B. Jobard and W. Lefer 1997). They end at the
/// ends of the grid, at periodic ones too, and where the flow stands still. Error if the grid is not of two dimensions,
/// has not one value of each for each node, or if the separation is not above a thousandth of its length.
std::vector<Streamline> streamlines(MeshGrid const& grid, std::span<double const> along_x,
                                    std::span<double const> along_y, double separation);

}  // namespace boltzmann
