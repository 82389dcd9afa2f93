// The splines of embedded atoms as loops over pairs read them.
#pragma once

#include <boltzmann/laws/octave_knots.hpp>

#include <cstdint>

namespace boltzmann {

/// For each pair of elements (a, b) and interval of r^2 blocks of four coefficients: the density of b at a, the pair
/// energy and, where there are several elements, the density of a at b and a block that nobody reads.
struct EmbeddedTables {
  OctaveKnots knots;
  double const* rows = nullptr;
  std::int64_t elements = 0;
  std::int64_t pair_stride = 0;  ///< doubles from one pair of elements to the next

  std::int64_t line() const { return elements > 1 ? 16 : 8; }  ///< doubles from one interval to the next
};

}  // namespace boltzmann
