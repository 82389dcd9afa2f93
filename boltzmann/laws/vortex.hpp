// The Biot-Savart law: vortices carry fluid particles and each other (section 3.7 of the 1990 thesis), with the cores
// of vortex methods.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>
#include <boltzmann/particles/vortex.hpp>

#include <array>
#include <cstddef>

namespace boltzmann {

/// A square of a distance in 2D, small enough to matter only at distance zero: it keeps the inverse finite there, so
/// that the velocity, r times the inverse, is zero without a core.
template <class Real>
inline constexpr double smallest_square = 1e-200;
template <int W>
inline constexpr float smallest_square<Pack<float, W>> = 1e-30F;
template <class Real>
Real square_above_zero(Vector<2, Real> const& r) {
  return r[0] * r[0] + (r[1] * r[1] + smallest_square<Real>);
}

/// The strength of a vortex's rotation, by the square of the distance (in 2D square_above_zero) and of its core (a
/// radius). A core defines q(r) / r^2 in 2D and q(r) / r^3 in 3D, q the part of its vorticity inside r, and in 3D also
/// the derivative of that divided by r.
template <class Real>
struct Turning {
  Real strength, slope;
};

/// 2D: solid rotation inside the core, a point vortex outside; zero at the centre. (C.20 has the speed of the rim
/// everywhere inside, and no value at the centre.) 3D: the core of Rosenhead and Moore, q = r^3 / (r^2 + core^2)^(3/2).
struct PlainCore {
  static constexpr LawText text{
      .name = "biot-savart",
      .doc = "vortices carry fluid particles and each other; in 2D a solid core, in 3D that of Rosenhead and Moore",
      .formula =
          "velocity Gamma e_z x r/(2 pi max(r, sigma)^2) in 2D, omega x r/(4 pi (r^2 + sigma^2)^(3/2)) in 3D; r from "
          "the vortex, Gamma and omega its vorticity, sigma its core. In 3D the vorticity of Inviscid and its kind "
          "changes, too, by (1 - transposed) (omega . grad) v + transposed grad (omega . v)",
      .target = "Tracer",
      .source = "Vortex",
      .least_dimension = 2,
      .has_energy = false,
      .in_programs = "BiotSavart",
      .typed = {"", "q.vorticity/(2*pi)*[separation.y, -separation.x]/max(r, q.core)^2",
                "cross(separation, q.vorticity)/(4*pi*(r^2 + q.core^2)^1.5)"}};

  template <class Real>
  static Real turning_2d(Real const& square, Real const& core2) {
    return reciprocal(max(square, core2));
  }
  template <class Real>
  static Turning<Real> turning_3d(Real const& square, Real const& core2) {
    Real const all = square + core2;
    Real const inverse = select(all > 0.0, rsqrt(all), Real(0.0));
    Real const inverse2 = inverse * inverse, strength = inverse2 * inverse;
    return {strength, -3.0 * strength * inverse2};
  }
};

/// The algebraic core of G. S. Winckelmans and A. Leonard, J. Comput. Phys. 109, 247 (1993). The vorticity is
/// proportional to (1 + r^2 / core^2)^(-3) in 2D, ^(-7/2) in 3D, so that its second moment exists: an error of second
/// order in the core.
struct AlgebraicCore {
  static constexpr LawText text{
      .name = "biot-savart-algebraic",
      .doc = "the same with the algebraic core of Winckelmans and Leonard, whose errors are of second order",
      .formula =
          "velocity Gamma e_z x r (r^2 + 2 sigma^2)/(2 pi (r^2 + sigma^2)^2) in 2D, omega x r (r^2 + 5/2 sigma^2)/"
          "(4 pi (r^2 + sigma^2)^(5/2)) in 3D; letters, and transposed, as in biot-savart",
      .target = "Tracer",
      .source = "Vortex",
      .least_dimension = 2,
      .has_energy = false,
      .in_programs = "AlgebraicBiotSavart",
      .typed = {"", "q.vorticity/(2*pi)*[separation.y, -separation.x]*(r^2 + 2*q.core^2)/(r^2 + q.core^2)^2",
                "cross(separation, q.vorticity)*(r^2 + 2.5*q.core^2)/(4*pi*(r^2 + q.core^2)^2.5)"}};

