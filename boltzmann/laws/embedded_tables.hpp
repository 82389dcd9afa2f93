// The splines of embedded atoms in the form that loops over pairs read.
#pragma once

#include <boltzmann/laws/octave_knots.hpp>

#include <cstdint>

namespace boltzmann {

/// For each pair of elements (a, b) and interval of r^2 blocks of four coefficients: the density of b at a, and the
/// pair energy. With several elements they are followed by the density of a at b and an unused block.
struct EmbeddedTables {
  OctaveKnots knots;
  double const* rows = nullptr;
  std::int64_t elements = 0;
  std::int64_t pair_stride = 0;  ///< doubles from one pair of elements to the next

  std::int64_t line() const { return elements > 1 ? 16 : 8; }  ///< doubles from one interval to the next
};

}  // namespace boltzmann
