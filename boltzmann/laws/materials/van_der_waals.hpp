// Van der Waals' fluid: gas and liquid in one equation.
#pragma once

#include <boltzmann/laws/material.hpp>

#include <limits>

namespace boltzmann {

/// With k = Boltzmann's constant / mass of a molecule and f degrees of freedom of a molecule:
/// e = (f/2) k T - a rho, P = rho k T / (1 - b rho) - a rho^2, c^2 = (1 + 2/f) k T / (1 - b rho)^2 - 2 a rho.
/// Critical point: rho = 1 / 3b, k T = 8a / 27b, P = a / 27b^2. Where c^2 is negative, gas and liquid separate; the
/// sound speed is then sqrt(|c^2|): ripples grow at the rate at which they would propagate. At rho >= 1/b there is no
/// such fluid: the pressure is NaN, which ends a run with a message that names the particle.
struct VanDerWaals {
  double a;         ///< attraction: pressure / density^2
  double b;         ///< volume of the molecules, per mass
  double k_over_m;  ///< Boltzmann's constant / mass of a molecule
  double degrees_of_freedom;

  static constexpr MaterialText text{
      .name = "van-der-waals",
      .doc = "gas and liquid in one equation",
      .formula = "P = rho k T / (1 - b rho) - a rho^2, e = (f/2) k T - a rho; k = k_over_m, f = degrees_of_freedom"};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&VanDerWaals::a,
                    {"a", material_dimensions::pressure_by_density2,
                     "attraction: pressure by the square of the density", not_negative}},
        ParameterOf{&VanDerWaals::b,
                    {"b", material_dimensions::volume_by_mass, "volume that molecules take, by mass", not_negative}},
        ParameterOf{
            &VanDerWaals::k_over_m,
            {"k_over_m", dimensions::specific_heat, "Boltzmann's constant by the mass of a molecule", positive}},
        ParameterOf{&VanDerWaals::degrees_of_freedom,
                    {"degrees_of_freedom", dimensions::none, "f, of a molecule", positive}}};
  }

  template <class P>
  State state(P const& p) const {
    double const free = 1 - b * p.density;                                                // free fraction of the volume
    double const thermal = 2 / degrees_of_freedom * (p.specific_energy + a * p.density);  // k T
    if (!(free > 0)) {
      constexpr double none = std::numeric_limits<double>::quiet_NaN();
      return {none, thermal / k_over_m, none};
    }
    double const square_of_speed = (1 + 2 / degrees_of_freedom) * thermal / square(free) - 2 * a * p.density;
    return {p.density * thermal / free - a * square(p.density), thermal / k_over_m, sqrt(abs(square_of_speed))};
  }
  double specific_heat() const { return degrees_of_freedom / 2 * k_over_m; }
  /// The specific energy at that density and temperature: for initial states.
  double energy_at(double density, double temperature) const { return specific_heat() * temperature - a * density; }
};

}  // namespace boltzmann
