// Vortex tubes with a resolved core: rings, knots, any closed curve in space.
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

/// The profile of a tube: vorticity exp(-d^2 / core_radius^2) at the distance d from the line, for elements with
/// Gaussian cores; other cores change its tail.
struct VortexTube {
  double circulation = 1;
  double core_radius = std::numeric_limits<double>::quiet_NaN();  ///< required
  std::size_t layers = 4;    ///< of 8, 16, ... elements around the central one: (2 layers + 1)^2 in a section
  double overlap = 1.25;     ///< the core of an element divided by the spacing
  std::size_t sections = 0;  ///< along the line; 0: spaced like the elements of a section
};

/// The number of elements of a tube of this length. Error if a number is not positive, or the core is as wide as the
/// length.
std::size_t vortex_tube_count(double length, VortexTube const& tube);

/// Creates the elements: positions, "vorticity" and "core". `curve` is a closed curve with an argument from 0 to 1.
/// Each section has exactly the given circulation, and all vorticity is along the line: tubes have no twist. Error if
/// space has not three dimensions, the class has no vorticity or core, or as above.
void vortex_tube_load(AnyEnsemble& ensemble, std::function<Vector<3>(double)> const& curve, VortexTube const& tube);

struct VortexRing {
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< required
  std::array<double, 3> centre{0, 0, 0};
  std::array<double, 3> normal{0, 0, 1};  ///< of any length: the direction in which a ring of positive circulation
                                          ///< moves
  VortexTube tube{};
};
void vortex_ring_load(AnyEnsemble& ensemble, VortexRing const& ring);

}  // namespace boltzmann
