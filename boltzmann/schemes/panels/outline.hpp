// Outline: the shape of a solid body in a plane flow, as a polygon whose sides are its panels.
#pragma once

#include <boltzmann/core/vector.hpp>

#include <cstddef>
#include <string>
#include <vector>

namespace boltzmann {

struct Outline {
  /// Corners on the shape, counterclockwise; the last side leads back to the first corner.
  std::vector<Vector<2>> corners;
  /// Whether the first corner is a trailing edge, where a Kutta condition can hold.
  bool sharp = false;
};

Outline circle_outline(Vector<2> const& centre, double radius, std::size_t panels);
/// Semi-axes along x and y before it is turned counterclockwise by `angle` (radians).
Outline ellipse_outline(Vector<2> const& centre, double a, double b, double angle, std::size_t panels);
/// An aerofoil of NACA's four digits, "2412" (I. H. Abbott and A. E. von Doenhoff, Theory of Wing Sections, chapter 6), with
/// the closed trailing edge of the last coefficient -0.1036. `centre` is the quarter of its chord; `attack` (radians)
/// lifts its nose. Error if the name is not four digits, or the thickness zero.
Outline naca_outline(std::string const& digits, Vector<2> const& centre, double chord, double attack,
                     std::size_t panels);
/// Through these points, either way around, each side cut into equal panels, so that there are about so many. Error if
/// sides cross or nothing is inside.
Outline polygon_outline(std::vector<Vector<2>> points, std::size_t panels, bool sharp = false);

/// Where a shape of a file is put: its numbers times `length`, turned counterclockwise by `angle` (radians) about its
/// origin, which is at `centre`.
struct OutlinePlace {
  double length = 1, angle = 0;
  Vector<2> centre{};
};
/// The polygon through the points of a file, x and y on a line of its own (laws/two_columns.hpp), either way around; the
/// first may stand at the end again. With a `sharp` edge it is the first. Error with file and line if it can't be read, if
/// two neighbours are at one place or sides meet.
Outline outline_from_file(std::string const& path, std::size_t panels, OutlinePlace const& place = {},
                          bool sharp = false);

/// Error, in one line, if it is no outline: fewer than 3 corners, two at one place, clockwise.
void check(Outline const& outline);

}  // namespace boltzmann
