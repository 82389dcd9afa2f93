// Thermostat chain: the variables of a Nose-Hoover chain, for any kinetic energy.
#pragma once

#include <cstddef>
#include <vector>

namespace boltzmann {

/// dv = -u1 v dt, Q1 du1/dt = 2 K - f k T - Q1 u1 u2, Qj duj/dt = Q(j-1) u(j-1)^2 - k T - Qj uj u(j+1), with
/// Q1 = f k T / rate^2 and Qj = k T / rate^2, for a kinetic energy K of f degrees of freedom.
struct ThermostatChain {
  std::vector<double> rates, integrals;  ///< u, and their integrals over time

  explicit ThermostatChain(std::size_t length) : rates(length, 0.0), integrals(length, 0.0) {}

  /// Over a time, by the sixth-order weights of Suzuki and Yoshida. Returns the factor of velocities.
  double advance(double kinetic, double degrees, double kT, double rate, double time);
  /// The sum of Qj uj^2 / 2, f k T times the integral of u1 and k T times those of the others. With K and the potential
  /// energy of v's forces it is conserved.
  double energy(double degrees, double kT, double rate) const;
};

}  // namespace boltzmann
