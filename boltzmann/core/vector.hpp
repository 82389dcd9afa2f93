// Vector<D, Real>: the arithmetic of section 2.1 in one, two and three dimensions, for one number or a SIMD pack per
// component.
#pragma once

#include <boltzmann/core/number.hpp>

#include <cstddef>
#include <type_traits>

namespace boltzmann {

/// A vector of D components; component by component arithmetic, `Real` is double, float or a Pack.
template <int D, class Real = double>
struct Vector {
  static_assert(D >= 1 && D <= 3, "a Vector has 1, 2 or 3 components");
  static constexpr int dimension = D;

  Real component[D];

  constexpr Real& operator[](std::size_t i) { return component[i]; }
  constexpr Real const& operator[](std::size_t i) const { return component[i]; }

  constexpr Vector& operator+=(Vector const& b) { return *this = *this + b; }
  constexpr Vector& operator-=(Vector const& b) { return *this = *this - b; }
  constexpr Vector& operator*=(Real const& s) { return *this = *this * s; }
  constexpr Vector& operator/=(Real const& s) { return *this = *this / s; }

  friend constexpr bool operator==(Vector const& a, Vector const& b) requires std::is_arithmetic_v<Real> {
    for (int i = 0; i < D; ++i)
      if (a.component[i] != b.component[i]) return false;
    return true;
  }
};

template <class Real, class... More>
Vector(Real, More...) -> Vector<1 + static_cast<int>(sizeof...(More)), std::common_type_t<Real, More...>>;

/// f applied to every component, or to every pair of components.
template <int D, class Real, class Function>
constexpr Vector<D, Real> map(Vector<D, Real> const& a, Function f) {
  Vector<D, Real> result;
  for (int i = 0; i < D; ++i) result.component[i] = f(a.component[i]);
  return result;
}
template <int D, class Real, class Function>
constexpr Vector<D, Real> map(Vector<D, Real> const& a, Vector<D, Real> const& b, Function f) {
  Vector<D, Real> result;
  for (int i = 0; i < D; ++i) result.component[i] = f(a.component[i], b.component[i]);
  return result;
}

template <int D, class Real>
constexpr Vector<D, Real> operator+(Vector<D, Real> const& a, Vector<D, Real> const& b) {
  return map(a, b, [](auto const& x, auto const& y) { return x + y; });
}
template <int D, class Real>
constexpr Vector<D, Real> operator-(Vector<D, Real> const& a, Vector<D, Real> const& b) {
  return map(a, b, [](auto const& x, auto const& y) { return x - y; });
}
template <int D, class Real>
constexpr Vector<D, Real> operator*(Vector<D, Real> const& a, Vector<D, Real> const& b) {
  return map(a, b, [](auto const& x, auto const& y) { return x * y; });
}
template <int D, class Real>
constexpr Vector<D, Real> operator/(Vector<D, Real> const& a, Vector<D, Real> const& b) {
  return map(a, b, [](auto const& x, auto const& y) { return x / y; });
}
template <int D, class Real>
constexpr Vector<D, Real> operator-(Vector<D, Real> const& a) {
  return map(a, [](auto const& x) { return -x; });
}

// A number acts on every component.
template <int D, class Real>
constexpr Vector<D, Real> operator+(Vector<D, Real> const& a, std::type_identity_t<Real> const& s) {
  return map(a, [&](auto const& x) { return x + s; });
}
template <int D, class Real>
constexpr Vector<D, Real> operator+(std::type_identity_t<Real> const& s, Vector<D, Real> const& a) {
  return a + s;
}
template <int D, class Real>
constexpr Vector<D, Real> operator-(Vector<D, Real> const& a, std::type_identity_t<Real> const& s) {
  return map(a, [&](auto const& x) { return x - s; });
}
template <int D, class Real>
constexpr Vector<D, Real> operator-(std::type_identity_t<Real> const& s, Vector<D, Real> const& a) {
  return map(a, [&](auto const& x) { return s - x; });
}
template <int D, class Real>
constexpr Vector<D, Real> operator*(Vector<D, Real> const& a, std::type_identity_t<Real> const& s) {
  return map(a, [&](auto const& x) { return x * s; });
}
template <int D, class Real>
constexpr Vector<D, Real> operator*(std::type_identity_t<Real> const& s, Vector<D, Real> const& a) {
  return a * s;
}
template <int D, class Real>
constexpr Vector<D, Real> operator/(Vector<D, Real> const& a, std::type_identity_t<Real> const& s) {
  return map(a, [&](auto const& x) { return x / s; });
}
template <int D, class Real>
constexpr Vector<D, Real> operator/(std::type_identity_t<Real> const& s, Vector<D, Real> const& a) {
  return map(a, [&](auto const& x) { return s / x; });
}

/// a . b
template <int D, class Real>
constexpr Real dot(Vector<D, Real> const& a, Vector<D, Real> const& b) {
  Real sum = a.component[0] * b.component[0];
  for (int i = 1; i < D; ++i) sum = sum + a.component[i] * b.component[i];
  return sum;
}

/// The square of the magnitude.
template <int D, class Real>
constexpr Real norm2(Vector<D, Real> const& a) {
  return dot(a, a);
}

/// |a|
template <int D, class Real>
Real magnitude(Vector<D, Real> const& a) {
  using std::sqrt;
  return sqrt(dot(a, a));
}

/// The cross product (section 2.1): zero in 1D; in 2D the one component out of the plane; in 3D a vector.
template <class Real>
constexpr Vector<1, Real> cross(Vector<1, Real> const&, Vector<1, Real> const&) {
  return {Real(0.0)};
}
template <class Real>
constexpr Vector<1, Real> cross(Vector<2, Real> const& a, Vector<2, Real> const& b) {
  return {a[0] * b[1] - a[1] * b[0]};
}
template <class Real>
constexpr Vector<3, Real> cross(Vector<3, Real> const& a, Vector<3, Real> const& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
/// w out of the plane, a in the plane: w x a = w (-a_y, a_x).
template <class Real>
constexpr Vector<2, Real> cross(Vector<1, Real> const& w, Vector<2, Real> const& a) {
  return {-w[0] * a[1], w[0] * a[0]};
}

/// The number of components of a curl or a cross product in D dimensions: 1, 1, 3.
template <int D>
inline constexpr int cross_dimension = D == 3 ? 3 : 1;

/// a where the condition holds, else b, component by component.
template <class Condition, int D, class Real>
constexpr Vector<D, Real> select(Condition const& condition, Vector<D, Real> const& a, Vector<D, Real> const& b) {
  return map(a, b, [&](auto const& x, auto const& y) { return select(condition, x, y); });
}

}  // namespace boltzmann
