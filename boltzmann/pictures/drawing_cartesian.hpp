// Elements around particles in a drawing of space: axes and box, connections, legend of colours, arrows. Shared by
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

/// A connection between two positions, as two halves if it crosses a periodic wall.
void draw_connection(Canvas& canvas, Place3 const& from, Place3 const& to, CartesianStyle const& style);

/// The colour bar of the style's value from low to high, or the legend of its species.
void explain_colours(Canvas& canvas, CartesianStyle const& style, double low, double high, bool with_value);
/// "3 particles without a value (grey)"; no note for zero.
void note_without_value(Canvas& canvas, std::size_t count);

struct PlacedVector {
  Place3 place, vector;
};
/// An arrow for each particle. The longest has the length of 1.5 particle distances. A note states its value: `factor`
/// times its length, in `unit`.
void draw_arrows(Canvas& canvas, std::span<PlacedVector const> arrows, double particle_distance, double factor,
                 std::string const& unit);

/// The size of points in pixels: smaller for more particles.
float fitting_point(std::size_t count);

}  // namespace boltzmann
