// Coordinates that are too far from a periodic box to be folded into it.
#pragma once

#include <boltzmann/boundaries/box.hpp>

namespace boltzmann {

/// Whether a coordinate is more than 2^53 lengths of a periodic axis from the box. Doubles are further apart there than the
/// box is long, so that Box::wrapped() would give an arbitrary place. False on other axes.
inline bool far_from_box(Box const& box, double x, int axis) {
  double const room = 0x1p53 * box.length(axis);
  return box.periodic(axis) && !(x >= box.low(axis) - room && x <= box.high(axis) + room);
}

}  // namespace boltzmann
