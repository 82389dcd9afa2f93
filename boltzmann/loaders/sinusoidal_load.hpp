// Ripples: particles with a wave in their density or velocity, random or as a quiet start (appendix A.4 of the 1990
// thesis).
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>

namespace boltzmann {

/// sin(wave_number (x - low) + phase), with x the position on an axis and low that axis' low edge.
struct Wave {
  int axis = 0;
  double wave_number = 0;
  double phase = 0;
};

/// The wave with this number of periods in the box. Error if the box has no such axis.
Wave wave_of_mode(Box const& box, int axis, double mode, double phase = 0);

struct SinusoidalOptions {
  Wave wave;
  double amplitude = 0;
  std::uint64_t seed = 1;
};

/// Random positions: with a density proportional to 1 + amplitude sin(...) along the wave's axis, uniform along the
/// others; regions as in random_load. Error if |amplitude| > 1, or if the box has no such axis.
void sinusoidal_load(AnyEnsemble& ensemble, Box const& box, SinusoidalOptions const& options);

struct QuietOptions {
  Wave wave;
  double amplitude = 0;
};

/// The same density without noise (quiet start): particle i is at the quantile (i + 1/2)/N along the axis, and evenly
/// spaced along the others, in bit-reversed order and that of base 3. Amplitude 0 is a uniform density. Error as above,
/// and if the box has regions.
void quiet_load(AnyEnsemble& ensemble, Box const& box, QuietOptions const& options = {});

struct VelocityRipple {
  Wave wave;
  double amplitude = 0;
  int component = 0;
};

/// Adds amplitude sin(...) to a component of the velocity of every particle, at its position. Error if the class has no
/// such component or the box no such axis.
void velocity_ripple(AnyEnsemble& ensemble, Box const& box, VelocityRipple const& ripple);

}  // namespace boltzmann
