// Vortex, Inviscid, Viscous, Diffusive: elements of vorticity that carry each other along (section 3.7).
#pragma once

#include <boltzmann/particles/tracer.hpp>

namespace boltzmann {

/// The influence on a vortex in 3D: a velocity, and the rate at which its vorticity is stretched and turned.
template <class Real>
struct VortexInfluence {
  Vector<3, Real> velocity;
  Vector<3, Real> stretching;
};

/// The influence on a Diffusive vortex in 2D: a velocity, and the rate at which its circulation changes.
template <class Real>
struct ExchangeInfluence {
  Vector<2, Real> velocity;
  Vector<1, Real> exchange;
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

/// A vortex in a fluid of kinematic viscosity nu. Besides moving with the flow it takes a random walk (Eq 3.13), which
/// the integrator adds.
template <int D, class Real = double>
struct Viscous : Inviscid<D, Real> {
  static constexpr char const* class_name = "Viscous";

  Real viscosity;

  static FieldTable fields() {
    return Inviscid<D, Real>::fields().add(&Viscous::viscosity, "viscosity", dimensions::length * dimensions::velocity,
                                           "kinematic viscosity");
  }
};

namespace detail {

/// The difference between a Diffusive and an Inviscid vortex: in 2D its circulation changes; in 3D the vorticity
/// already does.
template <int D, class Real>
struct Exchanging : Inviscid<D, Real> {};

template <class Real>
struct Exchanging<2, Real> : Inviscid<2, Real> {
  using Influence = ExchangeInfluence<Real>;

  static void equations(auto const& p, auto const& influence, auto const& rate) {
    Inviscid<2, Real>::equations(p, influence.velocity, rate);
    rate(&Exchanging::vorticity, influence.exchange);
  }
};

}  // namespace detail

/// A vortex in a fluid of kinematic viscosity nu that moves with the flow. It exchanges vorticity with its neighbours
/// by the law VorticityExchange, which needs the volume that the vortex represents.
template <int D, class Real = double>
struct Diffusive : detail::Exchanging<D, Real> {
  static constexpr char const* class_name = "Diffusive";
  static constexpr bool random_walk = false;  // unlike other classes with a viscosity

  Real viscosity, volume;

  static FieldTable fields() {
    return detail::Exchanging<D, Real>::fields()
        .add(&Diffusive::viscosity, "viscosity", dimensions::length * dimensions::velocity, "kinematic viscosity")
        .add(&Diffusive::volume, "volume", pow(dimensions::length, D),
             D == 2 ? "area of fluid that it stands for" : "volume of fluid that it stands for");
  }
};

}  // namespace boltzmann
