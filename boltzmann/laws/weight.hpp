// Weights of smooth particles: the distribution of a particle's mass around it (Eq 6 of Hoover and Hoover's SPAM).
#pragma once

#include <boltzmann/core/number.hpp>
#include <boltzmann/core/words.hpp>

#include <numbers>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

// A shape defines a weight as a function of q = r / range, for 0 <= q <= 1 (everything is zero at q = 1, and beyond),
// without its normalisation:
//   norm<D>           the factor that makes the integral over D-dimensional space, in units of the range, one
//   value(q)
//   slope(q, 1/q)     value'(q) / q: finite at q = 0, so that a gradient needs no unit vector; 1/q may be anything
//   there
//   curvature(q)      value''(q)

/// (1 - q)^3 (1 + 3q): Lucy 1977, two continuous derivatives. The weight of the source texts.
struct Lucy {
  static constexpr char const* name = "lucy";
  static constexpr double smoothing_length = 0.5;  ///< relative to the range
  template <int D>
  static constexpr double norm = D == 1   ? 1.25
                                 : D == 2 ? 5 / std::numbers::pi
                                          : 105 / (16 * std::numbers::pi);
  template <int D, class Real>
  static Real value(Real q) {
    Real const u = 1.0 - q;
    return u * u * u * (1.0 + 3.0 * q);
  }
  template <int D, class Real>
  static Real slope(Real q, Real) {
    Real const u = 1.0 - q;
    return -12.0 * u * u;
  }
  template <int D, class Real>
  static Real curvature(Real q) {
    return -12.0 * (1.0 - q) * (1.0 - 3.0 * q);
  }
};

/// Wendland's C2 function: (1 - q)^3 (1 + 3q) in 1D (there it is Lucy's), (1 - q)^4 (1 + 4q) in 2D and 3D. Its Fourier
/// transform is positive: particles don't pair.
struct Wendland {
  static constexpr char const* name = "wendland";
  static constexpr double smoothing_length = 0.5;  ///< relative to the range
  template <int D>
  static constexpr double norm = D == 1   ? 1.25
                                 : D == 2 ? 7 / std::numbers::pi
                                          : 21 / (2 * std::numbers::pi);
  template <int D, class Real>
  static Real value(Real q) {
    if constexpr (D == 1) return Lucy::value<1>(q);
    Real const u = 1.0 - q, u2 = u * u;
    return u2 * u2 * (1.0 + 4.0 * q);
  }
  template <int D, class Real>
  static Real slope(Real q, Real inverse_q) {
    if constexpr (D == 1) return Lucy::slope<1>(q, inverse_q);
    Real const u = 1.0 - q;
    return -20.0 * u * u * u;
  }
  template <int D, class Real>
  static Real curvature(Real q) {
    if constexpr (D == 1) return Lucy::curvature<1>(q);
    Real const u = 1.0 - q;
    return -20.0 * u * u * (1.0 - 4.0 * q);
  }
};

/// The cubic B-spline: with s = 2q, (2 - s)^3 - 4 (1 - s)^3, where negative brackets are zero.
struct CubicSpline {
  static constexpr char const* name = "cubic-spline";
  static constexpr double smoothing_length = 0.5;  ///< relative to the range
  template <int D>
  static constexpr double norm = D == 1   ? 1.0 / 3
                                 : D == 2 ? 10 / (7 * std::numbers::pi)
                                          : 2 / std::numbers::pi;
  template <int D, class Real>
  static Real value(Real q) {
    Real const a = 2.0 - 2.0 * q, b = max(Real(1.0 - 2.0 * q), Real(0.0));
    return a * a * a - 4.0 * b * b * b;
  }
  template <int D, class Real>
  static Real slope(Real q, Real inverse_q) {
    Real const s = 2.0 * q, a = 2.0 - s;
    return select(s < Real(1.0), 4.0 * (-12.0 + 9.0 * s), -6.0 * a * a * inverse_q);
  }
  template <int D, class Real>
  static Real curvature(Real q) {
    Real const a = 2.0 - 2.0 * q, b = max(Real(1.0 - 2.0 * q), Real(0.0));
    return 24.0 * a - 96.0 * b;
  }
};

