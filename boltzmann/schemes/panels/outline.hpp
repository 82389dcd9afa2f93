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
  /// True if the first corner is a trailing edge, where a Kutta condition can hold.
  bool sharp = false;
};

Outline circle_outline(Vector<2> const& centre, double radius, std::size_t panels);
/// Semi-axes along x and y before a counterclockwise rotation by `angle` (radians).
Outline ellipse_outline(Vector<2> const& centre, double a, double b, double angle, std::size_t panels);
/// A four-digit NACA aerofoil, "2412" (I. H. Abbott and A. E. von Doenhoff, Theory of Wing Sections, chapter 6), with
/// the closed trailing edge of the last coefficient -0.1036. `centre` is its quarter-chord point; `attack` (radians)
/// lifts its nose. Throws Error if the name is not four digits, or the thickness is zero.
Outline naca_outline(std::string const& digits, Vector<2> const& centre, double chord, double attack,
                     std::size_t panels);
/// A polygon through these points, in either orientation. Each side is cut into equal panels, about `panels` in all.
/// Throws Error if sides cross or the area is zero.
Outline polygon_outline(std::vector<Vector<2>> points, std::size_t panels, bool sharp = false);

/// The transformation of a shape from a file: its numbers times `length`, rotated counterclockwise by `angle` (radians)
/// about its origin, which is at `centre`.
struct OutlinePlace {
  double length = 1, angle = 0;
  Vector<2> centre{};
};
/// The polygon through the points of a file with x and y of one point per line (laws/two_columns.hpp), in either
/// orientation. The last point may repeat the first. With a `sharp` edge it is the first point. Throws Error with file
/// and line if the file can't be read, if two neighbours are coincident or sides meet.
Outline outline_from_file(std::string const& path, std::size_t panels, OutlinePlace const& place = {},
                          bool sharp = false);

/// Throws Error, in one line, if it is not a valid outline: fewer than 3 corners, coincident corners, clockwise.
void check(Outline const& outline);

}  // namespace boltzmann
