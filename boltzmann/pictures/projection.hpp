// Spaces on paper: a canvas with three axes becomes the flat one that shows how it is seen.
#pragma once

#include <boltzmann/pictures/canvas.hpp>

#include <array>

namespace boltzmann {

/// The box of a space: low and high of each axis, from the axes or, where they leave it open, with some room around
/// the content.
std::array<std::array<double, 2>, 3> space_box(Canvas const& space);

/// What a picture of a space shows: marks where their projection puts them, circles, points and clouds sorted by depth
/// and far ones paler, the outline of the box behind and before them, and names and ticks along its edges. Images,
/// which have no place in a space, are left out with a note. A flat canvas stays as it is.
Canvas flattened(Canvas const& space);

}  // namespace boltzmann
