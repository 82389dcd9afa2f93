// Helpers for central laws, such as Rydberg and spring.
#pragma once

#include <boltzmann/laws/interaction.hpp>

namespace boltzmann {

/// The direction from p to q, and their distance; the direction of two coincident particles is zero.
template <int D, class Real>
struct Separation {
  Vector<D, Real> direction;
  Real distance;
};

template <class P, class Q>
auto separation(P const& p, Q const& q) {
  auto const r = q.position - p.position;
  auto const square = dot(r, r);
  using Real = std::remove_cvref_t<decltype(square)>;
  Real const distance = sqrt(square);  // by a root and a division: the shortest chain of operations
  Real const inverse = select(square > 0.0, Real(1.0 / distance), Real(0.0));
  return Separation<P::dimension, Real>{r * inverse, distance};
}

}  // namespace boltzmann
