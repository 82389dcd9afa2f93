// The value of a diagnosis for unknown numbers.
#pragma once

#include <limits>

namespace boltzmann {

/// Not a number: a gap in tables and pictures.
inline constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

}  // namespace boltzmann
