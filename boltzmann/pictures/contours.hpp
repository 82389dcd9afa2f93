// Contours: lines along which a quantity on a plane grid has a given value.
#pragma once

#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <cstddef>
#include <span>
#include <vector>

namespace boltzmann {

/// One line. Larger values are on its left, so it goes anticlockwise around a hill.
struct ContourLine {
  double level;
  /// True if it returns to its start. Its last point then repeats the first, or is an image of it if the line goes
  /// around a periodic axis. Through a periodic wall a line continues outside the box, without a jump.
  bool closed;
  std::vector<double> x, y;
};

/// The lines of each level, one level after the other, by marching squares. Values are interpolated linearly between
/// neighbouring nodes. In a cell with a saddle, the mean of its corners decides which of them are connected. Along
/// periodic axes the last node is the neighbour of the first. Lines end at other walls and at nodes without a value
/// (NaN). A node whose value equals the level counts as above it.
///
/// Throws Error if the grid is not two-dimensional, or has not one value per node.
std::vector<ContourLine> contour_lines(MeshGrid const& grid, std::span<double const> values,
                                       std::span<double const> levels);

/// `count` equidistant levels between the smallest and the largest finite value; none if there is no such range.
std::vector<double> even_levels(std::span<double const> values, std::size_t count);

/// The mean of the finite values; NaN if there are none.
double mean_value(std::span<double const> values);

/// The parts of a line inside the box of a grid: cut at periodic walls, each part mapped into the box.
std::vector<ContourLine> inside_box(ContourLine const& line, MeshGrid const& grid);

}  // namespace boltzmann
