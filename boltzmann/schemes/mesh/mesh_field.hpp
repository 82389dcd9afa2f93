// Mesh fields: numbers on the nodes of a regular mesh, for reading, drawing and writing.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/dimension.hpp>

#include <array>
#include <cstddef>
#include <string>
#include <vector>

namespace boltzmann {

/// The nodes of a mesh over a box. A periodic axis has as many nodes as cells, node j at low + j spacing. Any other
/// axis has one more, so that the last node is on the high edge. The axis x varies fastest in memory. Axes beyond the
/// dimension have one node.
struct MeshGrid {
  int dimension = 1;
  std::array<std::size_t, 3> nodes{1, 1, 1};
  std::array<double, 3> low{0, 0, 0}, spacing{1, 1, 1};
  std::array<bool, 3> periodic{false, false, false};

  std::size_t size() const { return nodes[0] * nodes[1] * nodes[2]; }
  std::size_t index(std::size_t i, std::size_t j = 0, std::size_t k = 0) const {
    return (k * nodes[1] + j) * nodes[0] + i;
  }
  double position(int axis, std::size_t node) const { return low[axis] + static_cast<double>(node) * spacing[axis]; }
  std::size_t cells(int axis) const { return periodic[axis] ? nodes[axis] : nodes[axis] - 1; }
  /// Length, area or volume of a cell.
  double cell_volume() const {
    double product = 1;
    for (int a = 0; a < dimension; ++a) product *= spacing[a];
    return product;
  }
};

/// A grid with these cells along each axis of the box. Throws Error if an axis has none, or `cells` has another number
/// of axes than the box.
MeshGrid make_grid(Box const& box, std::vector<std::size_t> const& cells);

/// A quantity on the nodes: one number (density, potential) or a vector (the field) for each.
struct MeshField {
  std::string name;     ///< "density", "potential", "field"
  Dimension dimension;  ///< physical dimension of its unit
  MeshGrid grid;
  std::vector<std::vector<double>> components;  ///< one array of grid.size() numbers per component

  double& at(std::size_t i, std::size_t j = 0, std::size_t k = 0) { return components[0][grid.index(i, j, k)]; }
  double at(std::size_t i, std::size_t j = 0, std::size_t k = 0) const { return components[0][grid.index(i, j, k)]; }
};

}  // namespace boltzmann
