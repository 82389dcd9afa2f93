// Materials: constitutive relations of smooth particles: pressure and fluxes from density, energy and gradients.
#pragma once

#include <boltzmann/core/tensor.hpp>
#include <boltzmann/laws/parameter.hpp>
#include <boltzmann/particles/smooth.hpp>

#include <concepts>

namespace boltzmann {

/// The state of a particle by the equation of state.
struct State {
  double pressure = 0;
  double temperature = 0;
  double sound_speed = 0;
};

/// The gradients at a particle (Eq 18, 19): velocity[a][b] = d v_b / d x_a, temperature[a] = dT / d x_a.
template <int D>
struct Gradients {
  Tensor<D> velocity;
  Vector<D> temperature;
};

/// The fluxes of momentum and heat in the frame of the particle, beyond the pressure of its state.
template <int D>
struct Fluxes {
  Tensor<D> pressure;  ///< added to the pressure tensor; symmetric
  Vector<D> heat;      ///< Q of Eq 3
};

/// Newton's viscosity and Fourier's conduction. The trace is divided by the number of dimensions D: the stress is 2
/// shear_viscosity (E - (div v / D) I) + bulk_viscosity (div v) I, E the symmetric part of the velocity gradient; the
/// heat flux is -conductivity grad T.
struct TransportCoefficients {
  double shear_viscosity = 0;
  double bulk_viscosity = 0;
  double conductivity = 0;
};

// A material is a plain struct with some of these functions of one particle p (of the user's class, doubles):
//
//   State state(p)                       needed: pressure, temperature, sound speed from p.density, p.specific_energy
//   TransportCoefficients transport(p)               viscosity and conduction
//   bool conducts()                      false: the conductivity is always zero
//   Fluxes<D> fluxes(p, gradients)       strength, and other stress that is no Newtonian viscosity. Gradients do not
//   see
//                                        velocities that alternate from particle to particle, so such a stress does not
//                                        damp them
//   double diffusivity(p)                of momentum or twice that of heat, the larger, in length^2 / time: limits the
//                                        step; with transport or fluxes
//   void rates(p, gradients, influence)  rates of further fields of p's class (the stress of a solid)
//   double shear_stiffness(p)            shear modulus that is left, for the hourglass control of solids
//   double energy(density)               barotropic: the specific energy is this function of the density, and does not
//                                        evolve
//   double pressure_by_density2()        P / rho^2 where it is the same for all particles always (P = rho^2 / 2):
//   forces
//                                        then need no density
//   text, parameters()                   what it is and what its parameters may be (laws/parameter.hpp), for scenarios
//   void check()                         Error if they don't go together

namespace material_dimensions {
inline constexpr DimensionBySpace density{dimensions::mass, -1}, pressure{dimensions::energy, -1},
    viscosity{dimensions::energy * dimensions::time, -1},
    heat_conductivity{dimensions::energy * pow(dimensions::length, 2) / (dimensions::time * dimensions::temperature),
                      -1},
    pressure_by_density2{dimensions::energy / pow(dimensions::mass, 2), 1},
    volume_by_mass{dimensions::none / dimensions::mass, 1};
}
inline constexpr Parameter specific_heat_parameter{
    "specific_heat",   dimensions::specific_heat, "at constant volume, energy by mass and temperature", positive, "1",
    DefaultIn::reduced};
inline constexpr Parameter gamma_parameter{"gamma", dimensions::none, "ratio of the specific heats", above(1)};

template <class M, class P>
concept Material = requires(M const& material, P const& p) {
  { material.state(p) } -> std::convertible_to<State>;
};
template <class M, class P>
inline constexpr bool has_fluxes = requires(M const& material, P const& p, Gradients<P::dimension> const& gradients) {
  material.fluxes(p, gradients);
};
template <class M, class P>
inline constexpr bool has_transport = requires(M const& material, P const& p) {
  { material.transport(p) } -> std::convertible_to<TransportCoefficients>;
};
template <class M, class P>
inline constexpr bool has_rates = requires(M const& material, P const& p, Gradients<P::dimension> const& gradients,
                                           typename P::Influence& influence) {
  material.rates(p, gradients, influence);
};
template <class M>
inline constexpr bool is_barotropic = requires(M const& material) {
  material.energy(1.0);
};
template <class M>
inline constexpr bool has_constant_push = requires(M const& material) {
  material.pressure_by_density2();
};

}  // namespace boltzmann