  template <class Real>
  static Real turning_2d(Real const& square, Real const& core2) {
    Real const inverse = reciprocal(square + core2);
    return (1.0 + core2 * inverse) * inverse;
  }
  template <class Real>
  static Turning<Real> turning_3d(Real const& square, Real const& core2) {
    Real const all = square + core2;
    Real const inverse = select(all > 0.0, rsqrt(all), Real(0.0));
    Real const inverse2 = inverse * inverse, more = core2 * inverse2, third = inverse2 * inverse;
    return {third * (1.0 + 1.5 * more), -third * inverse2 * (3.0 + 7.5 * more)};
  }
};

/// A Gaussian of standard deviation `core`: the vorticity of a point vortex after a time core^2 / (2 viscosity) (Lamb
/// and Oseen). An error of second order in the core.
struct GaussianCore {
  static constexpr LawText text{
      .name = "biot-savart-gaussian",
      .doc = "the same with Gaussian cores of standard deviation `core`, as viscosity makes them; of second order",
      .formula =
          "velocity Gamma e_z x r (1 - exp(-t^2))/(2 pi r^2) in 2D, omega x r (erf(t) - 2 t exp(-t^2)/sqrt(pi))/"
          "(4 pi r^3) in 3D, t = r/(sqrt(2) sigma); letters, and transposed, as in biot-savart",
      .target = "Tracer",
      .source = "Vortex",
      .least_dimension = 2,
      .has_energy = false,
      .in_programs = "GaussianBiotSavart",
      .typed = {"", "q.vorticity/(2*pi)*[separation.y, -separation.x]*(1 - exp(-r^2/(2*q.core^2)))/r^2",
                "cross(separation, q.vorticity)*(erf(r/(sqrt(2)*q.core)) - "
                "sqrt(2/pi)*r/q.core*exp(-r^2/(2*q.core^2)))/(4*pi*r^3)"}};

  template <class Real>
  static Real turning_2d(Real const& square, Real const& core2) {
    Scaled<Real> const t(square, core2);
    Real const near = t.inverse * (1.0 - t.square * (0.5 - t.square * (1.0 / 6)));  // the rest is below rounding
    return select(t.square < 1e-6, near, -expm1(-t.square) * select(square > 0.0, 1.0 / square, Real(0.0)));
  }
  template <class Real>
  static Turning<Real> turning_3d(Real const& square, Real const& core2) {
    Scaled<Real> const t(square, core2);
    Real const x = t.square, root = sqrt(x), gauss = two_over_root_pi * exp(-x);
    Real const inverse = select(square > 0.0, rsqrt(square), Real(0.0)), inverse2 = inverse * inverse;
    Real const inside = erf(root) - root * gauss, third = inverse2 * inverse;
    Turning<Real> const far{inside * third, (2.0 * x * root * gauss - 3.0 * inside) * (third * inverse2)};
    // Series of both in t^2, where differences would lose digits: sum (-t^2)^n / (n! (2 n + 3)), and its derivative.
    Real strength(0.0), slope(0.0);
    for (std::size_t n = terms; n-- > 0;) {
      if (n + 1 < terms) slope = series[n + 1] * static_cast<double>(n + 1) - slope * x;
      strength = series[n] - strength * x;
    }
    Real const scale = 2 * two_over_root_pi * t.inverse * sqrt(t.inverse);
    return {select(x < 0.3, scale * strength, far.strength),
            select(x < 0.3, -2.0 * scale * t.inverse * slope, far.slope)};
  }

