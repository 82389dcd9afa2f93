// Tensor<D, Real>: second-rank tensors (stress, velocity gradient) in one, two and three dimensions, for one number or
// a SIMD pack.
#pragma once

#include <boltzmann/core/vector.hpp>

#include <cstddef>
#include <type_traits>

namespace boltzmann {

/// D x D components, a[i][j] in row i and column j, stored row by row: Tensor<2>{1, 2, 3, 4} has the rows (1, 2) and
/// (3, 4). `Real` is double, float or a Pack: nothing here branches on a Real.
template <int D, class Real = double>
struct Tensor {
  static_assert(D >= 1 && D <= 3, "a Tensor has 1, 2 or 3 dimensions");
  static constexpr int dimension = D;

  Real component[D][D];

  constexpr Real (&operator[](std::size_t i))[D] { return component[i]; }
  constexpr Real const (&operator[](std::size_t i) const)[D] { return component[i]; }

  static constexpr Tensor identity() {
    Tensor result;
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j) result.component[i][j] = Real(i == j ? 1.0 : 0.0);
    return result;
  }

  constexpr Tensor& operator+=(Tensor const& b) { return *this = *this + b; }
  constexpr Tensor& operator-=(Tensor const& b) { return *this = *this - b; }
  constexpr Tensor& operator*=(Real const& s) { return *this = *this * s; }
  constexpr Tensor& operator/=(Real const& s) { return *this = *this / s; }

  friend constexpr bool operator==(Tensor const& a, Tensor const& b) requires std::is_arithmetic_v<Real> {
    for (int i = 0; i < D; ++i)
      for (int j = 0; j < D; ++j)
        if (a.component[i][j] != b.component[i][j]) return false;
    return true;
  }
};

/// f applied to every component, or to every pair of components.
template <int D, class Real, class Function>
constexpr Tensor<D, Real> map(Tensor<D, Real> const& a, Function f) {
  Tensor<D, Real> result;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) result.component[i][j] = f(a.component[i][j]);
  return result;
}
template <int D, class Real, class Function>
constexpr Tensor<D, Real> map(Tensor<D, Real> const& a, Tensor<D, Real> const& b, Function f) {
  Tensor<D, Real> result;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) result.component[i][j] = f(a.component[i][j], b.component[i][j]);
  return result;
}

template <int D, class Real>
constexpr Tensor<D, Real> operator+(Tensor<D, Real> const& a, Tensor<D, Real> const& b) {
  return map(a, b, [](auto const& x, auto const& y) { return x + y; });
}
template <int D, class Real>
constexpr Tensor<D, Real> operator-(Tensor<D, Real> const& a, Tensor<D, Real> const& b) {
  return map(a, b, [](auto const& x, auto const& y) { return x - y; });
}
template <int D, class Real>
constexpr Tensor<D, Real> operator-(Tensor<D, Real> const& a) {
  return map(a, [](auto const& x) { return -x; });
}
template <int D, class Real>
constexpr Tensor<D, Real> operator*(Tensor<D, Real> const& a, std::type_identity_t<Real> const& s) {
  return map(a, [&](auto const& x) { return x * s; });
}
template <int D, class Real>
constexpr Tensor<D, Real> operator*(std::type_identity_t<Real> const& s, Tensor<D, Real> const& a) {
  return a * s;
}
template <int D, class Real>
constexpr Tensor<D, Real> operator/(Tensor<D, Real> const& a, std::type_identity_t<Real> const& s) {
  return map(a, [&](auto const& x) { return x / s; });
}

/// The dyad a b: (a b)_ij = a_i b_j.
template <int D, class Real>
constexpr Tensor<D, Real> outer(Vector<D, Real> const& a, Vector<D, Real> const& b) {
  Tensor<D, Real> result;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) result.component[i][j] = a.component[i] * b.component[j];
  return result;
}

