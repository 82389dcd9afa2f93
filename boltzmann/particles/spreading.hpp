// Spreading: vortices whose cores grow by viscosity.
#pragma once

#include <boltzmann/particles/vortex.hpp>

namespace boltzmann {

/// A vortex in a fluid of kinematic viscosity nu whose core grows, d(core^2)/dt = 2 nu. With the Gaussian core of
/// GaussianBiotSavart this is diffusion, exact for one element. Wide cores convect vorticity inaccurately (C.
/// Greengard, J. Comput. Phys. 61, 345 (1985)), so they have to be split (CoreSplitter).
template <int D, class Real = double>
struct Spreading : Inviscid<D, Real> {
  static constexpr char const* class_name = "Spreading";
  static constexpr bool random_walk = false;  // unlike other classes with a viscosity

  Real viscosity;

  static void equations(auto const& p, auto const& influence, auto const& rate) {
    Inviscid<D, Real>::equations(p, influence, rate);
    rate(&Spreading::core, p.viscosity / p.core);
  }

  static FieldTable fields() {
    return Inviscid<D, Real>::fields().add(&Spreading::viscosity, "viscosity",
                                           dimensions::length * dimensions::velocity, "kinematic viscosity");
  }
};

}  // namespace boltzmann
