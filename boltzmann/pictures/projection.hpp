// Projections: converts a canvas with three axes to the flat canvas of its view.
#pragma once

#include <boltzmann/pictures/canvas.hpp>

#include <array>

namespace boltzmann {

/// The box of a space: low and high of each axis, from the axes or, if they are automatic, with a margin around the
/// content.
std::array<std::array<double, 2>, 3> space_box(Canvas const& space);

/// The flat picture of a space: marks at their projected positions; circles, points and clouds sorted by depth and
/// faded with distance; the outline of the box behind and in front; names and ticks along its edges. Images, which have
/// no position in a space, are omitted with a note. A flat canvas is unchanged.
Canvas flattened(Canvas const& space);

}  // namespace boltzmann
