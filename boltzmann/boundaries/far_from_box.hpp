// Coordinates that are too far from a periodic box to be wrapped into it.
#pragma once

#include <boltzmann/boundaries/box.hpp>

namespace boltzmann {

/// True if a coordinate is more than 2^53 lengths of a periodic axis from the box. The spacing of doubles there is
/// larger than the box, so that Box::wrapped() would give an arbitrary position. False on other axes.
inline bool far_from_box(Box const& box, double x, int axis) {
  double const room = 0x1p53 * box.length(axis);
  return box.periodic(axis) && !(x >= box.low(axis) - room && x <= box.high(axis) + room);
}

}  // namespace boltzmann
