// Newton: classical particles, driven by a force (section 3.4).
#pragma once

#include <boltzmann/particles/particle.hpp>

namespace boltzmann {

/// A classical particle; its influence is a force.
template <int D, class Real = double>
struct Newton : Particle<D, Real> {
  static constexpr char const* class_name = "Newton";

  Real mass;
  Vector<D, Real> velocity;

  /// Newton's law (Eq 3.5, 3.6): dr/dt = v, dv/dt = F / m.
  static void equations(auto const& p, auto const& force, auto const& rate) {
    rate(&Newton::position, p.velocity);
    rate(&Newton::velocity, force * (1 / p.mass));
  }

  static FieldTable fields() {
    return Particle<D, Real>::fields()
        .add(&Newton::mass, "mass", dimensions::mass, "inertial mass")
        .add(&Newton::velocity, "velocity", dimensions::velocity, "rate of change of the position");
  }
};

}  // namespace boltzmann
