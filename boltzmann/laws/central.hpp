// Central laws: what Morse, Rydberg and spring share.
#pragma once

#include <boltzmann/laws/interaction.hpp>

namespace boltzmann {

/// The distance of two particles and its inverse, which is zero for two particles at one place. By a root and a
/// division: the distance, which everything waits for, is there first.
template <class Real>
struct Distance {
  Real distance, inverse;
};
template <class Real>
Distance<Real> distance_of_square(Real const& square) {
  Real const distance = sqrt(square);
  return {distance, select(square > 0.0, Real(1.0 / distance), Real(0.0))};
}

/// The direction from p to q, and their distance; the direction of two particles at one place is zero.
template <int D, class Real>
struct Separation {
  Vector<D, Real> direction;
  Real distance;
};

template <class P, class Q>
auto separation(P const& p, Q const& q) {
  auto const r = q.position - p.position;
  auto const [distance, inverse] = distance_of_square(dot(r, r));
  return Separation<P::dimension, std::remove_cvref_t<decltype(distance)>>{r * inverse, distance};
}

}  // namespace boltzmann
