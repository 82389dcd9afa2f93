// Solid harmonics: expansions of 1/r in 3D, W of them at a time (Dehnen 2014, Comp. Astrophys. Cosmol. 1:1, appendix
// A).
//
//   Y_n^m = r^n P_n^m(cos theta) exp(i m phi) / (n + m)!      1/|x - y| = sum conj(Y_n^m(y)) T_n^m(x),   |y| < |x|
//   T_n^m = (n - m)! P_n^m(cos theta) exp(i m phi) / r^(n+1)
//
// Moments are M_n^m = sum q Y_n^m(y). Local expansions F_n^m give the potential sum conj(Y_n^m(x)) F_n^m. Both are
// stored times sqrt((n - m)! (n + m)!) or its inverse, which makes rotations orthogonal, and over powers of the radius
// of their node, so that all numbers have the magnitude of the strengths. To translate them, they are rotated until the
// shift points along z, where a translation mixes orders n but not m: O(p^3) in all. Rotations about z multiply by cos
// and sin. The others are rotations about z between two exchanges of x and z, whose matrices are constant and sparse.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/schemes/multipole/expansion_tables.hpp>

namespace boltzmann::multipole {

/// The index of coefficient (n, m): for each n the real parts of even m, then of odd m, then the imaginary parts in the
/// same order.
constexpr int real_at(int n, int m) { return n * n + (m % 2 == 0 ? m / 2 : n / 2 + 1 + m / 2); }
constexpr int imaginary_at(int n, int m) { return n * n + n + (m % 2 == 0 ? m / 2 : n / 2 + 1 + m / 2); }

enum class Translation { moments_to_local, moments, local };

/// out = matrix in, for this number of rows at once.
template <int rows, int W>
[[gnu::always_inline]] inline void multiply(double const* matrix, int columns, Pack<double, W> const* in,
                                            Pack<double, W>* out) {
  Pack<double, W> sum[rows];
  for (auto& s : sum) s = 0.0;
  for (int k = 0; k < columns; ++k)
    for (int r = 0; r < rows; ++r) sum[r] += Pack<double, W>(matrix[r * columns + k]) * in[k];
  for (int r = 0; r < rows; ++r) out[r] = sum[r];
}

template <int W>
class SolidHarmonics {
 public:
  using Real = Pack<double, W>;
  static constexpr int most = highest_expansion_order + 1;

  /// Translates `in` (numbers of W expansions, which are overwritten) to `out`: to a centre shifted by `shift` (from
  /// the source's to the target's), from the radius of one node to that of another.
  template <Translation kind>
  static void translate(ExpansionView const& tables, Vector<3, Real> const& shift, Real from_radius, Real to_radius,
                        Real* in, Real* out) {
    Turn turn(tables.order, shift);
    Axis axis;
    axis.template prepare<kind>(tables.order, turn.distance, turn.inverse, from_radius, to_radius);
    about_z(tables.order, turn.cos_first, turn.sin_first, in);
    exchange(tables, in, out);
    about_z(tables.order, turn.cos_second, turn.sin_second, out);
    exchange(tables, out, in);
    along_z<kind>(tables, axis, in, out);
    turn.reverse(tables.order);
    exchange(tables, out, in);
    about_z(tables.order, turn.cos_second, turn.sin_second, in);
    exchange(tables, in, out);
    about_z(tables.order, turn.cos_first, turn.sin_first, out);
  }

  /// Adds strength Y_n^m(y) of W particles to sums, without the factors of the tables.
  static void add_moments(int order, Vector<3, Real> const& y, Real strength, Real* sums) {
    each(order, y, strength, [&](int n, int m, Real re, Real im) {
      sums[real_at(n, m)] += re;
      if (m > 0) sums[imaginary_at(n, m)] += im;
    });
  }

  /// Adds strength T_n^m(y) of W particles to sums, without the factors of the tables.
  static void add_local(int order, Vector<3, Real> const& y, Real strength, Real* sums) {
    each_outside(order, y, strength, [&](int n, int m, Real re, Real im) {
      sums[real_at(n, m)] += re;
      if (m > 0) sums[imaginary_at(n, m)] += im;
    });
  }

  /// Calls use(n, m, real part, imaginary part) of factor Y_n^m(x) for all n up to an order and m from 0.
  template <class Use>
  [[gnu::always_inline]] static void each(int order, Vector<3, Real> const& x, Real factor, Use const& use) {
    Real const r2 = dot(x, x);
    Real top_re = factor, top_im = 0.0;  // Y_m^m = -(x + i y) / 2m Y_(m-1)^(m-1)
    for (int m = 0; m <= order; ++m) {
      if (m > 0) {
        Real const f = -0.5 / m, re = (top_re * x[0] - top_im * x[1]) * f;
        top_im = (top_re * x[1] + top_im * x[0]) * f;
        top_re = re;
      }
      Real re = top_re, im = top_im, re_before = 0.0, im_before = 0.0;
      for (int n = m; n <= order; ++n) {
        use(n, m, re, im);
        // ((n+1)^2 - m^2) Y_(n+1) = (2n + 1) z Y_n - r^2 Y_(n-1)
        double const f = 1.0 / ((n + 1) * (n + 1) - m * m);
        Real const a = x[2] * Real((2 * n + 1) * f), b = r2 * Real(f);
        Real const re_next = a * re - b * re_before, im_next = a * im - b * im_before;
        re_before = re, im_before = im;
        re = re_next, im = im_next;
      }
    }
  }

