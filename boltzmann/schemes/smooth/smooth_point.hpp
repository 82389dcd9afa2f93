// Smooth points: the data of smooth particles that passes over pairs read, independent of class and ensemble. Each
// further struct of the chain begins a new block of the row, so that blocks that a pass does not read are never loaded.
#pragma once

#include <boltzmann/core/tensor.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/rows.hpp>

namespace boltzmann {

namespace detail {
/// Padding of n numbers.
template <int n, class Real>
struct Unread {
  Real unread[n];
};
template <class Real>
struct Unread<0, Real> {};
/// Padding to the next block, after this number of doubles.
template <int numbers>
inline constexpr int to_next_block = (static_cast<int>(row_block) - numbers % static_cast<int>(row_block)) %
                                     static_cast<int>(row_block);
}  // namespace detail

/// Position: known before the first pass. Sums are not stored here; they are in the order of rows.
template <int D, class Real = double>
struct SmoothPlace : Newton<D, Real> {
  static constexpr char const* class_name = "smooth point";
  struct Influence {};
  Real range;

  static FieldTable fields() {
    return Newton<D, Real>::fields().add(&SmoothPlace::range, "range", dimensions::length,
                                         "radius beyond which its weight is zero");
  }
};

/// Density and state. With grad-h factors (variable ranges), `push` includes them.
template <int D, class Real = double>
struct SmoothFluid : SmoothPlace<D, Real>, detail::Unread<detail::to_next_block<2 * D + 2>, Real> {
  Real density;
  Real push;  ///< P / rho^2
  Real temperature;
  Real sound_speed;
};

/// The input of viscosity and conduction, two blocks: resistances, and the local motion from the motion pass.
template <int D, class Real = double>
struct SmoothTransport : SmoothFluid<D, Real> {
  Real volume;                ///< mass / density
  Real inverse_viscosity;     ///< 1 / shear viscosity; unlimited_resistance if it is zero
  Real inverse_conductivity;  ///< 1 / (normaliser * conductivity); likewise
  Real expansion_push;        ///< bulk viscosity times the local rate of expansion
  Real friction;              ///< c s: weight of neighbours' velocities
  Real motion[D * D];         ///< c (W - (1 - s) G): weight of the local motion, by rows
  Real unread_here[(3 - D * D % 4) % 4];
};
/// Instead of infinity, whose product with zero would be NaN.
inline constexpr double unlimited_resistance = 1e100;

/// Results of gradients: fluxes beyond the pressure, divided by rho^2 like all fluxes.
template <int D, class Real = double>
struct SmoothMatter : SmoothTransport<D, Real> {
  Real shear_switch;             ///< Balsara's: 1 in compression, near 0 in shear
  Real stress[D * (D + 1) / 2];  ///< of the pressure tensor: xx, xy, xz, yy, yz, zz
  Vector<D, Real> heat;
};

/// A tensor, in the layout of SmoothTransport, times a vector.
template <int D, class Real>
[[gnu::always_inline]] inline Vector<D, Real> motion_times(Real const* motion, Vector<D, Real> const& r) {
  Vector<D, Real> v;
  for (int a = 0; a < D; ++a) {
    v[a] = motion[D * a] * r[0];
    for (int b = 1; b < D; ++b) v[a] = v[a] + motion[D * a + b] * r[b];
  }
  return v;
}

/// A symmetric tensor, in the layout of SmoothMatter, times a vector.
template <int D, class Real>
[[gnu::always_inline]] inline Vector<D, Real> stress_times(Real const* stress, Vector<D, Real> const& r) {
  if constexpr (D == 1)
    return {stress[0] * r[0]};
  else if constexpr (D == 2)
    return {stress[0] * r[0] + stress[1] * r[1], stress[1] * r[0] + stress[2] * r[1]};
  else
    return {stress[0] * r[0] + stress[1] * r[1] + stress[2] * r[2],
            stress[1] * r[0] + stress[3] * r[1] + stress[4] * r[2],
            stress[2] * r[0] + stress[4] * r[1] + stress[5] * r[2]};
}

}  // namespace boltzmann
