// Tracer: fluid particles, driven by a velocity field (section 3.6).
#pragma once

#include <boltzmann/particles/particle.hpp>

namespace boltzmann {

/// A fluid particle; its influence is a velocity.
template <int D, class Real = double>
struct Tracer : Particle<D, Real> {
  static constexpr char const* class_name = "Tracer";

  /// Eq 3.8: dr/dt = v, the velocity field at the particle.
  static void equations(auto const&, auto const& velocity, auto const& rate) { rate(&Tracer::position, velocity); }
};

}  // namespace boltzmann
