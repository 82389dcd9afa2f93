// The near part of Ewald sums: the Laplace law between strengths that are screened by Gaussian clouds.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <type_traits>

namespace boltzmann {

namespace detail {

/// e^(x^2) erfc(x) for 0 <= x <= 28, by a ratio of polynomials of degree 8 and 9 with positive coefficients that
/// interpolates the function at 18 points: relative error 5e-15. For doubles and packs.
template <class Real>
[[gnu::always_inline]] inline Real quick_scaled_erfc(Real const& x) {
  Real const z = x * x;
  Real const even =
      0x1.000000000000ap+0 +
      z * (0x1.06e46848d18c8p+1 + z * (0x1.1dcb069c2fe9fp-1 + z * (0x1.154a048ad2bddp-5 + z * 0x1.189bdbf8f2a37p-12)));
  Real const odd =
      0x1.05422d6eb1785p+1 + z * (0x1.4c56701ece25dp+0 + z * (0x1.556673619080ep-3 + z * 0x1.1a47715aa5570p-8));
  Real const even_below =
      1.0 +
      z * (0x1.28553030291dbp+2 + z * (0x1.38f2b2796a140p+1 + z * (0x1.327783b61cb40p-2 + z * 0x1.f4539e1349685p-8)));
  Real const odd_below =
      0x1.95b0e7f0c6a2ap+1 +
      z * (0x1.06c2401a415cap+2 + z * (0x1.04e56c7d53768p+0 + z * (0x1.ed6cce7575b26p-5 + z * 0x1.f15dbed1bf749p-12)));
  return (even + x * odd) / (even_below + x * odd_below);
}

}  // namespace detail

/// LaplaceLaw between strengths s, each in a cloud of strength -s and density ~ exp(-alpha^2 r^2) (transform exp(-k^2 /
/// 4 alpha^2)). It decays within a few 1/alpha, and the remainder is smooth. A pair has the energy
///   1D (C/2) s s' [exp(-alpha^2 x^2)/(alpha sqrt(pi)) - |x| erfc(alpha |x|)],
///   2D (C/4 pi) s s' E1(alpha^2 r^2),
///   3D (C/4 pi) s s' erfc(alpha r)/r
/// and the force
///   1D (C/2) s s' erfc(alpha |x|) sgn x,
///   2D (C/2 pi) s s' exp(-alpha^2 r^2) r/r^2,
///   3D (C/4 pi) s s' [erfc(alpha r)/r + (2 alpha/sqrt(pi)) exp(-alpha^2 r^2)] r/r^2,
/// relative errors below 2e-14 for alpha r < 10. C as in LaplaceLaw: 4 pi k for charges, -4 pi G for masses. Not valid
/// beyond alpha r = 10^15.
struct EwaldShort {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;

  double constant;
  double alpha;  ///< 1/length

  template <class P, class Q>
  requires requires(P const& p, Q const& q) { p.strength() * q.strength(); }
  auto operator()(P const& p, Q const& q) const {
    constexpr int D = P::dimension;
    constexpr double root_pi = 1.77245385090551602730;
    auto const r = q.position - p.position;
    auto const square = dot(r, r);
    using Real = std::remove_cvref_t<decltype(square)>;
    auto const strengths = p.strength() * q.strength();
    Real const u = alpha * alpha * square;
    Real const e = exp_of_rounded(-u);
    if constexpr (D == 1) {
      Real const c = constant / 2 * strengths;
      Real const distance = sqrt(square);
      Real const complement = e * detail::quick_scaled_erfc(Real(alpha * distance));
      Real const inverse = select(square > 0.0, Real(1.0 / distance), Real(0.0));
      return Interaction{r * (-c * complement * inverse), c * (e * (1 / (alpha * root_pi)) - distance * complement)};
    } else if constexpr (D == 2) {
      Real const c = constant / (2 * pi) * strengths;
      return Interaction{r * (-c * e / square), 0.5 * c * exponential_integral(u)};
    } else {
      Real const inverse = rsqrt(square);
      Real const c = constant / (4 * pi) * strengths * e;
      Real const energy = c * detail::quick_scaled_erfc(Real(alpha * (square * inverse))) * inverse;
      return Interaction{r * (-(inverse * inverse) * (energy + c * (2 * alpha / root_pi))), energy};
    }
  }

  double length_scale() const { return 1 / alpha; }
  void check() const {
    check_parameter("ewald_short", "constant", constant, any_number);
    check_parameter("ewald_short", "alpha", alpha, positive);
  }
};

}  // namespace boltzmann
