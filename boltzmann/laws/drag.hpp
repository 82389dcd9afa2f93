// Drag: friction against a medium at rest.
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// F = -friction v: velocities decay as exp(-friction t / m).
struct Drag {
  static constexpr bool velocity_dependent = true;

  double friction;

  template <class P>
  requires requires(P const& p) { p.velocity; }
  auto operator()(P const& p) const { return p.velocity * -friction; }

  void check() const { check_parameter("drag", "friction", friction, AllowedRange::non_negative); }
};

}  // namespace boltzmann
