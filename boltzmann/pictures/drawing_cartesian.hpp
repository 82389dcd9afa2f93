// What stands around particles in a drawing of space: axes and box, connections, what colours mean, arrows. Shared by
// draw_cartesian() and the pictures of a simulation.
#pragma once

#include <boltzmann/pictures/draw_arrays.hpp>

#include <array>
#include <cstddef>
#include <span>
#include <vector>

namespace boltzmann {

using Place3 = std::array<double, 3>;

/// An empty drawing of a plane or (with a projection) of space: title, axes, the outline of the style's box.
Canvas start_cartesian(CartesianStyle const& style, Projection const* projection);

/// A connection from place to place, as two halves if it goes through a periodic wall.
void draw_connection(Canvas& canvas, Place3 const& from, Place3 const& to, CartesianStyle const& style);

/// The colour bar of the style's value from low to high, or the legend of its species.
void explain_colours(Canvas& canvas, CartesianStyle const& style, double low, double high, bool with_value);
/// "3 particles without a value (grey)"; nothing for none.
void note_without_value(Canvas& canvas, std::size_t count);

struct PlacedVector {
  Place3 place, vector;
};
/// An arrow for each; the longest spans 1.5 particle distances, and a note tells what it stands for: `factor` times its
/// length, in `unit`.
void draw_arrows(Canvas& canvas, std::span<PlacedVector const> arrows, double particle_distance, double factor,
                 std::string const& unit);

/// Pixels of points of so many particles: smaller ones when they are many.
float fitting_point(std::size_t count);

}  // namespace boltzmann
