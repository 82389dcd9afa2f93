// The passes of embedded atoms over pairs: densities, then forces. Each is a law: what q contributes to p.
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

namespace detail {

/// Where the splines of W pairs stand.
template <int W>
class SplinesAt {
 public:
  using Real = Pack<double, W>;

  /// `alloy`: the elements of the pair choose among those of all.
  template <bool alloy, class P>
  [[gnu::always_inline]] static inline SplinesAt of(EmbeddedTables const& tables, P const& p, P const& q,
                                                    Real const& square) {
    Real const inside = tables.knots.inside(square);
    auto const row = tables.knots.row(inside);
    SplinesAt result;
    result.rows_ = tables.rows;
    result.past_ = inside - tables.knots.template knot<W>(row);
    result.before_ = min(square - tables.knots.least, Real(0.0));
    if constexpr (alloy) {
      // Elements of the sentinel are no numbers; what they would choose is masked.
      Real const pair = p.element * static_cast<double>(tables.elements) + q.element;
      Real const known = select(pair == pair, pair, Real(0.0));
      auto const number = __builtin_convertvector(known.native, Bits<W>);
      result.offsets_ = std::bit_cast<std::array<std::int64_t, W>>(((row - tables.knots.first_row) << 4) +
                                                                   number * tables.pair_stride);
    } else {
      result.offsets_ = std::bit_cast<std::array<std::int64_t, W>>((row - tables.knots.first_row) << 3);
    }
    return result;
  }

  struct Value {
    Real value, slope;  ///< and d/d(r^2)
  };
  [[gnu::always_inline]] inline Value value(int block) const {
    auto const c = coefficients(block);
    Real const slope = c[1] + past_ * (2.0 * c[2] + past_ * (3.0 * c[3]));
    return {c[0] + past_ * (c[1] + past_ * (c[2] + past_ * c[3])) + before_ * slope, slope};
  }

 private:
  [[gnu::always_inline]] inline std::array<Real, 4> coefficients(int block) const {
    std::array<Real, 4> c;
    transpose_block<W>([&](int lane) { return rows_ + offsets_[static_cast<std::size_t>(lane)]; },
                       static_cast<std::size_t>(4 * block), c.data(), 4);
    return c;
  }

  double const* rows_;
  Real past_, before_;
  std::array<std::int64_t, W> offsets_;
};

template <class P>
using width_of = std::integral_constant<int, std::remove_cvref_t<decltype(std::declval<P>().position[0])>::width>;

}  // namespace detail

/// rho_i = sum_j rho(r_ij).
template <bool alloy>
struct DensityOfAtoms {
  EmbeddedTables known;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    auto const r = q.position - p.position;
    using Splines = detail::SplinesAt<detail::width_of<P>::value>;
    return AtomDensity{Splines::template of<alloy>(known, p, q, dot(r, r)).value(0).value};
  }
};

/// dE/d(r^2) = dV/d(r^2) + F_i' d rho_j(r)/d(r^2) + F_j' d rho_i(r)/d(r^2).
template <bool alloy>
struct ForceOnAtoms {
  EmbeddedTables known;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    auto const r = q.position - p.position;
    using Splines = detail::SplinesAt<detail::width_of<P>::value>;
    auto const splines = Splines::template of<alloy>(known, p, q, dot(r, r));
    auto const pair = splines.value(1);
    auto const embedding = [&] {
      auto const at_p = splines.value(0).slope;
      if constexpr (alloy)
        return p.slope * at_p + q.slope * splines.value(2).slope;
      else
        return (p.slope + q.slope) * at_p;
    }();
    return Interaction{r * (2.0 * (pair.slope + embedding)), pair.value};
  }
};

}  // namespace boltzmann
