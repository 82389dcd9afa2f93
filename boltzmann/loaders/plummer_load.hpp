// Plummer's sphere: a cluster of stars in equilibrium with its own gravity (Plummer 1911; Aarseth, Henon and Wielen
// 1974, Astron. Astrophys. 37:183).
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <limits>

namespace boltzmann {

struct PlummerOptions {
  double mass = std::numeric_limits<double>::quiet_NaN();    ///< of all together, required
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< a, required; half of the mass is within 1.305 a
  double G = 1;                                              ///< Newton's constant
  std::array<double, 3> centre{0, 0, 0}, drift{0, 0, 0};     ///< position and velocity of the centre of mass
  std::uint64_t seed = 1;
};

/// Gives each particle an equal part of the mass, a position with the density 3 M / (4 pi a^3) (1 + r^2/a^2)^(-5/2),
/// and a velocity from the distribution f ~ (-E)^(7/2), for which the cluster is stationary. Its potential energy is
/// -(3 pi / 32) G M^2 / a, twice its kinetic energy. Centre of mass and momentum are then set exactly to the given
/// values. Error if space has not three dimensions, the class has no mass or velocity, or mass, radius or G is not
/// positive.
void plummer_load(AnyEnsemble& ensemble, PlummerOptions const& options);

}  // namespace boltzmann
