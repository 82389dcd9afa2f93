// Vortex source: an ensemble of vortices that advects others, and its law.
#pragma once

#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/ensemble.hpp>

namespace boltzmann {

struct VortexSource {
  AnyEnsemble* ensemble;
  VortexLaw law;
  double tolerance = 0;     ///< of multipoles; 0: sums over pairs
  bool background = false;  ///< vorticity is spread over a periodic plane, so that the total is zero
};

}  // namespace boltzmann
