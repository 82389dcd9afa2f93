// Rotation: a law that does nothing but turn velocities, for integrators that turn them without changing their
// magnitude.
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
  std::uint32_t const* only = nullptr;  ///< the particles that it turns; null: all
  double time = 0;                      ///< each velocity turns by the angle atan(|Omega| time)
};

using RotationKernel = void (*)(void const* law, RotationTask const& task, std::size_t begin, std::size_t end);

/// What a scheme hands to the integrator of an ensemble; it holds as long as the scheme.
struct Rotation {
  RotationKernel kernel;
  void const* law;
  std::vector<std::uint32_t> const* only;  ///< the particles that it turns; null: all
};

/// v turned by the angle whose tangent is |tangent|, about that axis (out of the plane in 2D). Its magnitude stays to
/// rounding (J. P. Boris, Proc. 4th Conf. Numerical Simulation of Plasmas, 1970, p. 3).
template <int C, int D>
[[gnu::always_inline]] inline Vector<D> turned(Vector<D> const& v, Vector<C> const& tangent) {
  auto const half = tangent / (1 + std::sqrt(1 + norm2(tangent)));  // the tangent of half the angle
  return v + cross(half * (2 / (1 + norm2(half))), v + cross(half, v));
}

}  // namespace boltzmann
