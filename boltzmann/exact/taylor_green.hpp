// The Taylor-Green vortices in the plane: a flow that decays and keeps its form.
#pragma once

#include <boltzmann/core/vector.hpp>

namespace boltzmann::exact {

/// Velocity, vorticity, and pressure above its mean; in any consistent units.
struct FlowState {
  Vector<2> velocity;
  double vorticity, pressure;
};

/// An incompressible fluid in a periodic square with the edge L and k = 2 pi/L: u = U f (-cos kx sin ky, sin kx cos ky),
/// omega = 2 k U f cos kx cos ky, p = -(density/4) U^2 f^2 (cos 2kx + cos 2ky), with f = exp(-2 k^2 nu t) (G. I. Taylor,
/// Phil. Mag. 46, 671, 1923). U is the largest speed at t = 0, nu the kinematic viscosity. Errors: an edge or density
/// that is not positive, a negative time or viscosity, a number that is not finite.
FlowState taylor_green(Vector<2> const& position, double time, double speed, double edge, double viscosity,
                       double density = 1);

}  // namespace boltzmann::exact
