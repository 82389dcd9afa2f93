// Sums over vortices besides velocities: velocity gradients at a place, and, at vortices, the vorticity and the
// potentials for energies. Private to this module.
#pragma once

#include <boltzmann/laws/vortex.hpp>

#include <type_traits>

namespace boltzmann {

/// Functions of a core besides the velocity laws of Biot and Savart, where cores are documented. For elements with
/// different cores, `core2` is their combined value.
///   density_2d: the vorticity of a unit circulation; stream_2d: G, with the velocity of a vortex k x grad G and
///   -G'= q / (2 pi r), so that G = -ln r / (2 pi) outside of the core.
///   energy_3d: of -grad^2 grad^2 B = vorticity and G = -grad^2 B, G + B'/r and (B'' - B'/r) / r^2, the
///   terms of the vector potential without its divergent part (G. S. Winckelmans and A. Leonard 1993).
template <class Core>
struct CoreSums;

template <class Real>
struct EnergyTurning {
  Real along, across;
};

template <>
struct CoreSums<PlainCore> {
  template <class Real>
  static Real density_2d(Real const& square, Real const& core2) {
    return select(square < core2, 1 / pi / max(core2, Real(1e-300)), Real(0.0));
  }
  template <class Real>
  static Real stream_2d(Real const& square, Real const& core2) {
    Real const larger = max(square, core2);
    Real const found = log(larger) + min(square / max(core2, Real(1e-300)), Real(1.0)) - 1.0;
    return select(larger > 0.0, found * (-1 / (4 * pi)), Real(0.0));
  }
  template <class Real>
  static EnergyTurning<Real> energy_3d(Real const& square, Real const& core2) {
    Real const inverse = select(square + core2 > 0.0, rsqrt(square + core2), Real(0.0));
    // r B' = -r^2 g(x) / (4 pi core), x = r / core, x^3 g = (x sqrt(1 + x^2) - asinh x) / 2.
    Real const inverse_core = select(core2 > 0.0, rsqrt(core2), Real(0.0));
    Real const x2 = min(square * inverse_core * inverse_core, Real(1e16)), x = sqrt(x2), s = sqrt(1.0 + x2);
    Real near = 0.0;  // sum C(-1/2, n) x^2n / (2 n + 3)
    Real const small = min(x2, Real(0.0625));
    double coefficient[14];
    coefficient[0] = 1;
    for (int n = 1; n < 14; ++n) coefficient[n] = coefficient[n - 1] * (0.5 - n) / n;
    for (int n = 13; n >= 0; --n) near = coefficient[n] / (2.0 * n + 3) + small * near;
    Real const far = (x * s - log(x + s)) / (2.0 * max(x2 * x, Real(1e-6)));
    Real const slope = select(core2 > 0.0, select(x2 < 0.0625, near, far) * inverse_core, 0.5 * inverse);  // -4 pi B'/r
    Real const inverse_square = select(square > 0.0, 1.0 / square, Real(0.0));
    return {(inverse - slope) * (1 / (4 * pi)), (3.0 * slope - inverse) * inverse_square * (1 / (4 * pi))};
  }
};

template <>
struct CoreSums<AlgebraicCore> {
  template <class Real>
  static Real density_2d(Real const& square, Real const& core2) {
    Real const all = square + core2, inverse = select(all > 0.0, 1.0 / all, Real(0.0));
    return (2 / pi) * core2 * core2 * inverse * inverse * inverse;
  }
  template <class Real>
  static Real stream_2d(Real const& square, Real const& core2) {
    Real const all = square + core2;
    return select(all > 0.0, (log(all) - core2 / all) * (-1 / (4 * pi)), Real(0.0));
  }
  template <class Real>
  static EnergyTurning<Real> energy_3d(Real const& square, Real const& core2) {
    Real const all = square + core2, inverse = select(all > 0.0, rsqrt(all), Real(0.0)),
               cube = inverse * inverse * inverse;
    return {(all + core2) * cube * (1 / (8 * pi)), cube * (1 / (8 * pi))};
  }
};

template <>
struct CoreSums<GaussianCore> {
  template <class Real>
  static Real density_2d(Real const& square, Real const& core2) {
    Real const inverse = select(core2 > 0.0, 0.5 / core2, Real(0.0));
    return inverse * (1 / pi) * exp(-min(square * inverse, Real(700.0)));
  }
  template <class Real>
  static Real stream_2d(Real const& square, Real const& core2) {
    // ln r^2 + E1(x), x = r^2 / (2 core^2): finite in the centre.
    Real const from = max(square, core2 * 1e-20), x = from * select(core2 > 0.0, 0.5 / core2, Real(1e300));
    Real const found = log(from) + select(x < 700.0, exponential_integral(min(x, Real(700.0))), Real(0.0));
    return select(from > 0.0, found * (-1 / (4 * pi)), Real(0.0));
  }
  template <class Real>
  static EnergyTurning<Real> energy_3d(Real const& square, Real const& core2) {
    // G = erf(t) / (4 pi r), -4 pi B'/r = [(1 - 1 / (2 t^2)) erf t + exp(-t^2) / (sqrt(pi) t)] / (2 r), t = r / (sqrt2 core).
    Real const inverse_core = select(core2 > 0.0, sqrt(0.5 / core2), Real(0.0));
    Real const x = select(core2 > 0.0, min(square * inverse_core * inverse_core, Real(50.0)), Real(50.0)), t = sqrt(x);
    Real const inverse = select(square > 0.0, rsqrt(square), Real(0.0)), gauss = exp(-x);
    Real const inside = erf(t), far_value = inside * inverse;
    Real const far_slope =
        ((1.0 - core2 * inverse * inverse) * inside + gauss * root_of_pi * rsqrt(max(x, Real(0.01)))) * 0.5 * inverse;
    // Series in t^2 near the centre: sum (-x)^n / (n! (2 n + 1)) 2 / sqrt(pi), and the same over (2 n + 3).
    Real value(0.0), slope(0.0), curve(0.0);
    Real const small = min(x, Real(1.0));
    double factorial = 1;
    for (int n = 1; n < terms; ++n) factorial *= n;
    for (int n = terms; n-- > 0;) {
      double const one = 1 / (factorial * (2 * n + 1));
      value = one - value * small, slope = one / (2 * n + 3) - slope * small;
      // (B'' - B'/r) / r^2 comes from -(3 slope - value) / x: sum -(-x)^(n - 1) 2 n / (n! (2 n + 1) (2 n + 3)).
      if (n > 0) curve = 2 * n * one / (2 * n + 3) - curve * small;
      if (n > 0) factorial /= n;
    }
    Real const scale = 2 * root_of_pi * inverse_core, inverse_square = inverse * inverse;
    auto const is_near = x < 1.0;
    Real const v = select(is_near, scale * value, far_value), b = select(is_near, scale * slope, far_slope);
    Real const c = select(is_near, scale * inverse_core * inverse_core * curve, (3.0 * b - v) * inverse_square);
    return {(v - b) * (1 / (4 * pi)), c * (1 / (4 * pi))};
  }