  /// The same of factor T_n^m(x), r > 0.
  template <class Use>
  [[gnu::always_inline]] static void each_outside(int order, Vector<3, Real> const& x, Real factor, Use const& use) {
    Real const inverse2 = 1.0 / dot(x, x), inverse = sqrt(inverse2);
    Real const u = x[0] * inverse2, v = x[1] * inverse2, w = x[2] * inverse2;
    Real top_re = factor * inverse, top_im = 0.0;  // T_m^m = -(2m - 1) (x + i y) / r^2 T_(m-1)^(m-1)
    for (int m = 0; m <= order; ++m) {
      if (m > 0) {
        Real const f = 1.0 - 2.0 * m, re = (top_re * u - top_im * v) * f;
        top_im = (top_re * v + top_im * u) * f;
        top_re = re;
      }
      Real re = top_re, im = top_im, re_before = 0.0, im_before = 0.0;
      for (int n = m; n <= order; ++n) {
        use(n, m, re, im);
        // r^2 T_(n+1) = (2n + 1) z T_n - (n^2 - m^2) T_(n-1)
        Real const a = w * Real(2.0 * n + 1), b = inverse2 * Real(n * n - m * m);
        Real const re_next = a * re - b * re_before, im_next = a * im - b * im_before;
        re_before = re, im_before = im;
        re = re_next, im = im_next;
      }
    }
  }

 private:
  /// Two rotations about z, with exchanges of x and z between and after them, that rotate a shift onto the z axis.
  struct Turn {
    Real cos_first[most], sin_first[most], cos_second[most], sin_second[most], distance, inverse;

    Turn(int order, Vector<3, Real> const& shift) {
      Real const zero = 0.0, one = 1.0;
      Real const across2 = shift[0] * shift[0] + shift[1] * shift[1], square = across2 + shift[2] * shift[2];
      Real const inverse_across = rsqrt(across2);
      auto const off_axis = across2 > zero, apart = square > zero;
      inverse = select(apart, rsqrt(square), zero);
      distance = square * inverse;
      // Into the plane of y and z, which is that of x and y after the exchange; there onto the axis.
      powers(order, select(off_axis, shift[1] * inverse_across, one),
             select(off_axis, -(shift[0] * inverse_across), zero), cos_first, sin_first);
      powers(order, select(apart, shift[2] * inverse, one), select(off_axis, across2 * inverse_across * inverse, zero),
             cos_second, sin_second);
    }

    /// Inverts the rotations.
    void reverse(int order) {
      for (int m = 1; m <= order; ++m) sin_first[m] = -sin_first[m], sin_second[m] = -sin_second[m];
    }

    static void powers(int order, Real c, Real s, Real* cosines, Real* sines) {
      cosines[0] = 1.0, sines[0] = 0.0;
      for (int m = 1; m <= order; ++m) {
        cosines[m] = cosines[m - 1] * c - sines[m - 1] * s;
        sines[m] = cosines[m - 1] * s + sines[m - 1] * c;
      }
    }
  };

  /// Factors of orders before and after a translation along z, and the shift's powers over n!.
  struct Axis {
    Real before[most], after[most], steps[most];

    template <Translation kind>
    void prepare(int order, Real distance, Real inverse, Real from_radius, Real to_radius) {
      Real const one = 1.0;
      if constexpr (kind == Translation::moments_to_local) {
        fill(order, one, from_radius * inverse, before);
        fill(order, inverse, to_radius * inverse, after);
      } else {
        Real const larger = kind == Translation::moments ? to_radius : from_radius;
        Real const ratio = (kind == Translation::moments ? from_radius : to_radius) / larger;
        fill(order, one, ratio, kind == Translation::moments ? before : after);
        fill(order, one, one, kind == Translation::moments ? after : before);
        fill(order, one, distance / larger, steps);
        double factorial = 1;
        for (int n = 1; n <= order; ++n) {
          factorial *= n;
          steps[n] *= 1 / factorial;
        }
      }
    }

    static void fill(int order, Real first, Real ratio, Real* powers) {
      powers[0] = first;
      for (int n = 1; n <= order; ++n) powers[n] = powers[n - 1] * ratio;
    }
  };

  /// Multiplies coefficients (n, m) by exp(-i m alpha).
  static void about_z(int order, Real const* cosines, Real const* sines, Real* numbers) {
    for (int n = 1; n <= order; ++n)
      for (int m = 1; m <= n; ++m) {
        Real &re = numbers[real_at(n, m)], &im = numbers[imaginary_at(n, m)];
        Real const turned = re * cosines[m] + im * sines[m];
        im = im * cosines[m] - re * sines[m];
        re = turned;
      }
  }

