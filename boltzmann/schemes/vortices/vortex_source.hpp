// Vortex source: an ensemble of vortices that carries others, and by which law.
#pragma once

#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/particles/ensemble.hpp>

namespace boltzmann {

struct VortexSource {
  AnyEnsemble* ensemble;
  VortexLaw law;
  double tolerance = 0;     ///< of multipoles; 0: by pairs
  bool background = false;  ///< vorticity that is spread over a periodic plane, so that all cancels
};

}  // namespace boltzmann
