// The Lamb-Oseen vortex: a line of vorticity that viscosity spreads.
#pragma once

namespace boltzmann::exact {

/// The velocity around the vortex, and the vorticity; in any consistent units.
struct VortexState {
  double velocity, vorticity;
};

/// At a distance from a vortex that was a line at t = 0: v = Gamma/(2 pi r) (1 - exp(-r^2/(4 nu t))), omega = Gamma/(4
/// pi nu t) exp(-r^2/(4 nu t)) (H. Lamb, *Hydrodynamics*, 6th edition, 1932, section 334a). The velocity is largest at r
/// = 1.1209 sqrt(4 nu t). Gamma is the circulation far out, nu the kinematic viscosity. Errors: a negative distance, a
/// time or viscosity that is not positive, a number that is not finite.
VortexState lamb_oseen(double distance, double time, double circulation, double viscosity);

}  // namespace boltzmann::exact