/// The quintic B-spline: with s = 3q, (3 - s)^5 - 6 (2 - s)^5 + 15 (1 - s)^5, where negative brackets are zero.
struct QuinticSpline {
  static constexpr char const* name = "quintic-spline";
  static constexpr double smoothing_length = 1.0 / 3;
  template <int D>
  static constexpr double norm = D == 1   ? 1.0 / 40
                                 : D == 2 ? 63 / (478 * std::numbers::pi)
                                          : 9 / (40 * std::numbers::pi);
  template <int D, class Real>
  static Real value(Real q) {
    Real const s = 3.0 * q, a = 3.0 - s, b = max(Real(2.0 - s), Real(0.0)), c = max(Real(1.0 - s), Real(0.0));
    return fifth(a) - 6.0 * fifth(b) + 15.0 * fifth(c);
  }
  template <int D, class Real>
  static Real slope(Real q, Real inverse_q) {
    Real const s = 3.0 * q, a = 3.0 - s, b = max(Real(2.0 - s), Real(0.0));
    Real const inside = 9.0 * -5.0 * (24.0 + s * s * (-24.0 + 10.0 * s));
    return select(s < Real(1.0), inside, -15.0 * (fourth(a) - 6.0 * fourth(b)) * inverse_q);
  }
  template <int D, class Real>
  static Real curvature(Real q) {
    Real const s = 3.0 * q, a = 3.0 - s, b = max(Real(2.0 - s), Real(0.0)), c = max(Real(1.0 - s), Real(0.0));
    return 180.0 * (a * a * a - 6.0 * b * b * b + 15.0 * c * c * c);
  }

 private:
  template <class Real>
  static Real fourth(Real x) {
    return (x * x) * (x * x);
  }
  template <class Real>
  static Real fifth(Real x) {
    return (x * x) * (x * x) * x;
  }
};

/// A weight and its slope at one distance.
template <class Real>
struct Weighed {
  Real value;  ///< w(r), in 1 / length^D
  Real slope;  ///< w'(r) / r: the gradient at p of the weight of q is -slope (q.position - p.position)
};

/// The weight of a shape in D dimensions at the square of a distance; zero beyond the range.
template <class Shape, int D, class Real>
[[gnu::always_inline]] inline Weighed<Real> weigh(Real r2, Real range, Real inverse_range) {
  Real const inverse_r = rsqrt(max(r2, Real(1e-280)));
  Real const q = min(Real(r2 * inverse_r * inverse_range), Real(1.0));
  Real norm = Shape::template norm<D> * inverse_range;
  for (int d = 1; d < D; ++d) norm = norm * inverse_range;
  Real const value = Shape::template value<D>(q), slope = Shape::template slope<D>(q, Real(range * inverse_r));
  return {norm * value, norm * inverse_range * inverse_range * slope};
}

/// The shapes by name, for selection at run time.
enum class WeightShape { lucy, wendland, cubic_spline, quintic_spline };
Words<WeightShape> const& weight_words();
std::string to_string(WeightShape shape);

/// Calls function(Shape{}) for the shape.
template <class Function>
decltype(auto) for_weight(WeightShape shape, Function const& function) {
  switch (shape) {
    case WeightShape::wendland:
      return function(Wendland{});
    case WeightShape::cubic_spline:
      return function(CubicSpline{});
    case WeightShape::quintic_spline:
      return function(QuinticSpline{});
    case WeightShape::lucy:
      break;
  }
  return function(Lucy{});
}

/// A weight at the distance r with its derivatives.
struct WeightAt {
  double value = 0;      ///< w(r), in 1 / length^D
  double slope = 0;      ///< w'(r) / r, finite at r = 0
  double curvature = 0;  ///< w''(r)
};
/// In D dimensions, at a distance r >= 0, for a range > 0; zeros from the range on.
WeightAt weight_at(WeightShape shape, int dimension, double r, double range);

}  // namespace boltzmann
