// Discs: galaxies, rings around planets, gas around a star, each particle on a circle in the gravity of all.
#pragma once

#include <boltzmann/core/words.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

namespace boltzmann {

/// How the surface density falls with the distance R from the middle.
enum class DiscProfile {
  exponential,  ///< as exp(-R / radius) (K. C. Freeman, Astrophys. J. 160, 811 (1970))
  kuzmin,       ///< as (R^2 + radius^2)^(-3/2) (G. G. Kuzmin, 1956; A. Toomre, Astrophys. J. 138, 385 (1963))
  uniform,      ///< the same up to the radius
};
Words<DiscProfile> const& disc_profile_words();

struct DiscOptions {
  DiscProfile profile = DiscProfile::exponential;
  double mass = std::numeric_limits<double>::quiet_NaN();    ///< of all together, needed; 0: they feel the middle alone
  double radius = std::numeric_limits<double>::quiet_NaN();  ///< needed
  double edge = 0;          ///< where the disc ends; 0: 5 radii, of the uniform one the radius
  double central_mass = 0;  ///< of something else in the middle, about which they move, too
  double G = 1;             ///< Newton's constant
  std::array<double, 3> centre{0, 0, 0}, drift{0, 0, 0};  ///< where the centre of mass is, and how it moves
  std::array<double, 3> normal{0, 0, 1};                  ///< in 3D, of any length: they go around it; in 2D around +z
  std::uint64_t seed = 1;
};

/// The gravity of a disc that ends at its edge, towards its middle, in its plane, and the velocity on a circle. In 2D,
/// where masses are rods of unit length, it is that of the mass inside.
class DiscGravity {
 public:
  DiscGravity(DiscOptions const& options, int dimension);
  /// The part of the mass within R.
  double mass_within(double R) const;
  /// The distance from the middle within which there is this part of the mass.
  double radius_of(double part) const;
  double acceleration(double R) const;
  double circular_velocity(double R) const;

 private:
  std::array<double, 2> surface(double R) const;
  double of_the_disc(double R) const;

  DiscOptions options_;
  int dimension_;
  double edge_;
  std::vector<double> table_;  // of_the_disc, at distances whose roots are even, up to the edge
};

/// Gives each particle the same share of the mass, a place in the disc at random, and the velocity on a circle in the
/// gravity of disc and centre. Centre of mass and momentum are then those that were asked for, exactly. Such a disc is
/// cold, and so falls into rings and arms by itself; a softening that is no longer small against its radius slows its
/// motion. Error in 1D, if the class has no mass or velocity, or a number can't be.
void disc_load(AnyEnsemble& ensemble, DiscOptions const& options);

}  // namespace boltzmann
