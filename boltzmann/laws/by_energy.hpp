// Laws by energy: you write the energy of a pair, and the force follows by automatic differentiation.
#pragma once

#include <boltzmann/core/dual.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <type_traits>

namespace boltzmann {

namespace detail {

enum class PairEnd { target, source };

/// The position of one end of a pair. An energy may only subtract it from the other end's position.
template <int D, class Real, PairEnd end>
struct EndPosition {
  Vector<D, Real> at;

  template <class Index>
  Real operator[](Index) const {
    static_assert(std::is_same_v<Index, void>,
                  "by_energy: the energy of a pair depends on positions through q.position - p.position only");
    return at[0];
  }
};
template <int D, class Real>
Displacement<D, Real> operator-(EndPosition<D, Real, PairEnd::source> const& q,
                                EndPosition<D, Real, PairEnd::target> const& p) {
  return {q.at - p.at, Real(1.0)};
}
template <int D, class Real>
Displacement<D, Real> operator-(EndPosition<D, Real, PairEnd::target> const& p,
                                EndPosition<D, Real, PairEnd::source> const& q) {
  return {q.at - p.at, Real(-1.0)};
}

/// A particle of which only the position carries derivatives: this member shadows that of its class.
template <class P, PairEnd end>
struct Seeded : P {
  EndPosition<P::dimension, std::remove_cvref_t<decltype(std::declval<P const&>().position[0])>, end> position;
};
template <PairEnd end, class P>
Seeded<P, end> seeded(P const& p) {
  return {p, {p.position}};
}

}  // namespace detail

/// A pair law made of an energy; see by_energy().
template <class Energy>
struct ByEnergy {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;

  Energy of_pair;

  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    using detail::PairEnd;
    auto const energy = of_pair(detail::seeded<PairEnd::target>(p), detail::seeded<PairEnd::source>(q));
    static_assert(detail::AnyDual<std::remove_cv_t<decltype(energy)>>,
                  "by_energy: the function must return the energy of the pair, one number that depends on q.position - "
                  "p.position; write it as [=](auto const& p, auto const& q) { ... }");
    auto const r = q.position - p.position;
    auto const along = 2.0 * energy.derivative.slope;
    if constexpr (requires { energy.derivative.rest; })
      return Interaction{r * along + energy.derivative.rest, energy.value};
    else
      return Interaction{r * along, energy.value};
  }

  double length_scale() const { return length_scale_of(of_pair); }
  void check() const { check_parameters(of_pair); }
};

/// The pair law whose energy is `energy(p, q)`: it returns Interaction{force, energy} with force on p =
/// -dU/d(p.position), exactly. Like every law the function is generic (`auto const&`) and is called with packs and with
/// single particles, in 1D, 2D and 3D, with any class. It may use all fields of the particles, and the positions
/// through `q.position - p.position` (the minus sign, dot products, components, cross products, sums with other
/// vectors...). An energy of dot(r, r), norm2(r) or magnitude(r) costs one more multiply-add per operation than the
/// energy itself; one that uses components or directions of r costs D more. The energy must be the same when p and q
/// are exchanged. (Member functions of the particle class use the plain position; their results count as constant.) If
/// the energy is a function of magnitude(r), two coincident particles exert no force on each other.
template <class Energy>
ByEnergy<Energy> by_energy(Energy energy) {
  return {energy};
}

}  // namespace boltzmann
