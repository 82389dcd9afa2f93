// Strength of solids as passes over pairs: gradients that are exact for linear motion, and hourglass control.
//
// Correction. The velocity gradient of smooth particles is too small where neighbours are missing, at free surfaces.
// With r = x_j - x_i, V = m / rho and s_ij = -V_j w'(r) / r:
//
//   G_i = Sum_j s_ij r (v_j - v_i),   B_i = Sum_j s_ij r r,   the corrected gradient is L_i . G_i with L = 1 / B
//
// (Bonet and Lok, Comput. Methods Appl. Mech. Eng. 180, 97, 1999). Forces use L . P in place of P, so that they do the
// work P : (L . G). L is bounded where B is nearly singular, in splinters.
//
// Hourglass control. G and the forces vanish for motion that alternates from one particle to the next, so rows of a
// solid would slide past each other freely. The control is that of Flanagan and Belytschko (Int. J. Numer. Methods
// Eng. 17, 679, 1981) in its elastic form, with the neighbourhood of a particle in place of a finite element;
// Ganzenmueller (Comput. Methods Appl. Mech. Eng. 286, 87, 2015) measures the same departure from linear motion, pair
// by pair. With the spacing d = V^(1/D):
//
//   c_ij = (a / d_i) phi(|r| / d_i) (1 - b_i . r),   b_i so that Sum_j c_ij r = 0
//   dh_i/dt = Sum_j c_ij (v_i - v_j) + W_i . h_i - relaxation      h: the hourglass strain
//   F_i = -Sum_j (c_ij V_i G_i h_i - c_ji V_j G_j h_j)             from the energy V G h^2 / 2, G the shear modulus
//
// A linear velocity field causes no hourglass strain, because Sum c r = 0. For the same reason these forces have no
// torque. All forces conserve momentum. Their work is added to the specific energy, so that total energy is conserved.
#pragma once

#include <boltzmann/schemes/smooth/passes.hpp>

namespace boltzmann {

namespace detail {
/// Padding to the next block after SmoothMatter.
template <int D, class Real>
struct BehindMatter : Unread<to_next_block<sizeof(SmoothMatter<D>) / sizeof(double)>, Real> {};
}  // namespace detail

/// The data of a smooth particle for strength, after all others.
template <int D, class Real = double>
struct SmoothSolid : SmoothMatter<D, Real>, detail::BehindMatter<D, Real> {
  Real inverse_spacing;
  Real intact;  ///< weight as a neighbour in hourglass control: 1 intact, 0 broken or without a shear modulus
  Real volume;
  Vector<D, Real> middle_velocity;  ///< at the half step, for strain
  Real unread_here[(8 - 3 - D)];
  Vector<D, Real> moment;      ///< V G h, times a
  Vector<D, Real> tilt;        ///< b
  Tensor<D, Real> correction;  ///< V (L . P - P)
};

template <int D, class Real>
struct SolidSum {
  Tensor<D, Real> gradient;  ///< G
  Tensor<D, Real> spread;    ///< B
  // With the weight phi / spacing:
  Real weight;
  Vector<D, Real> offset;         ///< of r
  Vector<D, Real> velocity;       ///< of v_p - v_q
  Tensor<D, Real> near_spread;    ///< of r r
  Tensor<D, Real> near_gradient;  ///< of r (v_p - v_q)
};
template <int D, class Real>
SolidSum(Tensor<D, Real>, Tensor<D, Real>, Real, Vector<D, Real>, Vector<D, Real>, Tensor<D, Real>, Tensor<D, Real>)
    -> SolidSum<D, Real>;

/// phi(x) = (1 - x / reach)^4, and a. Both are chosen so that plane shear waves in which adjacent planes of particles
/// move against each other have the frequency sqrt(G / rho) k, for the square, hexagonal, simple cubic and face-centred
/// cubic lattice at once. The guide lists the deviations.
struct HourglassStencil {
  template <int D>
  static constexpr double reach = D == 2 ? 2.35 : 2.45;  ///< in spacings
  template <int D>
  static constexpr double scale = D == 2 ? 4.846 : 2.778;
  /// An upper bound of the sum of phi over the neighbours in a lattice. Larger sums are scaled down to it, so that the
  /// control is not stiffer for crowded particles.
  template <int D>
  static constexpr double crowd = D == 2 ? 0.6 : 1.3;
};

namespace detail {

/// phi of q with the weight of p, divided by p's spacing; zero for fluids and broken particles.
template <class P, class Real>
[[gnu::always_inline]] inline Real hourglass_weight(P const& p, P const& q, Real const& distance) {
  Real const u = max(Real(1.0 - distance * p.inverse_spacing * (1 / HourglassStencil::reach<P::dimension>)), Real(0.0)),
             u2 = u * u;
  return q.intact * p.inverse_spacing * u2 * u2;
}

}  // namespace detail

template <class Shape, bool variable>
struct SolidSumPass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    using Real = std::remove_cvref_t<decltype(p.mass)>;
    auto const r = q.position - p.position, v = p.middle_velocity - q.middle_velocity;
    auto const r2 = dot(r, r);
    Real const slope = detail::weigh_by<Shape, variable>(p, r2, parameters).slope;
    auto const smooth = r * (q.volume * slope);
    Real const weight = detail::hourglass_weight(p, q, Real(r2 * rsqrt(max(r2, Real(1e-280)))));
    auto const near = r * weight;
    return SolidSum{outer(smooth, v), outer(smooth, -r), weight, near, v * weight, outer(near, r), outer(near, v)};
  }
};

template <int D, class Real>
struct SolidForce {
  Vector<D, Real> force;  ///< on p
  Real heating;           ///< of p: energy that its strain removes from the motion
};
template <int D, class Real>
SolidForce(Vector<D, Real>, Real) -> SolidForce<D, Real>;

template <class Shape, bool variable>
struct SolidForcePass {
  PassParameters parameters;

  template <class P>
  auto operator()(P const& p, P const& q) const {
    using Real = std::remove_cvref_t<decltype(p.mass)>;
    auto const r = q.position - p.position;
    auto const r2 = dot(r, r);
    Real const slope_p = detail::weigh_by<Shape, variable>(p, r2, parameters).slope;
    Real slope_q = slope_p;
    if constexpr (variable) slope_q = detail::weigh_by<Shape, variable>(q, r2, parameters).slope;
    Real const distance = r2 * rsqrt(max(r2, Real(1e-280)));
    Real const of_p = detail::hourglass_weight(p, q, distance) * (1.0 - dot(p.tilt, r));
    Real const of_q = detail::hourglass_weight(q, p, distance) * (1.0 + dot(q.tilt, r));
    auto const from_p = dot(r, p.correction) * (slope_p * q.volume) - p.moment * of_p;
    auto const from_q = dot(r, q.correction) * (slope_q * p.volume) + q.moment * of_q;
    return SolidForce{from_p + from_q, dot(from_p, q.velocity - p.velocity)};
  }
};

}  // namespace boltzmann
