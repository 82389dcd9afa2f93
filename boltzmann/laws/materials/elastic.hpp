// Solids: Hooke's law for shear, von Mises' yield, failure in tension; for any equation of state.
#pragma once

#include <boltzmann/laws/material.hpp>

#include <algorithm>
#include <limits>
#include <numbers>

namespace boltzmann {

/// A tensor on all three axes: the components on the axes beyond D make the trace zero.
template <int D>
Tensor<3> on_three_axes(Tensor<D> const& a) {
  Tensor<3> result{};
  for (int i = 0; i < D; ++i)
    for (int j = 0; j < D; ++j) result[i][j] = a[i][j];
  for (int i = D; i < 3; ++i) result[i][i] = -trace(a) / (3 - D);
  return result;
}

/// The equivalent stress of von Mises, sqrt(3/2 s:s): a rod under the tension q has it equal to q.
template <int D>
double equivalent_stress(Tensor<D> const& deviatoric) {
  auto const s = on_three_axes(deviatoric);
  return sqrt(1.5 * contraction(s, s));
}

/// The largest principal value of a deviatoric symmetric tensor: 2 sqrt(J2 / 3) cos(arccos(3 sqrt(3) J3 / (2 J2^(3/2)))
/// / 3), J2 = s:s / 2, J3 the determinant.
template <int D>
double largest_principal(Tensor<D> const& deviatoric) {
  auto const s = on_three_axes(deviatoric);
  double const third = sqrt(contraction(s, s) / 6);  // sqrt(J2 / 3)
  if (!(third > 0)) return third;
  double const cosine = std::clamp(determinant(s / third) / 2, -1.0, 1.0);
  return 2 * third * cos(std::acos(cosine) / 3);
}

/// For particles with the fields of Solid. The stress s is deviatoric, positive in tension, on three axes (plane strain
/// in 2D, uniaxial strain in 1D). With E the symmetric part of the velocity gradient and W the spin:
///   ds/dt = 2 G (E - (div v / 3) I) + W.s - s.W          (Hooke and Jaumann: the stress rotates with the body)
/// and, once its equivalent stress is yield_stress, without the part that would increase it: perfect plasticity. The
/// acting strength is never more than yield_stress; stress that a finite step has stored above it relaxes within the
/// time that sound needs through the range. While the largest principal tension of the undamaged material is above
/// tensile_strength, damage d grows at 0.4 c / range (1 - d): cracks run at 0.4 of the sound speed. Tension and
/// strength are multiplied by 1 - d; a broken solid only resists compression.
///
/// The hourglass strain h (schemes/smooth/solid_passes.hpp) rotates with the body, dh/dt = W.h, and relaxes like the
/// stress: with plastic flow, and where its equivalent stress sqrt(3) G |h| is above yield_stress.
///
/// All of it is in rates, which are added to the influence; no function changes a particle. Elastic energy and the heat
/// of plastic flow enter the specific energy by the work of the stress (Eq 3), so that energy evolves also for a
/// barotropic equation of state.
template <class EquationOfState>
struct Elastic {
  static constexpr double unlimited = std::numeric_limits<double>::infinity();

  EquationOfState material;
  double shear_modulus;                 ///< G
  double yield_stress = unlimited;      ///< of a rod under tension
  double tensile_strength = unlimited;  ///< the largest principal tension before failure

