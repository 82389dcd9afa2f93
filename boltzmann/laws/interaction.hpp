// What a law returns, and what a law may say about itself.
#pragma once

#include <boltzmann/core/vector.hpp>

#include <type_traits>

namespace boltzmann {

/// Influence and energy of one pair (or of one particle in an external field), computed together: the physics is
/// written once, and where only the force is wanted the compiler drops the energy. A law is a function law(p, q) of two
/// particles that returns the influence of q on p: a vector, an Interaction, or any struct of Real.
template <int D, class Real>
struct Interaction {
  Vector<D, Real> force;  ///< on p
  Real energy;            ///< of the pair, zero at infinite distance (or where the law says)
};
template <int D, class Real>
Interaction(Vector<D, Real>, Real) -> Interaction<D, Real>;

/// Of members in the wrong order.
template <int D, class Real>
requires(D < 0) struct Interaction<D, Real> {
  static_assert(D > 0, "an Interaction is {force, energy}, in this order");
  Real energy;
  Vector<-D, Real> force;
};
template <int D, class Real>
Interaction(Real, Vector<D, Real>) -> Interaction<-D, Real>;

/// How law(p, q) and law(q, p) are related. A law says so by `static constexpr Symmetry symmetry`; one that says
/// nothing is general.
enum class Symmetry {
  general,        ///< each is computed by itself (the generalised forces of the coupled pendulums)
  antisymmetric,  ///< Newton's third law: law(q, p) = -law(p, q)
  one_way,        ///< q influences p, p does not influence q (vortices carry test particles)
};

template <class Law>
constexpr Symmetry symmetry_of() {
  if constexpr (requires { Law::symmetry; })
    return Law::symmetry;
  else
    return Symmetry::general;
}

/// True for a law whose influence depends on velocities: time-reversible integration refuses it.
template <class Law>
constexpr bool depends_on_velocity() {
  if constexpr (requires { Law::velocity_dependent; })
    return Law::velocity_dependent;
  else
    return false;
}

/// True for an external law whose influence is the same wherever a particle is: a uniform field.
template <class Law>
constexpr bool is_uniform() {
  if constexpr (requires { Law::uniform; })
    return Law::uniform;
  else
    return false;
}

namespace detail {
template <class Law, Symmetry s>
struct Declared : Law {
  static constexpr Symmetry symmetry = s;
};
}  // namespace detail

/// Declares a lambda to obey Newton's third law.
template <class Law>
auto antisymmetric(Law law) {
  return detail::Declared<Law, Symmetry::antisymmetric>{law};
}
/// Declares a lambda to act on the first ensemble only.
template <class Law>
auto one_way(Law law) {
  return detail::Declared<Law, Symmetry::one_way>{law};
}

/// The length over which a law changes by its own size: a particle that moves further in one step has not seen it.
/// Infinite if unknown.
template <class Law>
double length_scale_of(Law const& law) {
  if constexpr (requires { law.length_scale(); })
    return law.length_scale();
  else
    return __builtin_inf();
}

}  // namespace boltzmann
