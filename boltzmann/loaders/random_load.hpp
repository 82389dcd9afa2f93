// Random loads: positions and velocities drawn from the distributions of section 5.1 of the 1990 thesis.
//
// All draw for particle i from a stream of its own, keyed by the seed, the ensemble's name and i: the same bits for the
// same seed, however many other particles there are. With boltzmann_constant 1 a temperature is an energy.
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
  double packing_fraction = 0;  ///< instead: of the box, which rods, discs or spheres as wide as that fill
  std::uint64_t seed = 1;
  std::function<bool(double const*)> where{};  ///< of a place, only where it is true; without it everywhere
  /// Particles that are there already, which new ones keep this distance from, by nearest images in `space` (null: the
  /// box). Error if no place is found in 20,000 draws, or the space is sheared.
  std::vector<AnyEnsemble const*> others{};
  double distance_to_others = 0;
  Box const* space = nullptr;
};

/// Positions uniform in the box, outside of the regions that keep particles out and inside those that keep them in, and
/// where `where` says so: a box as small as the shape finds places fast. With a minimum distance, particle i is drawn
/// again until it is that far from particles 0..i-1 (nearest images on periodic axes): random sequential addition. Error
/// if there is no place any more, with the fraction reached. Of a packing fraction the distance follows (the ensemble is
/// drawn so wide unless it has a diameter). Error if it is not below saturation, 0.7476 in 1D, 0.547 in 2D, 0.384 in 3D,
/// or there are regions or a `where`.
void random_load(AnyEnsemble& ensemble, Box const& box, RandomLoadOptions const& options = {});

/// The minimum distance at which so many particles have this packing fraction, and how many have it at a distance.
double distance_for_packing(Box const& box, std::size_t count, double fraction);
double count_for_packing(Box const& box, double distance, double fraction);
/// Error, with the limit, for a packing fraction that random addition can't reach.
void check_packing(double fraction, int dimension);

/// One component of a field drawn from any random variable: RandomLoad of section B.9.1, for example with Ripple on
/// "position". Components count from 0. Error if there is no such field or component.
void random_field(AnyEnsemble& ensemble, std::string_view field, int component,
                  std::function<double(Stream&)> const& variable, std::uint64_t seed);

struct MaxwellianOptions {
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< needed
  double boltzmann_constant = 1;
  std::uint64_t seed = 1;
  /// Take the mean (mass-weighted) velocity off: the total momentum is then zero.
  bool remove_drift = false;
  /// Scale the velocities so that the measured temperature is the wanted one: Sum m v.v = k T times the number of
  /// degrees of freedom, D N, or D (N - 1) after remove_drift.
  bool exact_temperature = false;
  /// A velocity that all get on top: beams and streams.
  std::array<double, 3> drift{0, 0, 0};
  /// No noise: the velocities are the quantiles of the distribution, in an order that gives all of it to particles
  /// whose numbers follow each other. After a quiet load every cell so has the whole distribution.
  bool quiet = false;
};

/// Velocities in equilibrium (Eq 5.1): each component normal with variance k T / m, m the particle's own mass.
/// Error if the class has no mass or velocity, a mass is not positive, or the temperature is negative.
void maxwellian_load(AnyEnsemble& ensemble, MaxwellianOptions const& options);

struct OscillatingOptions {
  double temperature = std::numeric_limits<double>::quiet_NaN();        ///< needed
  double angular_frequency = std::numeric_limits<double>::quiet_NaN();  ///< needed
  double boltzmann_constant = 1;
  std::uint64_t seed = 1;
};

/// Displaces particles from where they are, as small oscillations of angular frequency omega do in equilibrium
/// (Eq 5.2): each component normal with variance k T / (m omega^2). Error as above, and if omega is not positive.
void oscillating_load(AnyEnsemble& ensemble, OscillatingOptions const& options);

struct BarometricOptions {
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< needed
  double gravity = std::numeric_limits<double>::quiet_NaN();      ///< the acceleration g, needed
  double boltzmann_constant = 1;
  std::uint64_t seed = 1;
};

/// Positions in a gravitational field g that points down the last axis (Eq 5.3): the density falls as exp(-m g h / k T)
/// with the height h above the box's low edge and ends at the high one; uniform along the other axes. Drawn by
/// inversion of the truncated distribution; g = 0 is uniform, a negative g points up. Regions as in random_load. Error
/// if the class has no mass or the temperature is not positive.
void barometric_load(AnyEnsemble& ensemble, Box const& box, BarometricOptions const& options);

}  // namespace boltzmann
