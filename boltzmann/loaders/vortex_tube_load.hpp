// Vortex tubes with a resolved core: rings, knots, any closed line in space.
//
//   vortex_ring_load(ring, {.radius = 1, .tube = {.circulation = 1, .core_radius = 0.15}});
#pragma once

#include <boltzmann/core/vector.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <limits>

namespace boltzmann {

/// What is around the line: vorticity that goes as exp(-d^2 / core_radius^2) with the distance d from it, where elements
/// have Gaussian cores; other cores change its tail.
struct VortexTube {
  double circulation = 1;
  double core_radius = std::numeric_limits<double>::quiet_NaN();  ///< needed
  std::size_t layers = 4;    ///< of 8, 16, ... elements around the one in the middle: (2 layers + 1)^2 in a section
  double overlap = 1.25;     ///< the core of an element over the spacing
  std::size_t sections = 0;  ///< along the line; 0: about as far from each other as elements in a section
};

/// How many elements a tube of this length has. Error if a number is not positive, or the core is as wide as the length.
std::size_t vortex_tube_count(double length, VortexTube const& tube);

/// Makes the elements: places, "vorticity" and "core". `curve` goes once around as its argument goes from 0 to 1.
/// Through each section goes the circulation exactly, and all vorticity is along the line: tubes have no twist. Error if
/// space has not three dimensions, the class has no vorticity or core, or as above.
void vortex_tube_load(AnyEnsemble& ensemble, std::function<Vector<3>(double)> const& curve, VortexTube const& tube);

struct VortexRing {
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< needed
  std::array<double, 3> centre{0, 0, 0};
  std::array<double, 3> normal{0, 0, 1};  ///< of any length: where the ring goes to, if its circulation is positive
  VortexTube tube{};
};
void vortex_ring_load(AnyEnsemble& ensemble, VortexRing const& ring);

}  // namespace boltzmann
