// Vortex, Inviscid, Viscous: elements of vorticity that carry each other along (section 3.7).
#pragma once

#include <boltzmann/particles/tracer.hpp>

namespace boltzmann {

/// What vortices do to a vortex in 3D: a velocity, and the rate at which its vorticity is stretched and turned.
template <class Real>
struct VortexInfluence {
  Vector<3, Real> velocity;
  Vector<3, Real> stretching;
};

/// An element of vorticity: in 2D one component out of the plane (the circulation), in 3D the vector vorticity times
/// volume. `core` is the radius inside which its velocity field is regularised.
template <int D, class Real = double>
struct Vortex : Tracer<D, Real> {
  static_assert(D == 2 || D == 3, "a vortex lives in 2D or 3D: there is no vorticity in 1D");
  static constexpr char const* class_name = "Vortex";

  Vector<cross_dimension<D>, Real> vorticity;
  Real core;

  static FieldTable fields() {
    return Tracer<D, Real>::fields()
        .add(&Vortex::vorticity, "vorticity",
             D == 2 ? dimensions::circulation : dimensions::length * dimensions::circulation,
             D == 2 ? "circulation" : "vorticity times volume")
        .add(&Vortex::core, "core", dimensions::length, "radius of the regularised core");
  }
};

/// A vortex without viscosity. In 3D the flow stretches its vorticity (Eq 3.14): d(omega)/dt = (omega . grad) v.
template <int D, class Real = double>
struct Inviscid : Vortex<D, Real> {
  static constexpr char const* class_name = "Inviscid";
};

template <class Real>
struct Inviscid<3, Real> : Vortex<3, Real> {
  static constexpr char const* class_name = "Inviscid";
  using Influence = VortexInfluence<Real>;

  static void equations(auto const& p, auto const& influence, auto const& rate) {
    Vortex<3, Real>::equations(p, influence.velocity, rate);
    rate(&Inviscid::vorticity, influence.stretching);
  }
};

/// A vortex in a fluid of kinematic viscosity nu: besides the flow it takes a random walk (Eq 3.13), which the
/// integrator adds.
template <int D, class Real = double>
struct Viscous : Inviscid<D, Real> {
  static constexpr char const* class_name = "Viscous";

  Real viscosity;

  static FieldTable fields() {
    return Inviscid<D, Real>::fields().add(&Viscous::viscosity, "viscosity", dimensions::length * dimensions::velocity,
                                           "kinematic viscosity");
  }
};

}  // namespace boltzmann
