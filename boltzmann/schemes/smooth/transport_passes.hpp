// Viscosity and conduction of smooth particles: passes over pairs.
//
// Around particle i the velocities are v = G_i r + rest, and G_i = W_i + S_i: a rotation and a strain, both by least
// squares. With r = x_j - x_i, v = v_j - v_i, volumes V, a kernel K that has the second moments
// Sum_j V_j K r_a r_b = delta_ab in a continuum, and the harmonic mean eta_ij of both shear viscosities, the particle
// dissipates
//   V_i Phi_i = V_i {2 c_i Sum_j V_j K eta_ij [|v - W_i r|^2 - (1 - s) |v - G_i r|^2] + (zeta_i - 2 eta_i / D) d_i^2},
//   d_i = c_i Sum_j V_j K r.v (div v),   c_i = D / Sum_j V_j K r^2,   W_i, G_i: the minima of their sums.
// In a linear flow this is 2 eta E:E + (zeta - 2 eta / D) (div v)^2 wherever second moments are isotropic: on lattices
// exactly. The rest is damped by the share s. With s = 1 only relative velocities count. In a disordered fluid this
// also damps their noise, which draws energy from the flow, so that the fluid is too viscous. With s = 0 alternating
// rows would not be damped at all: the null mode of nested gradients. Figures for several s are in
// docs/explanation/methods/continuum.md.
// Forces are the derivatives of Rayleigh's dissipation function, F_i = -d/dv_i Sum_k V_k Phi_k / 2:
//   F_ij = V_i V_j K {2 eta_ij [c_i (s v - M_i r) + c_j (s v - M_j r)] + (b_i + b_j) r},
//   M_i = W_i - (1 - s) G_i,   b_i = c_i (zeta_i - 2 eta_i / D) d_i.
// They conserve linear momentum by symmetry, and angular momentum, since Sum_j V_j K eta_ij r x (s v - M_i r) = 0 for
// each i. Particle i is heated by V_i Phi_i >= 0, so total energy is conserved and no entropy is lost.
//
// K. Mueller, D. A. Fedosov, G. Gompper (J. Comput. Phys. 281, 301, 2015) conserve angular momentum by the same friction
// between velocities v - W r, with a spin of each particle in place of the local rotation. Harmonic means and heat:
// P. W. Cleary, J. J. Monaghan (J. Comput. Phys. 148, 227, 1999), q_ij = 2 V_i V_j K kappa_ij (T_j - T_i).
#pragma once

#include <boltzmann/schemes/smooth/passes.hpp>
#include <boltzmann/schemes/smooth/smooth_point.hpp>

#include <numbers>
#include <type_traits>

