// Laws from tables: pair energies that are given as numbers, or are too expensive to compute for every pair.
#pragma once

#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/octave_knots.hpp>
#include <boltzmann/particles/rows.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <type_traits>
#include <vector>

namespace boltzmann {

/// A measured or computed energy of a pair at a distance.
struct TablePoint {
  double distance, energy;
};

/// The ends of the spline through points: with a given slope dU/dr (clamped), or without curvature (natural).
struct SplineEnds {
  std::optional<double> first_slope, last_slope;
};

/// The fineness of a table: by the number of intervals in every octave of r^2, a power of two, or by the allowed error
/// (see TableError::relative).
struct PerOctave {
  std::size_t intervals;
};
struct Tolerance {
  double relative;
};

/// The largest errors of a table, measured at several points between all its knots (the force against central
/// differences of fourth order if only U is known), plus 5 %.
struct TableError {
  double energy = 0;  ///< |U_table - U|
  double force = 0;   ///< |F_table - F|
  /// The larger of |U_table - U| / (|U| + U*) and |F_table - F| / (|F| + F*), where U* and F* are the medians of |U|
  /// and |F| over the distances: relative where the law is strong, absolute where it passes through zero.
  double relative = 0;
};

/// The pair law of an energy U(r): a cubic spline in r^2, with two continuous derivatives. The force is the exact
/// derivative of that spline, so that energy is conserved for any error. The knots are evenly spaced in every octave of
/// r^2, so that a steep core and a long tail are both resolved. The leading bits of r^2 give the number of an interval:
/// no root, no division, no search. Copies of a Table share its numbers.
/// Below the first distance, U continues as a straight line in r^2: the force falls in proportion to r, and two
/// coincident particles exert no force on each other. Beyond the last distance there is no force, and U is constant.
class Table {
 public:
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  static constexpr bool positions_alone = true;
  using Energy = std::function<double(double)>;

  /// U(r) for 0 <= first <= r <= last; it must be finite there. (A first distance below a thousandth of the last one is
  /// replaced by that.) Error if it is not finite, and if the tolerance requires more than 200000 intervals.
  Table(Energy const& energy, double first, double last, Tolerance tolerance);
  Table(Energy const& energy, double first, double last, PerOctave fineness);

  /// The cubic spline in r through points, at least two and in the order of their distances. Error for wrong points.
  explicit Table(std::span<TablePoint const> points, SplineEnds ends = {}, Tolerance tolerance = {1e-5});
  Table(std::span<TablePoint const> points, SplineEnds ends, PerOctave fineness);

  /// The points of a text file: a distance and an energy in every line, in the simulation's units; empty lines and text
  /// after a '#' are ignored. Error, "file:line: what is wrong", for anything else.
  static Table from_file(std::string const& path, SplineEnds ends = {}, Tolerance tolerance = {1e-5});

  TableError error() const { return data_->error; }
  std::size_t intervals() const { return data_->rows.size(); }
  double first() const { return data_->first; }
  double last() const { return data_->last; }
  /// For loops that read several tables with the same knots at once: four coefficients of powers of r^2 - knot for each
  /// interval.
  OctaveKnots knots() const { return {first_row_, shift_, least_, greatest_}; }
  double const* coefficients() const { return rows_; }
  /// The smallest tabulated distance.
  double length_scale() const { return data_->first; }

  /// U and dU/d(r^2) at r^2; `Real` is double or a Pack. For any argument, including NaN, only the table is read.
  template <class Real>
  struct Value {
    Real energy, slope;
  };
  template <class Real>
  [[gnu::always_inline]] inline Value<Real> at(Real const& square) const {
    // Not min(square, ...): for NaN this gives the limit.
    Real const inside = knots().inside(square);
    auto const [knot, c] = interval(inside);
    Real const d = inside - knot;
    Real const slope = c[1] + d * (2.0 * c[2] + d * (3.0 * c[3]));
    Real const energy = c[0] + d * (c[1] + d * (c[2] + d * c[3])) + min(square - least_, Real(0.0)) * slope;
    return {energy, select(square > greatest_, Real(0.0), slope)};
  }

  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const r = q.position - p.position;
    auto const [energy, slope] = at(dot(r, r));
    return Interaction{r * (2.0 * slope), energy};
  }

 private:
  /// U = c0 + c1 d + c2 d^2 + c3 d^3, d = r^2 - knot.
  struct alignas(32) Row {
    double c[4];
  };
  struct Data {
    std::vector<Row> rows;
    double first, last;
    TableError error;
  };
  template <class Real>
  struct Interval {
    Real knot;
    std::array<Real, 4> c;
  };
  struct Source;

  Table(Source const& source, PerOctave fineness);
  static Table within(Source const& source, Tolerance tolerance);
  static TableError measured(Table const& table, Source const& source);

  Interval<double> interval(double square) const {
    std::int64_t const number = knots().row(square);
    double const* const c = rows_ + 4 * static_cast<std::size_t>(number - first_row_);
    return {knot(number), {c[0], c[1], c[2], c[3]}};
  }
  template <int W>
  [[gnu::always_inline]] inline Interval<Pack<double, W>> interval(Pack<double, W> square) const {
    auto const number = knots().row(square);
    auto const offsets = std::bit_cast<std::array<std::int64_t, W>>((number - first_row_) << 2);
    Interval<Pack<double, W>> result;
    result.knot = knots().template knot<W>(number);
    detail::transpose_block<W>([&](int lane) { return rows_ + offsets[static_cast<std::size_t>(lane)]; }, 0,
                               result.c.data(), 4);
    return result;
  }
  std::vector<double> knots_between(std::int64_t end_row) const;
  double knot(std::int64_t row) const { return knots().knot(row); }

  double const* rows_;
  std::int64_t first_row_;
  int shift_;
  double least_, greatest_;  ///< squares of distances
  std::shared_ptr<Data const> data_;
};

}  // namespace boltzmann
