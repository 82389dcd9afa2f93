// The stiffened gas: liquids and solids under strong shocks, with heat.
#pragma once

#include <boltzmann/laws/material.hpp>

namespace boltzmann {

/// P = (gamma - 1) rho e - gamma stiffness, e = cv T + stiffness / rho, c^2 = gamma (P + stiffness) / rho. With
/// stiffness 0 it is the ideal gas. Beyond its tensile limit, P < -stiffness, the sound speed is zero.
struct StiffenedGas {
  double gamma;
  double stiffness;  ///< a pressure, P_infinity
  double cv = 1;     ///< specific heat at constant volume, energy / (mass temperature)

  static constexpr MaterialText text{
      .name = "stiffened-gas",
      .doc = "liquids and solids under strong shocks, with heat",
      .formula = "P = (gamma - 1) rho e - gamma stiffness, e = specific_heat T + stiffness / rho"};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&StiffenedGas::gamma, gamma_parameter},
        ParameterOf{&StiffenedGas::stiffness,
                    {"stiffness", material_dimensions::pressure, "a pressure; 0: the ideal gas", not_negative}},
        ParameterOf{&StiffenedGas::cv, specific_heat_parameter}};
  }

  template <class P>
  State state(P const& p) const {
    double const thermal = p.specific_energy - stiffness / p.density;  // (P + stiffness) / ((gamma - 1) rho)
    return {(gamma - 1) * p.density * thermal - stiffness, thermal / cv, sqrt(max(gamma * (gamma - 1) * thermal, 0))};
  }
  double specific_heat() const { return cv; }
  /// The specific energy at which that density has that pressure: for initial states.
  double energy_at(double density, double pressure) const {
    return (pressure + gamma * stiffness) / ((gamma - 1) * density);
  }
};

}  // namespace boltzmann
