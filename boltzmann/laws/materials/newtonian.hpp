// Newton's viscosity and Fourier's conduction, added to any material.
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/material.hpp>

namespace boltzmann {

/// Adds to the pressure tensor -2 shear_viscosity (E - (div v / D) I) - bulk_viscosity (div v) I, E the symmetric part
/// of the velocity gradient, and the heat flux -conductivity grad T. The trace is divided by the number of dimensions
/// D, as in Hoover's texts: in 2D lambda = bulk - shear, and only the bulk viscosity resists a uniform expansion in the
/// plane. (For a slice of a three-dimensional fluid in 2D, whose lambda is bulk - 2/3 shear, add shear_viscosity / 3 to
/// the bulk viscosity.)
///
/// The contributions of the underlying material (the strength of a solid) are kept. A barotropic one stays barotropic:
/// energy that viscosity removes from the motion is then lost, as if to a bath.
template <class EquationOfState>
struct Newtonian {
  EquationOfState material;
  double shear_viscosity = 0;
  double bulk_viscosity = 0;
  double conductivity = 0;

  static constexpr MaterialText text{.name = "newtonian",
                                     .doc = "viscosity and conduction, on any material",
                                     .formula = "-2 eta (E - (div v / D) I) - zeta (div v) I, Q = -kappa grad T"};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&Newtonian::shear_viscosity,
                    {"shear_viscosity", material_dimensions::viscosity, "against shear", not_negative, "0"}},
        ParameterOf{&Newtonian::bulk_viscosity,
                    {"bulk_viscosity", material_dimensions::viscosity, "against compression", not_negative, "0"}},
        ParameterOf{&Newtonian::conductivity,
                    {"conductivity", material_dimensions::heat_conductivity,
                     "of heat; needs a material with a temperature", not_negative, "0"}}};
  }

  template <class P>
  State state(P const& p) const {
    return material.state(p);
  }

  template <class P>
  TransportCoefficients transport(P const&) const {
    static_assert(!has_transport<EquationOfState, P>, "one viscosity: Newtonian goes outside");
    return {shear_viscosity, bulk_viscosity, conductivity};
  }
  bool conducts() const { return conductivity > 0; }
  template <class P>
  Fluxes<P::dimension> fluxes(P const& p,
                              Gradients<P::dimension> const& gradients) const requires has_fluxes<EquationOfState, P> {
    return material.fluxes(p, gradients);
  }

  /// The largest of: shear_viscosity / rho, of vortices; (bulk_viscosity + 2 (1 - 1/D) shear_viscosity) / rho, of
  /// sound; 2 conductivity / (rho cv), of heat, whose shortest waves are damped twice as fast by the pair form
  /// (Transport).
  template <class P>
  double diffusivity(P const& p) const {
    constexpr double flattening = 2 - 2.0 / P::dimension;
    double largest = max(shear_viscosity, bulk_viscosity + flattening * shear_viscosity);
    if constexpr (has_specific_heat) largest = max(largest, 2 * conductivity / material.specific_heat());
    double below = 0;
    if constexpr (requires { material.diffusivity(p); }) below = material.diffusivity(p);
    return largest / p.density + below;
  }

  template <class P>
  void rates(P const& p, Gradients<P::dimension> const& gradients,
             typename P::Influence& influence) const requires has_rates<EquationOfState, P> {
    material.rates(p, gradients, influence);
  }
  template <class P>
  double shear_stiffness(P const& p) const requires requires(EquationOfState const& m) {
    m.shear_stiffness(p);
  }
  { return material.shear_stiffness(p); }
  double energy(double density) const requires is_barotropic<EquationOfState> { return material.energy(density); }
  double specific_heat() const requires requires(EquationOfState const& m) { m.specific_heat(); }
  { return material.specific_heat(); }

  void check() const {
    check_parameters(material);
    if (!has_specific_heat && conductivity > 0)
      throw Error("newtonian: a conductivity needs a material with a temperature and a specific_heat()");
  }

 private:
  static constexpr bool has_specific_heat = requires(EquationOfState const& m) { m.specific_heat(); };
};

}  // namespace boltzmann
