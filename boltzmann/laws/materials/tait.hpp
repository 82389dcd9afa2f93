// Tait's equation: nearly incompressible liquids.
#pragma once

#include <boltzmann/laws/material.hpp>

namespace boltzmann {

/// P = B [(rho / rho0)^gamma - 1] + background, B = rho0 c0^2 / gamma; c = c0 (rho / rho0)^((gamma - 1) / 2).
/// Barotropic: no temperature. Below the reference density the pressure falls below the background; for a liquid
/// without cohesion use another material.
struct Tait {
  double reference_density;        ///< rho0, where the pressure is the background
  double sound_speed;              ///< c0, at rho0
  double gamma = 7;                ///< 7 for water; 1: pressure linear in the density
  double background_pressure = 0;  ///< added everywhere

  static constexpr MaterialText text{
      .name = "tait",
      .doc = "a liquid that is hard to compress",
      .formula =
          "P = B [(rho / reference_density)^gamma - 1] + background_pressure, B = reference_density sound_speed^2 "
          "/ gamma"};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{
            &Tait::reference_density,
            {"reference_density", material_dimensions::density, "where the pressure is the background", positive}},
        ParameterOf{&Tait::sound_speed, {"sound_speed", dimensions::velocity, "at the reference density", positive}},
        ParameterOf{&Tait::gamma,
                    {"gamma", dimensions::none, "7 for water; 1: pressure linear in the density", positive, "7"}},
        ParameterOf{&Tait::background_pressure,
                    {"background_pressure", material_dimensions::pressure, "added everywhere", any_number, "0"}}};
  }

  double stiffness() const { return reference_density * square(sound_speed) / gamma; }  ///< B

  template <class P>
  State state(P const& p) const {
    double const x = p.density / reference_density, power = pow(x, gamma - 1);
    return {stiffness() * (x * power - 1) + background_pressure, 0, sound_speed * sqrt(power)};
  }
  /// The integral of P / rho^2 from rho0.
  double energy(double density) const {
    double const x = density / reference_density, b = stiffness();
    double const growth = gamma == 1 ? std::log(x) : std::expm1((gamma - 1) * std::log(x)) / (gamma - 1);
    return (b * growth + (b - background_pressure) * (1 - x) / x) / reference_density;
  }
};

}  // namespace boltzmann
