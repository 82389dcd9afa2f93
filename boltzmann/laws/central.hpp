// Central laws: what Rydberg and spring share.
#pragma once

#include <boltzmann/laws/interaction.hpp>

namespace boltzmann {

/// The direction from p to q, and their distance; the direction of two particles at one place is zero.
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
  Real const distance = sqrt(square);  // by a root and a division: what everything waits for is there first
  Real const inverse = select(square > 0.0, Real(1.0 / distance), Real(0.0));
  return Separation<P::dimension, Real>{r * inverse, distance};
}

}  // namespace boltzmann
