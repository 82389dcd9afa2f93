// Smooth points: what passes over pairs read of smooth particles, whatever class and ensemble they are of. Each further
// struct of the chain begins a new block of the row, so that what a pass does not read is in nobody's way.
#pragma once

#include <boltzmann/core/tensor.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/particles/rows.hpp>

namespace boltzmann {

namespace detail {
/// So many numbers that nobody reads.
template <int n, class Real>
struct Unread {
  Real unread[n];
};
template <class Real>
struct Unread<0, Real> {};
/// Up to the next block, behind so many numbers.
template <int numbers>
inline constexpr int to_next_block = (static_cast<int>(row_block) - numbers % static_cast<int>(row_block)) %
                                     static_cast<int>(row_block);
}  // namespace detail

/// A place: known before the first pass. Nothing is summed for it: sums stand in the order of rows.
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

/// And what density and state say. With grad-h factors (variable ranges) they are in `push`.
template <int D, class Real = double>
struct SmoothFluid : SmoothPlace<D, Real>, detail::Unread<detail::to_next_block<2 * D + 2>, Real> {
  Real density;
  Real push;  ///< P / rho^2
  Real temperature;
  Real sound_speed;
};

/// And what viscosity and conduction read, two blocks: resistances, and the local motion that the motion pass finds.
template <int D, class Real = double>
struct SmoothTransport : SmoothFluid<D, Real> {
  Real volume;                ///< mass / density
  Real inverse_viscosity;     ///< 1 / shear viscosity; unlimited_resistance where there is none
  Real inverse_conductivity;  ///< 1 / (normaliser * conductivity); likewise
  Real expansion_push;        ///< what bulk viscosity makes of the local rate of expansion
  Real friction;              ///< c s: what velocities of neighbours count
  Real motion[D * D];         ///< c (W - (1 - s) G): what the local motion counts, by rows
  Real unread_here[(3 - D * D % 4) % 4];
};
/// Instead of infinity, whose products with zero would not be numbers.
inline constexpr double unlimited_resistance = 1e100;

/// And what gradients make of it: fluxes beyond the pressure, divided by rho^2 as all of them.
template <int D, class Real = double>
struct SmoothMatter : SmoothTransport<D, Real> {
  Real shear_switch;             ///< Balsara's: 1 in compression, near 0 in shear
  Real stress[D * (D + 1) / 2];  ///< of the pressure tensor: xx, xy, xz, yy, yz, zz
  Vector<D, Real> heat;
};

/// A tensor, as SmoothTransport holds it, times a vector.
template <int D, class Real>
[[gnu::always_inline]] inline Vector<D, Real> motion_times(Real const* motion, Vector<D, Real> const& r) {
  Vector<D, Real> v;
  for (int a = 0; a < D; ++a) {
    v[a] = motion[D * a] * r[0];
    for (int b = 1; b < D; ++b) v[a] = v[a] + motion[D * a + b] * r[b];
  }
  return v;
}

/// A symmetric tensor, as SmoothMatter holds it, times a vector.
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
