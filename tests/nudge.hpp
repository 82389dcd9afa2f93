// Other roundings for tests of chaotic motion: what another processor's order of sums would do within a few steps.
#pragma once

#include <boltzmann/core/random.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <tests/seed.hpp>

#include <limits>

namespace boltzmann {

/// Changes each coordinate by up to two units of its last digit where BOLTZMANN_TEST_SEED is set; else nothing.
inline void nudge(AnyEnsemble& particles) {
  if (test_seed(0) == 0) return;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    Stream stream(test_seed(0), 0, i, Purpose::user);
    for (int a = 0; a < particles.dimension(); ++a)
      particles.row(i)[a] *= 1 + 2 * std::numeric_limits<double>::epsilon() * (2 * stream.uniform() - 1);
  }
}

}  // namespace boltzmann
