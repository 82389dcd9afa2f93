// Knots of splines in r^2 that are evenly spaced in every octave of r^2, so that intervals are found without a search.
#pragma once

#include <boltzmann/core/pack_math.hpp>

#include <bit>
#include <cstdint>

namespace boltzmann {

/// A double without its last `shift` bits is the knot below it; the remaining bits give the number of its interval, the
/// first of which is `first_row`.
struct OctaveKnots {
  std::int64_t first_row = 0;
  int shift = 0;
  double least = 0, greatest = 0;  ///< squares of the first and the last distance

  /// The nearest square between them; the last one for NaN.
  template <class Real>
  [[gnu::always_inline]] inline Real inside(Real const& square) const {
    return max(Real(least), min(Real(greatest), square));
  }
  double knot(std::int64_t row) const { return std::bit_cast<double>(row << shift); }
  std::int64_t row(double inside) const { return std::bit_cast<std::int64_t>(inside) >> shift; }

  template <int W>
  [[gnu::always_inline]] inline Pack<double, W> knot(detail::Bits<W> row) const {
    return detail::from_bits<W>((detail::Bits<W>)((Unsigned<W>)row << shift));
  }
  template <int W>
  [[gnu::always_inline]] inline detail::Bits<W> row(Pack<double, W> inside) const {
    return (detail::Bits<W>)((Unsigned<W>)detail::bits_of(inside) >> shift);
  }

  friend bool operator==(OctaveKnots const&, OctaveKnots const&) = default;

 private:
  template <int W>
  using Unsigned = typename detail::register_of<std::uint64_t, W>::type;
};

}  // namespace boltzmann