namespace boltzmann {

/// s, as small as fast damping of the shortest waves allows: at 0.27 of their rate in a continuum on a square lattice
/// with ranges of 3 spacings.
inline constexpr double rest_share = 0.5;

/// The sums that determine a particle's local motion, w = V_j K eta_ij.
template <int D, class Real>
struct MotionSum {
  Real approach;            ///< Sum V_j K r.v
  Real spread;              ///< Sum V_j K r^2
  Real resistance;          ///< Sum V_j K r^2 / eta_ij
  Tensor<D, Real> flow;     ///< Sum w v_a r_b
  Tensor<D, Real> moments;  ///< Sum w r_a r_b
};
template <int D, class Real>
struct TransportSum {
  Vector<D, Real> force;  ///< per volume
  Real heating;           ///< per volume
};
template <int D, class Real>
TransportSum(Vector<D, Real>, Real) -> TransportSum<D, Real>;
/// Sum r_a F_b, symmetric part: xx, xy, xz, yy, yz, zz; F per volume.
template <int D, class Real>
struct StressSum {
  Real stress[D * (D + 1) / 2];
};

namespace detail {

/// K = norm (1 - r^2 / range^2)^4 / range^(D + 2), without a square root. Weights of the scheme's shape, w'/r, would
/// have second moments that depend more on the lattice.
template <int D>
inline constexpr double transport_norm = D == 1   ? 3465.0 / 256
                                         : D == 2 ? 60 / std::numbers::pi
                                                  : 45045 / (512 * std::numbers::pi);
template <int D, class Real>
[[gnu::always_inline]] inline Real transport_kernel(Real const& r2, Real const& inverse_range) {
  Real const inverse2 = inverse_range * inverse_range, u = max(Real(1.0 - r2 * inverse2), Real(0.0)), u2 = u * u;
  Real norm = transport_norm<D> * inverse2;
  for (int d = 0; d < D; ++d) norm = norm * inverse_range;
  return norm * u2 * u2;
}

/// V_j K of a pair; equal for both except for the volume.
template <bool variable, class P>
[[gnu::always_inline]] inline auto transport_weight(P const& p, P const& q, decltype(P::range) const& r2,
                                                    PassParameters const& parameters) {
  using Real = std::remove_cvref_t<decltype(r2)>;
  constexpr int D = P::dimension;
  if constexpr (variable)
    return 0.5 * q.volume *
           (transport_kernel<D>(r2, Real(1.0 / p.range)) + transport_kernel<D>(r2, Real(1.0 / q.range)));
  else
    return q.volume * transport_kernel<D>(r2, Real(1.0 / parameters.range));
}

template <int D, class Real>
struct ViscousPair {
  Vector<D, Real> force;  ///< on p, per volume
  Real heating;           ///< p's own part of the work, per volume
  Real conduction;        ///< heat due to the difference of temperatures
};

template <bool variable, class P>
[[gnu::always_inline]] inline auto viscous_pair(P const& p, P const& q, PassParameters const& parameters) {
  using Real = std::remove_cvref_t<decltype(p.mass)>;
  constexpr int D = P::dimension;
  auto const r = q.position - p.position, v = q.velocity - p.velocity;
  Real const weight = transport_weight<variable>(p, q, dot(r, r), parameters);
  // Twice the harmonic means, 4 / (sum of inverses), with a single division.
  Real const against_shear = p.inverse_viscosity + q.inverse_viscosity,
             against_heat = p.inverse_conductivity + q.inverse_conductivity,
             both = 4.0 / (against_shear * against_heat), drag = both * against_heat;
  auto const from_p = v * p.friction - motion_times<D>(p.motion, r);
  auto const from_q = v * q.friction - motion_times<D>(q.motion, r);
  return ViscousPair<D, Real>{
      (from_p + from_q) * (weight * drag) + r * (weight * (p.expansion_push + q.expansion_push)),
      weight * (drag * dot(from_p, v) + p.expansion_push * dot(r, v)), weight * both * against_shear};
}

}  // namespace detail

template <bool variable>
struct MotionPass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    using Real = std::remove_cvref_t<decltype(p.mass)>;
    constexpr int D = P::dimension;
    auto const r = q.position - p.position, v = q.velocity - p.velocity;
    Real const r2 = dot(r, r), weight = detail::transport_weight<variable>(p, q, r2, parameters);
    Real const resistance = 0.5 * (p.inverse_viscosity + q.inverse_viscosity), w = weight / resistance;
    MotionSum<D, Real> sum;
    sum.approach = weight * dot(r, v);
    sum.spread = weight * r2;
    sum.resistance = sum.spread * resistance;
    for (int a = 0; a < D; ++a)
      for (int b = 0; b < D; ++b) {
        sum.flow[a][b] = w * v[a] * r[b];
        sum.moments[a][b] = w * r[a] * r[b];
      }
    return sum;
  }
};

template <bool variable>
struct TransportPass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    auto const pair = detail::viscous_pair<variable>(p, q, parameters);
    return TransportSum{pair.force, pair.heating + pair.conduction * (q.temperature - p.temperature)};
  }
};

/// All rates of a fluid in one pass.
template <class Shape, bool variable, RateTerms terms, bool volumes = false>
struct FluidPass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    using Real = std::remove_cvref_t<decltype(p.mass)>;
    auto const rates = RatePass<Shape, variable, terms, volumes>{parameters}(p, q);
    auto const transport = TransportPass<variable>{parameters}(p, q);
    Real const by_density = 1.0 / p.density;
    return RateSum{rates.acceleration + transport.force * by_density, rates.heating + transport.heating * by_density,
                   rates.compression};
  }
};

template <bool variable>
struct StressPass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    using Real = std::remove_cvref_t<decltype(p.mass)>;
    constexpr int D = P::dimension;
    auto const r = q.position - p.position;
    auto const force = detail::viscous_pair<variable>(p, q, parameters).force;
    StressSum<D, Real> sum;
    int n = 0;
    for (int a = 0; a < D; ++a)
      for (int b = a; b < D; ++b) sum.stress[n++] = 0.5 * (r[a] * force[b] + r[b] * force[a]);
    return sum;
  }
};

}  // namespace boltzmann
