// Smooth particles: pieces of a continuum, each spread over its range (Hoover and Hoover's SPAM).
#pragma once

#include <boltzmann/core/tensor.hpp>
#include <boltzmann/particles/newton.hpp>

namespace boltzmann {

/// The influence of other smooth particles on one: a force, and the rates of its fields.
template <int D, class Real>
struct SmoothInfluence {
  Vector<D, Real> force;
  Real heating;       ///< m de/dt, e the internal energy per mass
  Real density_rate;  ///< where density evolves by continuity; else zero
  Real range_rate;    ///< where ranges follow the density; else zero
};

/// A piece of a continuum. Mass, velocity and specific energy are state; the scheme computes density, pressure,
/// temperature and sound speed from its neighbours and its material. They are current whenever an observer reads them.
template <int D, class Real = double>
struct Smooth : Newton<D, Real> {
  static constexpr char const* class_name = "Smooth";
  static constexpr bool velocity_dependent = true;
  using Influence = SmoothInfluence<D, Real>;

  Real specific_energy;  ///< internal energy per mass
  Real range;            ///< of its weight function, which is zero beyond
  Real density;
  Real pressure;  ///< equation of state only: without viscosity and strength
  Real temperature;
  Real sound_speed;

  /// Eq 1 to 3: dr/dt = v, dv/dt = F/m, de/dt = heating/m.
  static void equations(auto const& p, auto const& influence, auto const& rate) {
    auto const inverse_mass = 1 / p.mass;
    rate(&Smooth::position, p.velocity);
    rate(&Smooth::velocity, influence.force * inverse_mass);
    rate(&Smooth::specific_energy, influence.heating * inverse_mass);
    rate(&Smooth::density, influence.density_rate);
    rate(&Smooth::range, influence.range_rate);
  }

  static FieldTable fields() {
    return Newton<D, Real>::fields()
        .add(&Smooth::specific_energy, "specific_energy", dimensions::velocity * dimensions::velocity,
             "internal energy per mass")
        .add(&Smooth::range, "range", dimensions::length, "radius beyond which its weight is zero")
        .add(&Smooth::density, "density", dimensions::mass / pow(dimensions::length, D), "mass density")
        .add(&Smooth::pressure, "pressure", dimensions::energy / pow(dimensions::length, D), "pressure of its state")
        .add(&Smooth::temperature, "temperature", dimensions::temperature, "temperature")
        .add(&Smooth::sound_speed, "sound_speed", dimensions::velocity, "speed of sound");
  }
};

/// The influence on a piece of a solid: its stress also rotates and grows.
template <int D, class Real>
struct SolidInfluence : SmoothInfluence<D, Real> {
  Tensor<D, Real> stress_rate;
  Real plastic_rate;
  Real damage_rate;
  Vector<D, Real> hourglass_rate;
  Vector<D, Real> inner_force;  ///< the part of the force whose work becomes heat
  Real is_completed;            ///< not 0: the scheme advances the fields that lag, see Solid
};

/// A piece of a solid: it remembers how it has been sheared.
template <int D, class Real = double>
struct Solid : Smooth<D, Real> {
  static constexpr char const* class_name = "Solid";
  using Influence = SolidInfluence<D, Real>;

  Tensor<D, Real> stress;  ///< deviatoric, positive in tension. In 2D and 1D the other axes have the rest of it (plane,
                           ///< uniaxial strain), so that its trace over three axes is zero.
  Real plastic_strain;     ///< equivalent, accumulated
  Real damage;             ///< 0 whole, 1 broken: no tension, no shear
  Vector<D, Real> hourglass_strain;  ///< deviation from the linear motion of its neighbours, in spacings

  // Inside a step of leap-frog only, else 0. Strain follows from velocities as positions do. Leap-frog is stable if it
  // advances stress like positions: by the velocities of the half step, before the forces at the end of the step. If
  // is_completed is set, leap-frog leaves that to the scheme, which computes rates from velocity - kick.
  Vector<D, Real> kick;  ///< the velocity minus that of the half step
  Real lag;              ///< the time by which the fields that lag() are late; the scheme clears it
  Real ahead;            ///< the specific energy that forces see, minus leap-frog's own prediction
  /// True for the fields that follow from strain.
  template <class Member>
  static constexpr bool lags(Member member) {
    if constexpr (std::is_same_v<Member, decltype(&Solid::density)>)
      return member == static_cast<Member>(&Solid::density);
    else
      return std::is_same_v<Member, decltype(&Solid::stress)> || std::is_same_v<Member, decltype(&Solid::damage)> ||
             std::is_same_v<Member, decltype(&Solid::hourglass_strain)>;
  }

  /// Replaces the heat of a time by that for velocities that differ by `change` from those of the heating. Its sum over
  /// all particles is minus the work on the motion, so that total energy is conserved to rounding.
  void correct_heat(Influence const& influence, Vector<D, Real> const& change, Real time) {
    this->specific_energy -= dot(influence.inner_force, change) * time / this->mass;
  }

  static void equations(auto const& p, auto const& influence, auto const& rate) {
    Smooth<D, Real>::equations(p, influence, rate);
    rate(&Solid::stress, influence.stress_rate);
    rate(&Solid::plastic_strain, influence.plastic_rate);
    rate(&Solid::damage, influence.damage_rate);
    rate(&Solid::hourglass_strain, influence.hourglass_rate);
  }

  static FieldTable fields() {
    return Smooth<D, Real>::fields()
        .add(&Solid::stress, "stress", dimensions::energy / pow(dimensions::length, D), "deviatoric stress")
        .add(&Solid::plastic_strain, "plastic_strain", dimensions::none, "equivalent plastic strain")
        .add(&Solid::damage, "damage", dimensions::none, "0 whole, 1 broken")
        .add(&Solid::hourglass_strain, "hourglass_strain", dimensions::none,
             "strain between neighbouring particles that smooth gradients do not see");
  }
};

}  // namespace boltzmann
