// Softening: the difference of a softened law from 1/r (2D: from -ln r), which harmonic expansions cannot represent. It
// is small and smooth where expansions act, so two terms of its Taylor series suffice. Private to this module.
#pragma once

#include <boltzmann/core/vector.hpp>

#include <cmath>

namespace boltzmann {

/// With s^2 = r^2 + eps^2, the difference K(r) is 1/s - 1/r for Plummer softening (2D: -ln s + ln r), 1/s + eps^2/(2
/// s^3) - 1/r for the algebraic one (2D: -ln s + ln r + eps^2/(2 s^2)), and zero beyond a few eps for laws of compact
/// support.
enum class Softening { plummer, algebraic, ends };

template <int D>
class SofteningCorrection {
 public:
  /// Strength and dipole of sources, about a centre.
  struct Moments {
    double strength = 0;
    Vector<D> dipole{};
  };

  /// Adds the effect of sources about a place at r from their centre, given the square of their eps.
  void add(Softening softening, Moments const& source, Vector<D> const& r, double softening2) {
    auto const k = derivatives(softening, dot(r, r), softening2);
    double const along = dot(r, source.dipole);
    value_ += source.strength * k.value - k.first * along;
    for (int a = 0; a < D; ++a) {
      slope_[a] += k.first * (source.strength * r[a] - source.dipole[a]) - k.second * along * r[a];
      for (int b = 0; b < D; ++b) curve_[a][b] += source.strength * (k.second * r[a] * r[b] + (a == b ? k.first : 0));
    }
  }
  /// The same about another place, at x from this one.
  SofteningCorrection at(Vector<D> const& x) const {
    SofteningCorrection there = *this;
    there.value_ = value(x);
    there.slope_ = slope(x);
    return there;
  }
  /// The potential at x, its gradient, and the derivative of that along direction d.
  double value(Vector<D> const& x) const { return value_ + 0.5 * dot(x, slope_ + slope(x)); }
  Vector<D> slope(Vector<D> const& x) const { return slope_ + curve(x); }
  Vector<D> curve(Vector<D> const& d) const {
    Vector<D> along{};
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) along[a] += curve_[a][b] * d[b];
    return along;
  }

 private:
  /// grad K = first r, grad grad K = first + second r r.
  struct Derivatives {
    double value, first, second;
  };
  static Derivatives derivatives(Softening softening, double square, double soft) {
    double const bare = 1 / square, softened = 1 / (square + soft);
    double const more = softening == Softening::algebraic ? soft * softened : 0;
    if constexpr (D == 2)
      return {0.5 * (std::log1p(-soft * softened) + more), bare - softened * (1 + more),
              2 * (softened * softened * (1 + 2 * more) - bare * bare)};
    double const u = std::sqrt(bare), v = std::sqrt(softened);
    return {v * (1 + 0.5 * more) - u, bare * u - softened * v * (1 + 1.5 * more),
            3 * (softened * softened * v * (1 + 2.5 * more) - bare * bare * u)};
  }

  double value_ = 0;
  Vector<D> slope_{};
  double curve_[D][D] = {};
};

}  // namespace boltzmann
