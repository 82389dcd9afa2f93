// Contours: lines along which a quantity on a plane grid has a given value.
#pragma once

#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace boltzmann {

/// One line. Larger values are on its left, so that it goes anticlockwise round a hill.
struct ContourLine {
  double level;
  /// Whether it comes back to where it began; its last point is the first once more then, or one of its images if it
  /// goes round a periodic axis. Through a periodic wall a line goes on outside the box, without a jump.
  bool closed;
  std::vector<double> x, y;
};

/// The lines of each level, one level after the other, by marching squares: values go linearly between neighbouring
/// nodes, and in a cell with a saddle the mean of its corners says which of them are connected. Along periodic axes the
/// last node is the neighbour of the first. Lines end at other walls and where a node has no value (NaN). A node whose
/// value is the level counts as above it.
///
/// Error if the grid is not of two dimensions, or has not one value for each node.
std::vector<ContourLine> contour_lines(MeshGrid const& grid, std::span<double const> values,
                                       std::span<double const> levels);

/// `count` levels between the smallest and the largest finite value, dividing that range evenly; none if there is no
/// such range.
std::vector<double> even_levels(std::span<double const> values, std::size_t count);

/// The mean of the finite values; NaN if there are none.
double mean_value(std::span<double const> values);

/// The parts of a line inside the box of a grid: cut at periodic walls, each part where the box is.
std::vector<ContourLine> inside_box(ContourLine const& line, MeshGrid const& grid);

}  // namespace boltzmann
