// Gases of constant, uniform entropy: the pressure is a function of the density alone.
#pragma once

#include <boltzmann/laws/material.hpp>

namespace boltzmann {

/// P = constant rho^gamma, e = constant rho^(gamma - 1) / (gamma - 1), c^2 = gamma P / rho. Barotropic: no temperature.
struct IsentropicGas {
  double constant;
  double gamma;

  static constexpr MaterialText text{.name = "isentropic-gas",
                                     .doc = "an ideal gas whose entropy is the same everywhere and always",
                                     .formula = "P = constant rho^gamma, e = constant rho^(gamma - 1) / (gamma - 1)"};
  static constexpr auto parameters() {
    return std::tuple{ParameterOf{&IsentropicGas::constant,
                                  {"constant", dimensions::none,
                                   "pressure / density^gamma, a number in the simulation's units", positive}},
                      ParameterOf{&IsentropicGas::gamma, gamma_parameter}};
  }

  template <class P>
  State state(P const& p) const {
    double const push = constant * pow(p.density, gamma - 1);  // P / rho
    return {p.density * push, 0, sqrt(gamma * push)};
  }
  double energy(double density) const { return constant * pow(density, gamma - 1) / (gamma - 1); }
};

/// P = coefficient rho^2, e = coefficient rho, c^2 = 2 coefficient rho: the isentrope of the two-dimensional ideal gas,
/// "P = rho^2 / 2" in Hoover and Hoover's SPAM. Its smooth particles behave like atoms, with their weight as the pair
/// potential (Eq 20).
struct QuadraticGas {
  double coefficient = 0.5;

  static constexpr MaterialText text{
      .name = "quadratic-gas",
      .doc =
          "a gas whose smooth particles are atoms with their weight as potential; the isentrope of the ideal gas in 2D",
      .formula = "P = coefficient rho^2, e = coefficient rho"};
  static constexpr auto parameters() {
    return std::tuple{ParameterOf{&QuadraticGas::coefficient,
                                  {"coefficient", material_dimensions::pressure_by_density2,
                                   "pressure by the square of the density", positive, "0.5", DefaultIn::reduced}}};
  }

  template <class P>
  State state(P const& p) const {
    return {coefficient * square(p.density), 0, sqrt(2 * coefficient * p.density)};
  }
  double energy(double density) const { return coefficient * density; }
  double pressure_by_density2() const { return coefficient; }
};

}  // namespace boltzmann
