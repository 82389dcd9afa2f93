// The kernels of panels for many particles, compiled for every instruction set. Private to this module.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#include <cstddef>

namespace boltzmann {

/// Point vortices that represent a sheet, with strengths over 2 pi, and a common core.
struct SheetPoints {
  double const *x, *y, *strength;
  std::size_t count;
  double core2;
};

/// Adds to u and v the velocities of the points at `count` places. The arrays extend `places_padding` numbers beyond
/// the end.
inline constexpr std::size_t places_padding = 16;
using SheetVelocities = void (*)(SheetPoints const& points, double const* x, double const* y, double* u, double* v,
                                 std::size_t count);
struct PanelKernels {
  SheetVelocities velocities;
};
template <InstructionSet set>
PanelKernels const& panel_kernels();

}  // namespace boltzmann
