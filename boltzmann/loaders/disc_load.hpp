// Discs: galaxies, rings around planets, gas around a star, where each particle moves on a circle in the common
// gravity.
#pragma once

#include <boltzmann/core/words.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace boltzmann {

/// The decrease of the surface density with the distance R from the middle.
enum class DiscProfile {
  exponential,  ///< as exp(-R / radius) (K. C. Freeman, Astrophys. J. 160, 811 (1970))
  kuzmin,       ///< as (R^2 + radius^2)^(-3/2) (G. G. Kuzmin, 1956; A. Toomre, Astrophys. J. 138, 385 (1963))
  uniform,      ///< constant up to the radius
};
Words<DiscProfile> const& disc_profile_words();

struct DiscOptions {
  DiscProfile profile = DiscProfile::exponential;
  double mass = std::numeric_limits<double>::quiet_NaN();    ///< of all together, required; 0: they feel only the
                                                             ///< central mass
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< required
  double edge = 0;          ///< the end of the disc; 0: 5 radii, for the uniform one the radius
  double central_mass = 0;  ///< of another body in the middle, which also attracts them
  double G = 1;             ///< Newton's constant
  std::array<double, 3> centre{0, 0, 0}, drift{0, 0, 0};  ///< position and velocity of the centre of mass
  std::array<double, 3> normal{0, 0, 1};                  ///< in 3D the axis of rotation, of any length; in 2D they
                                                          ///< rotate about +z
  std::uint64_t seed = 1;
};

/// The gravity in the plane of a disc that ends at its edge, towards its middle, and the circular velocity. In 2D,
/// where masses are rods of unit length, it is that of the mass inside.
class DiscGravity {
 public:
  DiscGravity(DiscOptions const& options, int dimension);
  /// The part of the mass within R.
  double mass_within(double R) const;
  /// The distance from the middle that contains this part of the mass.
  double radius_of(double part) const;
  double acceleration(double R) const;
  double circular_velocity(double R) const;

 private:
  std::array<double, 2> surface(double R) const;
  double of_the_disc(double R) const;

  DiscOptions options_;
  int dimension_;
  double edge_;
  std::vector<double> table_;  // of_the_disc, at distances with equidistant roots, up to the edge
};

/// Gives each particle an equal part of the mass, a random position in the disc, and the circular velocity in the
/// gravity of disc and central mass. Centre of mass and momentum are then set exactly to the given values. Such a disc
/// is cold, and so forms rings and arms by itself; a softening that is not small against its radius slows its rotation.
/// Error in 1D, if the class has no mass or velocity, or a number is invalid.
void disc_load(AnyEnsemble& ensemble, DiscOptions const& options);

}  // namespace boltzmann
