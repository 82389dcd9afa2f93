// Random loads: positions and velocities drawn from the distributions of section 5.1 of the 1990 thesis.
//
// All draw for particle i from a stream of its own, keyed by the seed, the ensemble's name and i: the same bits for the
// same seed, for any number of other particles. With boltzmann_constant 1 a temperature is an energy.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <functional>
#include <limits>
#include <string_view>
#include <vector>

namespace boltzmann {

struct RandomLoadOptions {
  double minimum_distance = 0;
  double packing_fraction = 0;  ///< instead: the fraction of the box that rods, discs or spheres of this diameter fill
  std::uint64_t seed = 1;
  std::function<bool(double const*)> where{};  ///< restricts positions to where it is true; by default everywhere
  /// Existing particles, from which new ones keep this distance, by nearest images in `space` (null: the box). Error if
  /// no position is found in 20,000 draws, or the space is sheared.
  std::vector<AnyEnsemble const*> others{};
  double distance_to_others = 0;
  Box const* space = nullptr;
};

/// Positions uniform in the box, outside the regions that keep particles out, inside those that keep them in, and where
/// `where` is true. Use a box that encloses the shape tightly, so that positions are found fast. With a minimum
/// distance, particle i is drawn again until it has that distance from particles 0..i-1 (nearest images on periodic
/// axes): random sequential addition. Error if there is no place left, with the fraction reached. A packing fraction
/// determines the distance (also the diameter of drawings, unless one is set). Error if it is not below saturation,
/// 0.7476 in 1D, 0.547 in 2D, 0.384 in 3D, or there are regions or a `where`.
void random_load(AnyEnsemble& ensemble, Box const& box, RandomLoadOptions const& options = {});

/// The minimum distance at which this number of particles has this packing fraction; the other: the number of particles
/// for a distance.
double distance_for_packing(Box const& box, std::size_t count, double fraction);
double count_for_packing(Box const& box, double distance, double fraction);
/// Error, with the limit, for a packing fraction that random addition can't reach.
void check_packing(double fraction, int dimension);

/// One component of a field drawn from any random variable: RandomLoad of section B.9.1, for example with Ripple on
/// "position". Components count from 0. Error if there is no such field or component.
void random_field(AnyEnsemble& ensemble, std::string_view field, int component,
                  std::function<double(Stream&)> const& variable, std::uint64_t seed);

struct MaxwellianOptions {
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< required
  double boltzmann_constant = 1;
  std::uint64_t seed = 1;
  /// Subtracts the mean (mass-weighted) velocity, so that the total momentum is zero.
  bool remove_drift = false;
  /// Scales the velocities so that the measured temperature is exact: Sum m v.v = k T times the number of degrees of
  /// freedom, D N, or D (N - 1) after remove_drift.
  bool exact_temperature = false;
  /// A velocity that is added to all: beams and streams.
  std::array<double, 3> drift{0, 0, 0};
  /// No noise: the velocities are the quantiles of the distribution, in an order in which consecutive particles cover
  /// all of it. After a quiet load every cell has the whole distribution.
  bool quiet = false;
};

/// Velocities in equilibrium (Eq 5.1): each component normal with variance k T / m, m the particle's own mass.
/// Error if the class has no mass or velocity, a mass is not positive, or the temperature is negative.
void maxwellian_load(AnyEnsemble& ensemble, MaxwellianOptions const& options);

struct OscillatingOptions {
  double temperature = std::numeric_limits<double>::quiet_NaN();        ///< required
  double angular_frequency = std::numeric_limits<double>::quiet_NaN();  ///< required
  double boltzmann_constant = 1;
  std::uint64_t seed = 1;
};

/// Displaces particles from their positions, like small oscillations of angular frequency omega in equilibrium (Eq
/// 5.2): each component normal with variance k T / (m omega^2). Error as above, and if omega is not positive.
void oscillating_load(AnyEnsemble& ensemble, OscillatingOptions const& options);

struct BarometricOptions {
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< required
  double gravity = std::numeric_limits<double>::quiet_NaN();      ///< the acceleration g, required
  double boltzmann_constant = 1;
  std::uint64_t seed = 1;
};

/// Positions in a gravitational field g that points down the last axis (Eq 5.3). The density falls as exp(-m g h / k T)
/// with the height h above the box's low edge and ends at the high one; it is uniform along the other axes. Drawn by
/// inversion of the truncated distribution; g = 0 is uniform, a negative g points up. Regions as in random_load. Error
/// if the class has no mass or the temperature is not positive.
void barometric_load(AnyEnsemble& ensemble, Box const& box, BarometricOptions const& options);

}  // namespace boltzmann
