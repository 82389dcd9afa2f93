// The passes over pairs for Stillinger-Weber atoms. Their three-body energy is a function of sums over the bonds of
// each atom. With g_j the weight of bond j and u_j its direction,
//   sum_{j<k} g_j g_k (u_j.u_k - c)^2 = 1/2 (Q:Q - 2 c P.P + c^2 G^2 - (1 - c)^2 sum_j g_j^2), G = sum g, P = sum g u,
//   Q = sum g u u.
// So the first pass computes these sums, and a second pass over pairs computes forces. No loop over triples is needed.
#pragma once

#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/stillinger_weber.hpp>
#include <boltzmann/schemes/many_body/atom_point.hpp>

namespace boltzmann {

template <int D, class Real>
struct BondSums {
  Real weight;
  Vector<D, Real> lean;
  Real spread[D * (D + 1) / 2];
  Real squares;  ///< sum g^2
};

namespace detail {

/// A symmetric tensor, stored as its upper half row by row, times a vector.
template <int D, class Real>
[[gnu::always_inline]] inline Vector<D, Real> upper_times(Real const* upper, Vector<D, Real> const& u) {
  Vector<D, Real> result;
  for (int a = 0; a < D; ++a) result[a] = Real(0.0);
  int next = 0;
  for (int a = 0; a < D; ++a)
    for (int b = a; b < D; ++b, ++next) {
      result[a] += upper[next] * u[b];
      if (b != a) result[b] += upper[next] * u[a];
    }
  return result;
}

}  // namespace detail

struct SumsOfBonds {
  StillingerWeber known;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    using Real = std::remove_cvref_t<decltype(p.position[0])>;
    constexpr int D = P::dimension;
    auto const r = q.position - p.position;
    Real const inverse = rsqrt(dot(r, r));
    Vector<D, Real> const u = r * inverse;
    Real const g = known.bond(dot(r, r) * inverse).value;
    BondSums<D, Real> sums;
    sums.weight = g;
    sums.lean = u * g;
    int next = 0;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b, ++next) sums.spread[next] = g * u[a] * u[b];
    sums.squares = g * g;
    return sums;
  }
};

struct ForceOnBonds {
  StillingerWeber known;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    using Real = std::remove_cvref_t<decltype(p.position[0])>;
    constexpr int D = P::dimension;
    double const c = known.cosine;
    auto const r = q.position - p.position;
    Real const inverse = rsqrt(dot(r, r)), distance = dot(r, r) * inverse;
    Vector<D, Real> const u = r * inverse;
    auto const pair = known.pair(distance);
    auto const bond = known.bond(distance);
    // Sum for both centres, whose bonds are u and -u.
    Real spread[D * (D + 1) / 2];
    for (int k = 0; k < D * (D + 1) / 2; ++k) spread[k] = p.spread[k] + q.spread[k];
    Vector<D, Real> const lean = (p.lean - q.lean) * c;
    Vector<D, Real> const turn = detail::upper_times<D, Real>(spread, u) - lean;
    Real const along = dot(turn, u);
    Real const stretch = along - dot(lean, u) + c * c * (p.weight + q.weight) - 2.0 * (1 - c) * (1 - c) * bond.value;
    double const strength = known.lambda * known.epsilon;
    return Interaction{u * (pair.slope + strength * bond.slope * stretch) +
                           (turn - u * along) * (2.0 * strength * bond.value * inverse),
                       pair.value};
  }
};

}  // namespace boltzmann
