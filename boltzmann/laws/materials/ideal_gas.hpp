// The ideal gas.
#pragma once

#include <boltzmann/laws/material.hpp>

namespace boltzmann {

/// P = (gamma - 1) rho e, T = e / cv, c^2 = gamma P / rho. An energy below zero (rounding, in a cold gas) has the sound
/// speed zero.
struct IdealGas {
  double gamma;   ///< ratio of the specific heats: (f + 2) / f for f degrees of freedom
  double cv = 1;  ///< specific heat at constant volume, energy / (mass temperature)

  static constexpr MaterialText text{
      .name = "ideal-gas", .doc = "the ideal gas", .formula = "P = (gamma - 1) rho e, T = e / specific_heat"};
  static constexpr auto parameters() {
    return std::tuple{ParameterOf{&IdealGas::gamma, gamma_parameter},
                      ParameterOf{&IdealGas::cv, specific_heat_parameter}};
  }

  template <class P>
  State state(P const& p) const {
    double const push = (gamma - 1) * p.specific_energy;                    // P / rho
    return {p.density * push, p.specific_energy / cv, sqrt(gamma * push)};  // NaN, and refused, for a negative energy
  }
  double specific_heat() const { return cv; }
};

}  // namespace boltzmann
