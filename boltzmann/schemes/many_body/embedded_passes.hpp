// The passes over pairs for embedded atoms: densities, then forces. Each is a law: the contribution of q to p. Both
// compute the addresses of a pair's splines ahead of their use (over_near.hpp).
#pragma once

#include <boltzmann/laws/embedded_tables.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/schemes/many_body/atom_point.hpp>

#include <array>
#include <bit>
#include <cstdint>
#include <type_traits>

namespace boltzmann {

template <class Real>
struct AtomDensity {
  Real density;
};
template <class Real>
AtomDensity(Real) -> AtomDensity<Real>;

/// The location of a pair's spline coefficients.
template <class Real>
struct SplinePlace {
  Real square;  ///< distance squared
  Real past;    ///< distance from the knot
  Real offset;  ///< offset of the coefficients, an integer
};

/// A neighbour as seen from an atom.
template <int D, class Real = double>
struct SeenAtom : Particle<D, Real> {
  Real slope;                 ///< of both atoms; in an alloy, of the neighbour
  Real square, past, offset;  ///< as in SplinePlace
};

namespace detail {

template <class P>
using real_of = std::remove_cvref_t<decltype(std::declval<P>().position[0])>;

/// With `alloy`, the elements of the pair select the splines.
template <bool alloy, class P, class Place>
[[gnu::always_inline]] inline void find_splines(EmbeddedTables const& tables, P const& p, P const& q, Place& place) {
  using Real = real_of<P>;
  constexpr int W = Real::width;
  place.square = norm2(q.position - p.position);
  auto const row = tables.knots.row(tables.knots.inside(place.square));
  place.past = place.square - tables.knots.template knot<W>(row);
  auto offset = (row - tables.knots.first_row) << (alloy ? 4 : 3);
  if constexpr (alloy) {
    // The elements of sentinel rows are not numbers; lanes with them are masked.
    Real const pair = p.element * static_cast<double>(tables.elements) + q.element;
    Real const known = select(pair == pair, pair, Real(0.0));
    offset += __builtin_convertvector(known.native, Bits<W>) * tables.pair_stride;
  }
  place.offset = from_bits<W>(offset);
}

/// Loads four coefficients of the splines.
template <class Place>
[[gnu::always_inline]] inline auto coefficients(EmbeddedTables const& tables, Place const& place, int block) {
  using Real = std::remove_cvref_t<decltype(place.offset)>;
  constexpr int W = Real::width;
  std::array<Real, 4> c;
  auto const row = [&](int lane) {
    std::int64_t offset;
    __builtin_memcpy(&offset,
                     reinterpret_cast<char const*>(&place.offset) + sizeof(offset) * static_cast<unsigned>(lane),
                     sizeof(offset));
    return tables.rows + offset;
  };
  transpose_block<W>(row, static_cast<std::size_t>(4 * block), c.data(), 4);
  return c;
}

}  // namespace detail

/// rho_i = sum_j rho(r_ij).
template <bool alloy>
struct DensityOfAtoms {
  EmbeddedTables known;
  static constexpr bool looks_ahead = true;
  template <int D>
  using Seen = SplinePlace<double>;

  template <class P>
  [[gnu::always_inline]] void look(P const& p, P const& q, SplinePlace<detail::real_of<P>>& seen) const {
    detail::find_splines<alloy>(known, p, q, seen);
  }
  template <class P, class Real>
  auto operator()(P const&, SplinePlace<Real> const& q) const {
    auto const c = detail::coefficients(known, q, 0);
    return AtomDensity{c[0] + q.past * (c[1] + q.past * (c[2] + q.past * c[3]))};
  }
};

/// dE/d(r^2) = dV/d(r^2) + F_i' d rho_j(r)/d(r^2) + F_j' d rho_i(r)/d(r^2).
template <bool alloy>
struct ForceOnAtoms {
  EmbeddedTables known;
  static constexpr bool looks_ahead = true;
  template <int D>
  using Seen = SeenAtom<D>;

  template <class P>
  [[gnu::always_inline]] void look(P const& p, P const& q, SeenAtom<P::dimension, detail::real_of<P>>& seen) const {
    auto const r = q.position - p.position;
    for (int a = 0; a < P::dimension; ++a) seen.position[a] = r[a];
    if constexpr (alloy)
      seen.slope.native = q.slope.native;  // a Pack would be copied through memory
    else
      seen.slope = p.slope + q.slope;
    detail::find_splines<alloy>(known, p, q, seen);
  }
  template <class P, int D, class Real>
  auto operator()(P const& p, SeenAtom<D, Real> const& q) const {
    auto const pair = detail::coefficients(known, q, 1), density = detail::coefficients(known, q, 0);
    std::array<Real, 4> of_q{};
    if constexpr (alloy) of_q = detail::coefficients(known, q, 2);
    auto const sum = [&](std::size_t k) {
      if constexpr (alloy)
        return pair[k] + p.slope * density[k] + q.slope * of_q[k];
      else
        return pair[k] + q.slope * density[k];
    };
    Real const d = q.past;
    Real const slope = sum(1) + d * (2.0 * sum(2) + d * (3.0 * sum(3)));
    return Interaction{q.position * (2.0 * slope), pair[0] + d * (pair[1] + d * (pair[2] + d * pair[3]))};
  }
};

}  // namespace boltzmann
