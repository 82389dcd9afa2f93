// The law of Stillinger and Weber (Phys. Rev. B 31, 5262, 1985): atoms with bonds at given angles.
#pragma once

#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <tuple>

namespace boltzmann {

/// E = sum over pairs of epsilon A (B (sigma/r)^p - (sigma/r)^q) exp(1/(r/sigma - a)) + sum over pairs of bonds of one
/// atom of lambda epsilon g(r_ij) g(r_ik) (cos theta - cosine)^2, g = exp(gamma/(r/sigma - a)): pairs and bonds end at a
/// sigma with all their derivatives.
struct StillingerWeber {
  double epsilon;
  double sigma;
  double A = 7.049556277, B = 0.6022245584, a = 1.80;
  int p = 4, q = 0;
  double lambda = 21.0, gamma = 1.20;
  double cosine = -1.0 / 3;  ///< of the angle without energy

  /// The numbers of the paper: epsilon = 50 kcal/mol, sigma = 2.0951 angstrom.
  static StillingerWeber silicon(UnitSystem const& units);

  double cutoff() const { return a * sigma; }
  /// Error for an invalid number.
  void check() const;

  template <class Real>
  struct Value {
    Real value, slope;  ///< and d/dr
  };
  /// The energy of a pair nearer than the cut-off.
  template <class Real>
  [[gnu::always_inline]] inline Value<Real> pair(Real const& r) const {
    Real const x = sigma / r, behind = 1.0 / (r * (1 / sigma) - a);
    Real const repulsion = B * power(x, p), attraction = power(x, q);
    Real const size = epsilon * A * exp(behind);
    Real const bracket = repulsion - attraction;
    return {size * bracket, size * (1 / sigma) *
                                (x * (static_cast<double>(q) * attraction - static_cast<double>(p) * repulsion) -
                                 behind * behind * bracket)};
  }
  /// The weight g of a bond shorter than the cut-off.
  template <class Real>
  [[gnu::always_inline]] inline Value<Real> bond(Real const& r) const {
    Real const behind = 1.0 / (r * (1 / sigma) - a);
    Real const g = exp(gamma * behind);
    return {g, g * behind * behind * (-gamma / sigma)};
  }

 private:
  template <class Real>
  [[gnu::always_inline]] static inline Real power(Real const& x, int n) {
    Real result = 1.0, square = x;
    for (; n > 0; n /= 2, square = square * square)
      if (n % 2 == 1) result = result * square;
    return result;
  }
};

}  // namespace boltzmann
