// Softening: by what a softened law differs from 1/r (2D: from -ln r), K(r) = 1/sqrt(r^2 + eps^2) - 1/r, which no
// expansion in harmonics has. It is small and smooth where expansions act, so that two terms of Taylor's series do.
// Private to this room.
#pragma once

#include <boltzmann/core/vector.hpp>

#include <cmath>

namespace boltzmann {

template <int D>
class SofteningCorrection {
 public:
  /// Strength and dipole of sources, about a centre.
  struct Moments {
    double strength = 0;
    Vector<D> dipole{};
  };

  /// Adds what sources make about a place that lies at r from their centre; with the square of their softening.
  void add(Moments const& source, Vector<D> const& r, double softening2) {
    auto const k = derivatives(dot(r, r), softening2);
    double const along = dot(r, source.dipole);
    value_ += source.strength * k.value - k.first * along;
    for (int a = 0; a < D; ++a) {
      slope_[a] += k.first * (source.strength * r[a] - source.dipole[a]) - k.second * along * r[a];
      for (int b = 0; b < D; ++b) curve_[a][b] += source.strength * (k.second * r[a] * r[b] + (a == b ? k.first : 0));
    }
  }
  /// The same about another place, at x from this.
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
  static Derivatives derivatives(double square, double soft) {
    double const bare = 1 / square, softened = 1 / (square + soft);
    if constexpr (D == 2)
      return {0.5 * std::log1p(-soft * softened), bare - softened, 2 * (softened * softened - bare * bare)};
    double const u = std::sqrt(bare), v = std::sqrt(softened);
    return {v - u, bare * u - softened * v, 3 * (softened * softened * v - bare * bare * u)};
  }

  double value_ = 0;
  Vector<D> slope_{};
  double curve_[D][D] = {};
};

}  // namespace boltzmann