/// A . b: (A . b)_i = Sum_j A_ij b_j.
template <int D, class Real>
constexpr Vector<D, Real> dot(Tensor<D, Real> const& a, Vector<D, Real> const& b) {
  Vector<D, Real> result;
  for (int i = 0; i < D; ++i) {
    Real sum = a.component[i][0] * b.component[0];
    for (int j = 1; j < D; ++j) sum = sum + a.component[i][j] * b.component[j];
    result.component[i] = sum;
  }
  return result;
}

/// a . B: (a . B)_j = Sum_i a_i B_ij.
template <int D, class Real>
constexpr Vector<D, Real> dot(Vector<D, Real> const& a, Tensor<D, Real> const& b) {
  Vector<D, Real> result;
  for (int j = 0; j < D; ++j) {
    Real sum = a.component[0] * b.component[0][j];
    for (int i = 1; i < D; ++i) sum = sum + a.component[i] * b.component[i][j];
    result.component[j] = sum;
  }
  return result;
}

/// A . B, the matrix product: (A . B)_ij = Sum_k A_ik B_kj.
template <int D, class Real>
constexpr Tensor<D, Real> dot(Tensor<D, Real> const& a, Tensor<D, Real> const& b) {
  Tensor<D, Real> result;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) {
      Real sum = a.component[i][0] * b.component[0][j];
      for (int k = 1; k < D; ++k) sum = sum + a.component[i][k] * b.component[k][j];
      result.component[i][j] = sum;
    }
  return result;
}

/// A : B = Sum_ij A_ij B_ij (same order of indices on both sides; with the other convention, A_ij B_ji, transpose one
/// of them).
template <int D, class Real>
constexpr Real contraction(Tensor<D, Real> const& a, Tensor<D, Real> const& b) {
  Real sum = a.component[0][0] * b.component[0][0];
  for (int n = 1; n < D * D; ++n) sum = sum + a.component[n / D][n % D] * b.component[n / D][n % D];
  return sum;
}

template <int D, class Real>
constexpr Tensor<D, Real> transpose(Tensor<D, Real> const& a) {
  Tensor<D, Real> result;
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) result.component[i][j] = a.component[j][i];
  return result;
}

/// Sum_i A_ii
template <int D, class Real>
constexpr Real trace(Tensor<D, Real> const& a) {
  Real sum = a.component[0][0];
  for (int i = 1; i < D; ++i) sum = sum + a.component[i][i];
  return sum;
}

/// (A + transpose(A)) / 2
template <int D, class Real>
constexpr Tensor<D, Real> symmetric_part(Tensor<D, Real> const& a) {
  return (a + transpose(a)) * Real(0.5);
}

/// The transposed cofactors: A . adjugate(A) = determinant(A) identity, also for a singular A.
template <class Real>
constexpr Tensor<1, Real> adjugate(Tensor<1, Real> const&) {
  return {Real(1.0)};
}
template <class Real>
constexpr Tensor<2, Real> adjugate(Tensor<2, Real> const& a) {
  return {a[1][1], -a[0][1], -a[1][0], a[0][0]};
}
template <class Real>
constexpr Tensor<3, Real> adjugate(Tensor<3, Real> const& a) {
  Tensor<3, Real> result;
  for (std::size_t i = 0; i < 3; ++i)
    for (std::size_t j = 0; j < 3; ++j) {
      std::size_t const row = (j + 1) % 3, next_row = (j + 2) % 3, column = (i + 1) % 3, next_column = (i + 2) % 3;
      result[i][j] = a[row][column] * a[next_row][next_column] - a[row][next_column] * a[next_row][column];
    }
  return result;
}

template <int D, class Real>
constexpr Real determinant(Tensor<D, Real> const& a) {
  Tensor<D, Real> const cofactors = adjugate(a);
  Real sum = a.component[0][0] * cofactors.component[0][0];
  for (int j = 1; j < D; ++j) sum = sum + a.component[0][j] * cofactors.component[j][0];
  return sum;
}

/// The tensor whose product with A is the identity. Not finite if the determinant is 0: lanes of a pack can't throw, so
/// callers must check.
template <int D, class Real>
constexpr Tensor<D, Real> inverse(Tensor<D, Real> const& a) {
  return adjugate(a) / determinant(a);
}

}  // namespace boltzmann
