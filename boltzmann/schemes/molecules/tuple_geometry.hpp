// The angle of three particles and the dihedral of four: values and derivatives with respect to each position.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/vector.hpp>

#include <cmath>

namespace boltzmann {
namespace detail {

/// Calls the C library lane by lane.
template <int W>
inline Pack<double, W> atan2(Pack<double, W> y, Pack<double, W> x) {
  Pack<double, W> angle;
  for (int lane = 0; lane < W; ++lane) angle.native[lane] = std::atan2(y.native[lane], x.native[lane]);
  return angle;
}

/// sin^2 below which an angle counts as straight or folded: the direction of its gradient is then lost to rounding.
inline constexpr double straight = 1e-12;

/// W tuples of N particles: the angle, its derivative with respect to each position, and each position relative to the
/// second.
template <int N, int D, class Real>
struct TupleAngle {
  Real angle;
  Vector<D, Real> slope[N];
  Vector<D, Real> arm[N];
};

/// The angle at the second of three particles, between 0 and pi.
template <int D>
struct AngleOf {
  static constexpr int members = 3, dimension = D;

  /// `steps`: the vector from each particle to the next.
  template <class Real>
  [[gnu::always_inline]] static TupleAngle<3, D, Real> at(Vector<D, Real> const (&steps)[2]) {
    auto const a = -steps[0], b = steps[1];
    auto const normal = cross(a, b);
    Real const product = dot(a, b), a2 = dot(a, a), b2 = dot(b, b), sine2 = dot(normal, normal);
    Real const inverse = rsqrt(max(sine2, straight * a2 * b2));
    TupleAngle<3, D, Real> result;
    result.angle = atan2(sqrt(sine2), product);
    result.slope[0] = (a * (product / a2) - b) * inverse;
    result.slope[2] = (b * (product / b2) - a) * inverse;
    result.slope[1] = -(result.slope[0] + result.slope[2]);
    result.arm[0] = a;
    result.arm[1] = Vector<D, Real>{};
    result.arm[2] = b;
    return result;
  }
};

/// The dihedral of four particles about the line from the second to the third, between -pi and pi: 0 in cis, +-pi in
/// trans, positive where the far bond is turned clockwise from the near one. Derivatives without a singularity at 0 and
/// pi: A. Blondel and M. Karplus, J. Comput. Chem. 17, 1132 (1996), Eq. 27.
struct DihedralOf {
  static constexpr int members = 4, dimension = 3;

  template <class Real>
  [[gnu::always_inline]] static TupleAngle<4, 3, Real> at(Vector<3, Real> const (&steps)[3]) {
    auto const &f = steps[0], &g = steps[1], &h = steps[2];
    auto const a = cross(f, g), b = cross(g, h);
    Real const g2 = dot(g, g), length = sqrt(g2);
    Real const a2 = max(dot(a, a), straight * dot(f, f) * g2), b2 = max(dot(b, b), straight * dot(h, h) * g2);
    TupleAngle<4, 3, Real> result;
    result.angle = atan2(length * dot(f, b), dot(a, b));
    auto const first = a * (length / a2), last = b * (length / b2);
    auto const shared = first * (dot(f, g) / g2) + last * (dot(h, g) / g2);
    result.slope[0] = -first;
    result.slope[1] = first + shared;
    result.slope[2] = -(last + shared);
    result.slope[3] = last;
    result.arm[0] = -f;
    result.arm[1] = Vector<3, Real>{};
    result.arm[2] = g;
    result.arm[3] = g + h;
    return result;
  }
};

}  // namespace detail
}  // namespace boltzmann