  /// Exchanges x and z.
  static void exchange(ExpansionView const& tables, Real const* in, Real* out) {
    double const* matrix = tables.swap;
    out[0] = in[0];
    for (int n = 1; n <= tables.order; ++n)
      for (int imaginary = 0; imaginary < 2; ++imaginary)
        for (int odd = 0; odd < 2; ++odd) {
          int const rows = count(n, imaginary, odd), from = (n + odd + imaginary) % 2;
          int const columns = count(n, imaginary, from);
          matrix = block(matrix, rows, columns, in + first(n, imaginary, from), out + first(n, imaginary, odd));
        }
  }
  static constexpr int count(int n, int imaginary, int odd) { return odd ? (n + 1) / 2 : n / 2 + 1 - imaginary; }
  static constexpr int first(int n, int imaginary, int odd) {
    return n * n + (imaginary ? n + 1 : 0) + (odd ? n / 2 + 1 - imaginary : 0);
  }
  [[gnu::always_inline]] static double const* block(double const* matrix, int rows, int columns, Real const* in,
                                                    Real* out) {
    int r = 0;
    for (; r + 6 <= rows; r += 6) multiply<6, W>(matrix + r * columns, columns, in, out + r);
    switch (rows - r) {
      case 5:
        multiply<5, W>(matrix + r * columns, columns, in, out + r);
        break;
      case 4:
        multiply<4, W>(matrix + r * columns, columns, in, out + r);
        break;
      case 3:
        multiply<3, W>(matrix + r * columns, columns, in, out + r);
        break;
      case 2:
        multiply<2, W>(matrix + r * columns, columns, in, out + r);
        break;
      case 1:
        multiply<1, W>(matrix + r * columns, columns, in, out + r);
        break;
      default:
        break;
    }
    return matrix + rows * columns;
  }

  template <Translation kind>
  static void along_z(ExpansionView const& tables, Axis const& axis, Real const* in, Real* out) {
    int const order = tables.order, width = order + 1;
    double const* const before = kind == Translation::local ? tables.unscale : tables.scale;
    double const* const after = kind == Translation::moments ? tables.unscale : tables.scale;
    for (int m = 0; m <= order; ++m) {
      Real re[most + 3], im[most + 3];
      for (int k = m; k <= order; ++k) {
        Real const f = axis.before[k] * Real(before[k * width + m]);
        re[k] = in[real_at(k, m)] * f;
        im[k] = m > 0 ? in[imaginary_at(k, m)] * f : Real(0.0);
      }
      for (int n = m; n <= order; n += 4) {
        Real sum_re[4], sum_im[4];
        mix<kind>(tables, axis, n, m, re, im, sum_re, sum_im);
        for (int i = 0; i < 4 && n + i <= order; ++i) {
          double const f = after[(n + i) * width + m];
          Real const g =
              axis.after[n + i] * Real(kind == Translation::moments_to_local && (n + i + m) % 2 != 0 ? -f : f);
          out[real_at(n + i, m)] = sum_re[i] * g;
          if (m > 0) out[imaginary_at(n + i, m)] = sum_im[i] * g;
        }
      }
    }
  }

  /// Sums over the input orders k, for four orders n. Moments to local: terms of (n + k)! (signs and powers of the
  /// distance are factors outside); moments: of steps[n - k]; local: of steps[k - n].
  template <Translation kind>
  [[gnu::always_inline]] static void mix(ExpansionView const& tables, Axis const& axis, int n, int m, Real const* re,
                                         Real const* im, Real* sum_re, Real* sum_im) {
    for (int i = 0; i < 4; ++i) sum_re[i] = 0.0, sum_im[i] = 0.0;
    if constexpr (kind == Translation::moments_to_local) {
      Real a[4], b[4];
      for (int i = 0; i < 4; ++i) a[i] = 0.0, b[i] = 0.0;
      double const* const factorial = tables.factorial + n;
      for (int k = m; k <= tables.order; ++k)
        for (int i = 0; i < 4; ++i) {
          Real const f = factorial[k + i];
          a[i] += f * re[k];
          b[i] += f * im[k];
        }
      for (int i = 0; i < 4; ++i) sum_re[i] = a[i], sum_im[i] = b[i];
    } else {
      for (int i = 0; i < 4 && n + i <= tables.order; ++i) {
        int const low = kind == Translation::moments ? m : n + i,
                  high = kind == Translation::moments ? n + i : tables.order;
        for (int k = low; k <= high; ++k) {
          Real const f = axis.steps[kind == Translation::moments ? n + i - k : k - n - i];
          sum_re[i] += f * re[k];
          sum_im[i] += f * im[k];
        }
      }
    }
  }
};

}  // namespace boltzmann::multipole
