// The result of a law, and what a law declares about itself.
#pragma once

#include <boltzmann/core/vector.hpp>

#include <type_traits>

namespace boltzmann {

/// Influence and energy of one pair (or of one particle in an external field), computed together: the physics is
/// written once, and the compiler removes the energy if only the force is needed. A law is a function law(p, q) of two
/// particles that returns the influence of q on p: a vector, an Interaction, or any struct of Real.
template <int D, class Real>
struct Interaction {
  Vector<D, Real> force;  ///< on p
  Real energy;            ///< of the pair, zero at infinite distance unless the law defines another zero
};
template <int D, class Real>
Interaction(Vector<D, Real>, Real) -> Interaction<D, Real>;

/// Rejects members in the wrong order.
template <int D, class Real>
requires(D < 0) struct Interaction<D, Real> {
  static_assert(D > 0, "an Interaction is {force, energy}, in this order");
  Real energy;
  Vector<-D, Real> force;
};
template <int D, class Real>
Interaction(Real, Vector<D, Real>) -> Interaction<-D, Real>;

/// The relation between law(p, q) and law(q, p). A law declares it by `static constexpr Symmetry symmetry`; the default
/// is general.
enum class Symmetry {
  general,        ///< each is computed separately (the generalised forces of the coupled pendulums)
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

/// True for a law whose influence depends on velocities; time-reversible integration refuses it.
template <class Law>
constexpr bool depends_on_velocity() {
  if constexpr (requires { Law::velocity_dependent; })
    return Law::velocity_dependent;
  else
    return false;
}

/// True for an external law whose influence does not depend on the position: a uniform field.
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

/// The length over which a law changes by its own size; particles should not move further in one step. Infinite if
/// unknown.
template <class Law>
double length_scale_of(Law const& law) {
  if constexpr (requires { law.length_scale(); })
    return law.length_scale();
  else
    return __builtin_inf();
}

}  // namespace boltzmann