 private:
  static constexpr double root_of_pi = 0.56418958354775628695;  // its inverse
  static constexpr int terms = 18;
};

/// The flow at a place: in 2D velocity and vorticity, in 3D velocity and its gradient, slope[a] the gradient of
/// component a.
template <int D, class Real>
struct SlopedFlow;
template <class Real>
struct SlopedFlow<2, Real> {
  Vector<2, Real> velocity;
  Real vorticity;
};
template <class Real>
struct SlopedFlow<3, Real> {
  Vector<3, Real> velocity;
  Vector<3, Real> slope[3];
};

template <class Core>
struct SlopesOf {
  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const r = p.position - q.position;
    using Real = std::remove_cvref_t<decltype(r[0])>;
    Real const square = dot(r, r), core2 = q.core * q.core;
    SlopedFlow<P::dimension, Real> flow;
    if constexpr (P::dimension == 2) {
      flow.velocity = cross(q.vorticity * (1 / (2 * pi)) * Core::turning_2d(square_above_zero(r), core2), r);
      flow.vorticity = q.vorticity[0] * CoreSums<Core>::density_2d(square, core2);
    } else {
      auto const turning = Core::turning_3d(square, core2);
      auto const omega = q.vorticity * (1 / (4 * pi));
      auto const across = cross(omega, r), turned = omega * turning.strength;
      flow.velocity = across * turning.strength;
      for (int a = 0; a < 3; ++a) flow.slope[a] = r * (across[a] * turning.slope);
      flow.slope[0][1] -= turned[2], flow.slope[0][2] += turned[1];
      flow.slope[1][2] -= turned[0], flow.slope[1][0] += turned[2];
      flow.slope[2][0] -= turned[1], flow.slope[2][1] += turned[0];
    }
    return flow;
  }
};

/// At vortices. vorticity: of the flow with its cores; of_both: the same, averaged also over the core of the target;
/// potential: its product with the vorticity is twice the energy of a vortex.
template <int D, class Real>
struct FlowSums;
template <class Real>
struct FlowSums<2, Real> {
  Real vorticity, of_both, potential;
};
template <class Real>
struct FlowSums<3, Real> {
  Vector<3, Real> spread;  ///< the vorticity of the elements themselves, including its divergence
  Vector<3, Real> vorticity, of_both, potential;
};

template <class Core>
struct SumsOf {
  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const r = p.position - q.position;
    using Real = std::remove_cvref_t<decltype(r[0])>;
    Real const square = dot(r, r), core2 = q.core * q.core, both = core2 + p.core * p.core;
    // The convolution of two Gaussians is a Gaussian; for other cores use one core of the mean square.
    constexpr bool gaussian = std::is_same_v<Core, GaussianCore>;
    FlowSums<P::dimension, Real> sums;
    if constexpr (P::dimension == 2) {
      sums.vorticity = q.vorticity[0] * CoreSums<Core>::density_2d(square, core2);
      sums.of_both = q.vorticity[0] * CoreSums<Core>::density_2d(square, both * (gaussian ? 1 : 0.5));
      sums.potential = q.vorticity[0] * CoreSums<Core>::stream_2d(square, both * 0.5);  // Hamilton's function
    } else {
      Real const shared = both * (gaussian ? 1 : 0.5);
      auto const turning = Core::turning_3d(square, core2);
      Real const along = dot(r, q.vorticity);
      sums.spread = q.vorticity * ((3.0 * turning.strength + square * turning.slope) * (1 / (4 * pi)));
      sums.vorticity = curl(turning, square, along, r, q.vorticity);
      sums.of_both = curl(Core::turning_3d(square, shared), square, along, r, q.vorticity);
      auto const energy = CoreSums<Core>::energy_3d(square, shared);
      sums.potential = q.vorticity * energy.along + r * (along * energy.across);
    }
    return sums;
  }

 private:
  template <class Real>
  static Vector<3, Real> curl(Turning<Real> const& turning, Real const& square, Real const& along,
                              Vector<3, Real> const& r, Vector<3, Real> const& omega) {
    return omega * ((2.0 * turning.strength + square * turning.slope) * (1 / (4 * pi))) -
           r * (along * turning.slope * (1 / (4 * pi)));
  }
};

}  // namespace boltzmann
