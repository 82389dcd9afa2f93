// Rotation: a law that only rotates velocities, for integrators that rotate them without a change of magnitude.
#pragma once

#include <boltzmann/core/vector.hpp>

#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

struct RotationTask {
  double* rows = nullptr;
  std::size_t row_stride = 0;           ///< doubles from row to row
  std::uint32_t const* only = nullptr;  ///< particles to rotate; null: all
  double time = 0;                      ///< each velocity is rotated by the angle atan(|Omega| time)
};

using RotationKernel = void (*)(void const* law, RotationTask const& task, std::size_t begin, std::size_t end);

/// Given by a scheme to the integrator of an ensemble; valid as long as the scheme.
struct Rotation {
  RotationKernel kernel;
  void const* law;
  std::vector<std::uint32_t> const* only;  ///< particles to rotate; null: all
};

/// v rotated about that axis (out of the plane in 2D) by the angle whose tangent is |tangent|. Its magnitude is
/// conserved to rounding (J. P. Boris, Proc. 4th Conf. Numerical Simulation of Plasmas, 1970, p. 3).
template <int C, int D>
[[gnu::always_inline]] inline Vector<D> turned(Vector<D> const& v, Vector<C> const& tangent) {
  auto const half = tangent / (1 + std::sqrt(1 + norm2(tangent)));  // the tangent of half the angle
  return v + cross(half * (2 / (1 + norm2(half))), v + cross(half, v));
}

}  // namespace boltzmann