 private:
  static constexpr double two_over_root_pi = 1.12837916709551257390;
  static constexpr std::size_t terms = 12;
  /// 1 / (n! (2 n + 3)).
  static constexpr std::array<double, terms> series = [] {
    std::array<double, terms> all{};
    double factorial = 1;
    for (std::size_t n = 0; n < terms; ++n) {
      if (n > 0) factorial *= static_cast<double>(n);
      all[n] = 1 / (factorial * (2 * static_cast<double>(n) + 3));
    }
    return all;
  }();
  /// t^2, limited to where the core has no effect.
  template <class Real>
  struct Scaled {
    Real inverse, square;
    Scaled(Real const& square_of_r, Real const& core2)
        : inverse(select(core2 > 0.0, 0.5 / core2, Real(0.0))),
          square(select(core2 > 0.0, min(square_of_r * inverse, Real(50.0)), Real(50.0))) {}
  };
};

/// The velocity of the fluid particle p by the vortex q; r = p - q, w the turning of q's core.
///   2D: Gamma / (2 pi) k x r w
///   3D: 1/(4 pi) omega_q x r w. If p's influence is a VortexInfluence (Inviscid, Viscous), also the rate of
///       p's vorticity: (omega_p . grad) v (Eq 3.14), or grad (omega_p . v) with omega_p fixed, its transposed form, or
///       a mixture. They agree if the vorticity has no divergence; the transposed one always conserves the sum
///       of the vorticity.
/// A positive vortex (3D: along +z) turns counterclockwise. Test particles (Tracer) carry no vorticity: use
/// one_way(BiotSavart{}) between them and vortices. The law has no energy.
template <class Core>
struct BiotSavartOf {
  double transposed = 1;  ///< fraction of the transposed form; 0: Eq 3.14, 1/2: mixed

  static constexpr LawText text = Core::text;
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&BiotSavartOf::transposed,
                    {"transposed", dimensions::none,
                     "stretching of vorticity in 3D: 1, the transposed form, keeps its sum; 0, the classic "
                     "form (omega . grad) v; 0.5, mixed",
                     NumberRange{0, 1}, "1"}}};
  }

  template <class P, class Q>
  requires requires(P const& p, Q const& q) {
    p.position;
    q.vorticity;
    q.core;
  }
  auto operator()(P const& p, Q const& q) const {
    auto const r = p.position - q.position;
    using Real = std::remove_cvref_t<decltype(r[0])>;
    Real const core2 = q.core * q.core;
    if constexpr (P::dimension == 2) {
      // Factors of the source alone are grouped, so that they are computed once for several targets.
      auto const swirl = cross(q.vorticity * (1 / (2 * pi)) * Core::turning_2d(square_above_zero(r), core2), r);
      if constexpr (std::is_same_v<typename P::Influence, ExchangeInfluence<Real>>)
        return ExchangeInfluence<Real>{swirl, {Real(0.0)}};
      else
        return swirl;
    } else {
      auto const turning = Core::turning_3d(dot(r, r), core2);
      auto const across = cross(q.vorticity, r) * (1 / (4 * pi));
      auto const swirl = across * turning.strength;
      if constexpr (std::is_same_v<typename P::Influence, VortexInfluence<Real>>)
        return VortexInfluence<Real>{
            swirl, cross(q.vorticity, p.vorticity) * (turning.strength * ((1 - 2 * transposed) / (4 * pi))) +
                       across * (turning.slope * ((1 - transposed) * dot(r, p.vorticity))) +
                       r * (turning.slope * (transposed * dot(across, p.vorticity)))};
      else
        return swirl;
    }
  }
};

using BiotSavart = BiotSavartOf<PlainCore>;
using AlgebraicBiotSavart = BiotSavartOf<AlgebraicCore>;
using GaussianBiotSavart = BiotSavartOf<GaussianCore>;

/// One of them, chosen at run time.
enum class VortexCore { plain, algebraic, gaussian };
struct VortexLaw {
  VortexCore core;
  double transposed;

  VortexLaw(BiotSavart const& law) : core(VortexCore::plain), transposed(law.transposed) {}
  VortexLaw(AlgebraicBiotSavart const& law) : core(VortexCore::algebraic), transposed(law.transposed) {}
  VortexLaw(GaussianBiotSavart const& law) : core(VortexCore::gaussian), transposed(law.transposed) {}

  /// Calls f with the law itself.
  template <class F>
  auto visit(F const& f) const {
    if (core == VortexCore::algebraic) return f(AlgebraicBiotSavart{transposed});
    if (core == VortexCore::gaussian) return f(GaussianBiotSavart{transposed});
    return f(BiotSavart{transposed});
  }
};

}  // namespace boltzmann
