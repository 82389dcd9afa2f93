// Gases whose entropy is the same everywhere and always: the pressure is a function of the density alone.
#pragma once

#include <boltzmann/laws/material.hpp>

namespace boltzmann {

/// P = constant rho^gamma, e = constant rho^(gamma - 1) / (gamma - 1), c^2 = gamma P / rho. Barotropic: no temperature.
struct IsentropicGas {
  double constant;
  double gamma;

  template <class P>
  State state(P const& p) const {
    double const push = constant * pow(p.density, gamma - 1);  // P / rho
    return {p.density * push, 0, sqrt(gamma * push)};
  }
  double energy(double density) const { return constant * pow(density, gamma - 1) / (gamma - 1); }

  void check() const {
    check_parameter("isentropic-gas", "constant", constant, positive);
    check_parameter("isentropic-gas", "gamma - 1", gamma - 1, positive);
  }
};

/// P = coefficient rho^2, e = coefficient rho, c^2 = 2 coefficient rho: the isentrope of the two-dimensional ideal gas,
/// "P = rho^2 / 2" in Hoover and Hoover's SPAM. Its smooth particles are atoms, with their weight as the pair potential
/// (Eq 20).
struct QuadraticGas {
  double coefficient = 0.5;

  template <class P>
  State state(P const& p) const {
    return {coefficient * square(p.density), 0, sqrt(2 * coefficient * p.density)};
  }
  double energy(double density) const { return coefficient * density; }
  double pressure_by_density2() const { return coefficient; }

  void check() const { check_parameter("quadratic-gas", "coefficient", coefficient, positive); }
};

}  // namespace boltzmann