  static constexpr MaterialText text{
      .name = "elastic", .doc = "strength, on any material", .formula = "ds/dt = 2 G (E - (div v / 3) I) + W.s - s.W"};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&Elastic::shear_modulus,
                    {"shear_modulus", material_dimensions::pressure, "stress by strain, in shear", positive}},
        ParameterOf{&Elastic::yield_stress,
                    {.name = "yield_stress",
                     .dimension = material_dimensions::pressure,
                     .doc = "the tension at which a rod begins to flow",
                     .range = positive,
                     .unlimited = true}},
        ParameterOf{&Elastic::tensile_strength,
                    {.name = "tensile_strength",
                     .dimension = material_dimensions::pressure,
                     .doc = "the tension at which it breaks",
                     .range = positive,
                     .unlimited = true}}};
  }

  /// Pressure and temperature of the equation of state, tension times 1 - d; the sound speed of compression waves,
  /// sqrt(c^2 + 4G / 3 rho).
  template <class P>
  State state(P const& p) const {
    State state = material.state(p);
    if (state.pressure < 0) state.pressure *= whole(p);
    state.sound_speed = sqrt(square(state.sound_speed) + 4 * shear_modulus / (3 * p.density));
    return state;
  }

  template <class P>
  Fluxes<P::dimension> fluxes(P const& p, Gradients<P::dimension> const&) const {
    static_assert(!has_fluxes<EquationOfState, P> && !has_transport<EquationOfState, P>,
                  "viscosity goes outside: Newtonian<Elastic<EquationOfState>>");
    return {p.stress * (-whole(p) * within_yield(equivalent_stress(p.stress))), {}};
  }
  /// Strength causes no diffusion.
  template <class P>
  double diffusivity(P const&) const {
    return 0;
  }

  /// Against hourglass strain: G times 1 - d, limited so that the strength is at most yield_stress.
  template <class P>
  double shear_stiffness(P const& p) const {
    return shear_modulus * whole(p) * within_yield(hourglass_stress(p));
  }

  template <class P>
  void rates(P const& p, Gradients<P::dimension> const& gradients, typename P::Influence& influence) const {
    constexpr int D = P::dimension;
    auto const& s = p.stress;
    // gradients.velocity[a][b] = d v_b / d x_a, so that the spin W_ab = (d v_a / d x_b - d v_b / d x_a) / 2 is:
    auto const spin = (transpose(gradients.velocity) - gradients.velocity) * 0.5;
    auto const strain_rate = symmetric_part(gradients.velocity);
    auto const shearing = strain_rate - Tensor<D>::identity() * (trace(strain_rate) / 3);
    auto stress_rate = shearing * (2 * shear_modulus) + dot(spin, s) - dot(s, spin);

    double const equivalent = equivalent_stress(s), crossing = state(p).sound_speed / p.range;
    double relaxation = crossing * (1 - within_yield(hourglass_stress(p)));  // of h
    if (equivalent >= yield_stress) {
      // Plastic flow is along s; dq/dt of it is -3G plastic_rate. Axes without components are not strained.
      double const outward = max(contraction(s, strain_rate), 0) / equivalent;
      double const plastic_rate = outward + (equivalent - yield_stress) * crossing / (3 * shear_modulus);
      double const of_stress = 3 * shear_modulus * plastic_rate / equivalent;
      stress_rate -= s * of_stress;
      relaxation += of_stress;
      influence.plastic_rate += plastic_rate;
    }
    influence.stress_rate += stress_rate;
    influence.hourglass_rate += dot(spin, p.hourglass_strain) - p.hourglass_strain * relaxation;
    if (tensile_strength < unlimited) {
      double const tension = within_yield(equivalent) * largest_principal(s) - material.state(p).pressure;
      if (tension > tensile_strength) influence.damage_rate += 0.4 * crossing * whole(p);
    }
  }

  double specific_heat() const requires requires(EquationOfState const& m) { m.specific_heat(); }
  { return material.specific_heat(); }

  void check() const { check_parameters(material); }

 private:
  template <class P>
  static double whole(P const& p) {
    return std::clamp(1 - p.damage, 0.0, 1.0);
  }
  template <class P>
  double hourglass_stress(P const& p) const {
    return std::numbers::sqrt3 * shear_modulus * std::sqrt(norm2(p.hourglass_strain));
  }
  double within_yield(double equivalent) const { return equivalent > yield_stress ? yield_stress / equivalent : 1; }
};

}  // namespace boltzmann
