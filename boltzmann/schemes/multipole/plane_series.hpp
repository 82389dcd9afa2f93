// Plane series: expansions of ln r in 2D, W of them at a time (Greengard and Rokhlin 1987), with z = x + i y.
//   sum q ln(z - z_q) = a_0 ln z + sum_k a_k / z^k,   a_0 = sum q, a_k = -sum q z_q^k / k      far from the strengths
//   sum q ln(z - z_q) = sum_l b_l z^l                                                          away from them
// Coefficients are divided by powers of the radius of their node. The real part of k is at index 2 k, followed by the
// imaginary one.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/schemes/multipole/solid_harmonics.hpp>

namespace boltzmann::multipole {

template <class Real>
struct Complex {
  Real re, im;

  friend Complex operator*(Complex a, Complex b) { return {a.re * b.re - a.im * b.im, a.re * b.im + a.im * b.re}; }
  friend Complex operator*(Complex a, Real f) { return {a.re * f, a.im * f}; }
  Complex& operator+=(Complex b) { return *this = {re + b.re, im + b.im}; }
};

template <int W>
class PlaneSeries {
 public:
  using Real = Pack<double, W>;
  using Number = Complex<Real>;
  static constexpr int most = highest_expansion_order + 1;

  /// As SolidHarmonics::translate.
  template <Translation kind>
  static void translate(ExpansionView const& tables, Vector<2, Real> const& shift, Real from_radius, Real to_radius,
                        Real* in, Real* out) {
    int const p = tables.order;
    auto const at = [&](int k) { return Number{in[2 * k], in[2 * k + 1]}; };
    auto const put = [&](int k, Number x) { out[2 * k] = x.re, out[2 * k + 1] = x.im; };
    Number const s{shift[0], shift[1]};
    if constexpr (kind == Translation::moments_to_local) {
      Real const square = dot(shift, shift), inverse2 = 1.0 / square;
      Number const inverse{s.re * inverse2, -(s.im * inverse2)};
      // (-1)^l s^l l! b_l = sum_k (l + k - 1)! u_k, u_0 = -a_0, u_k = a_k / s^k (k - 1)!
      Number u[most + 1], power = inverse * from_radius;
      Number const step = power;
      u[0] = at(0) * Real(-1.0);
      for (int k = 1; k <= p; ++k, power = power * step) u[k] = at(k) * power * Real(1 / tables.factorial[k - 1]);
      Number first{0.5 * at(0).re * log(square), Real(0.0)};
      for (int k = 1; k <= p; ++k) first += u[k] * Real(tables.factorial[k - 1]);
      put(0, first);
      Number const back = inverse * (-to_radius);
      power = back;
      for (int l = 1; l <= p; ++l, power = power * back) {
        Number sum{Real(0.0), Real(0.0)};
        for (int k = 0; k <= p; ++k) sum += u[k] * Real(tables.factorial[l + k - 1]);
        put(l, sum * power * Real(tables.scale[l]));
      }
    } else {
      Real const larger = kind == Translation::moments ? to_radius : from_radius;
      Real const ratio = (kind == Translation::moments ? from_radius : to_radius) / larger;
      Number steps[most];  // (shift / larger)^n / n!
      steps[0] = {Real(1.0), Real(0.0)};
      for (int n = 1; n <= p; ++n) steps[n] = steps[n - 1] * s * (Real(1.0 / n) / larger);
      if constexpr (kind == Translation::moments)
        gather_moments(tables, ratio, steps, at, put);
      else
        hand_down(tables, ratio, steps, at, put);
    }
  }

  /// Adds the moments of W particles to sums, without the factors -1/k.
  static void add_moments(int order, Vector<2, Real> const& y, Real strength, Real* sums) {
    Number const z{y[0], y[1]};
    Number power{strength, Real(0.0)};
    for (int k = 0; k <= order; ++k, power = power * z) sums[2 * k] += power.re, sums[2 * k + 1] += power.im;
  }

  /// Adds the local expansion of W particles to sums: ln r, and 1/y^l without the factors -1/l.
  static void add_local(int order, Vector<2, Real> const& y, Real strength, Real* sums) {
    Real const square = dot(y, y), inverse2 = 1.0 / square;
    Number const inverse{y[0] * inverse2, -(y[1] * inverse2)};
    sums[0] += 0.5 * strength * log(square);
    Number power = inverse * strength;
    for (int l = 1; l <= order; ++l, power = power * inverse) sums[2 * l] += power.re, sums[2 * l + 1] += power.im;
  }

  /// The derivative of the series of one expansion at W places, and on request the real part of its value.
  struct Value {
    Number slope;
    Real value;
  };
  static Value local(int order, Vector<2, Real> const& x, double const* numbers, bool with_value) {
    Number const z{x[0], x[1]}, zero{Real(0.0), Real(0.0)};
    Number slope = zero, value = zero;
    for (int l = order; l > 0; --l) {
      slope = slope * z;
      slope += {Real(l * numbers[2 * l]), Real(l * numbers[2 * l + 1])};
    }
    for (int l = order; with_value && l >= 0; --l) {
      value = value * z;
      value += {Real(numbers[2 * l]), Real(numbers[2 * l + 1])};
    }
    return {slope, value.re};
  }
  static Value moments(int order, Vector<2, Real> const& x, double const* numbers, bool with_value) {
    Real const square = dot(x, x), inverse2 = 1.0 / square;
    Number const inverse{x[0] * inverse2, -(x[1] * inverse2)}, zero{Real(0.0), Real(0.0)};
    Number slope = zero, value = zero;
    for (int k = order; k > 0; --k) {
      slope += {Real(-k * numbers[2 * k]), Real(-k * numbers[2 * k + 1])};
      slope = slope * inverse;
      if (!with_value) continue;
      value += {Real(numbers[2 * k]), Real(numbers[2 * k + 1])};
      value = value * inverse;
    }
    slope += {Real(numbers[0]), Real(0.0)};
    return {slope * inverse, with_value ? value.re + 0.5 * numbers[0] * log(square) : Real(0.0)};
  }

 private:
  /// (l - 1)! sum_k a_k / (k - 1)! steps[l - k], and -a_0 shift^l / l.
  static void gather_moments(ExpansionView const& tables, Real ratio, Number const* steps, auto const& at,
                             auto const& put) {
    Number u[most];
    Real power = ratio;
    for (int k = 1; k <= tables.order; ++k, power = power * ratio)
      u[k] = at(k) * (power * Real(1 / tables.factorial[k - 1]));
    u[0] = at(0) * Real(-1.0);
    put(0, at(0));
    for (int l = 1; l <= tables.order; ++l) {
      Number sum = u[0] * steps[l];
      for (int k = 1; k <= l; ++k) sum += u[k] * steps[l - k];
      put(l, sum * Real(tables.factorial[l - 1]));
    }
  }

  /// 1 / l! sum_k k! b_k steps[k - l]
  static void hand_down(ExpansionView const& tables, Real ratio, Number const* steps, auto const& at, auto const& put) {
    Number u[most];
    for (int k = 0; k <= tables.order; ++k) u[k] = at(k) * Real(tables.unscale[k]);
    Real power = 1.0;
    for (int l = 0; l <= tables.order; ++l, power = power * ratio) {
      Number sum{Real(0.0), Real(0.0)};
      for (int k = l; k <= tables.order; ++k) sum += u[k] * steps[k - l];
      put(l, sum * (power * Real(tables.scale[l])));
    }
  }
};

}  // namespace boltzmann::multipole
