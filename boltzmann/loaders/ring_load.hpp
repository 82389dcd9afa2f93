// Particles evenly on a circle: rings of vortices, of bodies, of charges.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <limits>

namespace boltzmann {

struct RingOptions {
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< required
  std::array<double, 3> centre{0, 0, 0};
  std::array<double, 3> normal{0, 0, 1};  ///< in 3D, of any length: the axis of the ring
  std::int64_t mode = 0;                  ///< the radius is radius (1 + ripple cos(mode angle))
  double ripple = 0;
};

/// Puts particle k of N at an angle of 2 pi k / N, counterclockwise about the normal (2D: about +z), from the x axis or,
/// where the normal is near that, from the y axis. Error if space has one dimension, if the radius is not positive, or
/// the normal has no direction.
void ring_load(AnyEnsemble& ensemble, RingOptions const& options);

}  // namespace boltzmann
