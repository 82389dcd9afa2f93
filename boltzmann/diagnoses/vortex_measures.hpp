// Vortex measures: the quantities that a flow of vortices conserves without viscosity and boundaries, over the density
// of the fluid. Exact sums over the particles (ExactSum); ensembles without vorticity contribute nothing.
#pragma once

#include <boltzmann/diagnoses/measures.hpp>

namespace boltzmann {

bool has_vorticity(AnyEnsemble const& ensemble);

/// For elements with circulation Gamma (2D) or vorticity times volume alpha (3D) at x (P. G. Saffman, Vortex Dynamics,
/// chapter 3). In 2D circulation and angular impulse are one number, the first.
struct VortexMeasures {
  Triple circulation{};      ///< sum Gamma; sum alpha, which is zero if vortex lines are closed
  Triple impulse{};          ///< sum Gamma (y, -x); 1/2 sum x x alpha
  Triple angular_impulse{};  ///< -1/2 sum Gamma x.x; 1/3 sum x x (x x alpha); about the origin
  double helicity = 0;       ///< 3D: sum alpha.u, with the velocities of the current influences
};
/// Measures of the current state. On periodic axes positions are those in the box, so that impulses jump when vortices
/// cross its ends.
VortexMeasures vortex_measures(Ensembles of);

}  // namespace boltzmann
