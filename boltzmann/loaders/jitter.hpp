// Jitter: particles moved off their places at random, so that a lattice is one no more.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>

namespace boltzmann {

struct JitterOptions {
  double most = 0;  ///< the largest move along an axis
  std::uint64_t seed = 1;
};

/// Moves every particle by a random length, uniform in (-most, most), along each axis. A particle's numbers depend on
/// the seed, the ensemble's name and its own number alone. Error if `most` is negative or not finite.
void jitter(AnyEnsemble& particles, JitterOptions const& options);

}  // namespace boltzmann
