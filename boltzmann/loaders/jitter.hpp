// Jitter: displaces particles at random, to disturb a lattice.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>

namespace boltzmann {

struct JitterOptions {
  double most = 0;  ///< the largest displacement along an axis
  std::uint64_t seed = 1;
};

/// Displaces every particle by a random length, uniform in (-most, most), along each axis. A particle's numbers depend
/// only on the seed, the ensemble's name and its own number. Error if `most` is negative or not finite.
void jitter(AnyEnsemble& particles, JitterOptions const& options);

}  // namespace boltzmann
