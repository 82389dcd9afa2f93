// The law of Biot and Savart: vortices carry fluid particles and each other (section 3.7 of the 1990 thesis).
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>
#include <boltzmann/particles/vortex.hpp>

namespace boltzmann {

/// The velocity that vortex q gives to the fluid particle p; r = p - q.
///   2D: Gamma / (2 pi) k x r / max(r, core)^2: solid rotation inside the core, zero at its centre, a point vortex
///       outside. (C.20 has the speed of the rim everywhere inside, and no value at the centre.)
///   3D: -1/(4 pi) r x omega / s^3, s^2 = r^2 + core^2. Where p's influence is a VortexInfluence (Inviscid, Viscous),
///       also what the flow does to p's vorticity (Eq 3.14):
///       (omega_p . grad) v = 1/(4 pi) [omega_q x omega_p / s^3 - 3 (r . omega_p) omega_q x r / s^5].
/// A positive vortex (3D: along +z) turns counterclockwise. Test particles (Tracer) carry no vorticity: use
/// one_way(BiotSavart{}) between them and vortices. There is no energy.
struct BiotSavart {
  static constexpr LawText text{
      .name = "biot-savart",
      .doc = "vortices carry fluid particles and each other; regularised inside the core of the source",
      .formula =
          "velocity Gamma k x r/(2 pi max(r, core)^2) in 2D, -r x omega/(4 pi (r^2 + core^2)^(3/2)) in 3D, "
          "which also stretches the vorticity of Inviscid and Viscous",
      .target = "Tracer",
      .source = "Vortex",
      .least_dimension = 2,
      .has_energy = false};
  static constexpr auto parameters() { return std::tuple{}; }

  template <class P, class Q>
  requires requires(P const& p, Q const& q) {
    p.position;
    q.vorticity;
    q.core;
  }
  auto operator()(P const& p, Q const& q) const {
    auto const r = p.position - q.position;
    using Real = std::remove_cvref_t<decltype(r[0])>;
    if constexpr (P::dimension == 2) {
      Real const square = max(dot(r, r), q.core * q.core);
      Real const inverse = select(square > 0.0, 1.0 / square, Real(0.0));
      return cross(q.vorticity, r) * (1 / (2 * pi) * inverse);
    } else {
      Real const square = dot(r, r) + q.core * q.core;
      Real const inverse = select(square > 0.0, rsqrt(square), Real(0.0));
      Real const inverse2 = inverse * inverse;
      Real const weight = 1 / (4 * pi) * (inverse2 * inverse);
      auto const swirl = cross(q.vorticity, r) * weight;
      if constexpr (std::is_same_v<typename P::Influence, VortexInfluence<Real>>)
        return VortexInfluence<Real>{
            swirl, cross(q.vorticity, p.vorticity) * weight - swirl * (3.0 * inverse2 * dot(r, p.vorticity))};
      else
        return swirl;
    }
  }
};

}  // namespace boltzmann
