// Uniform fields from outside: weight, an electric field, a background flow.
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>
#include <boltzmann/particles/vortex.hpp>

namespace boltzmann {

/// F = m g, energy -m g . x.
template <int D>
struct UniformGravity {
  static constexpr bool uniform = true;
  Vector<D> acceleration;

  template <class P>
  requires requires(P const& p) { p.mass; }
  auto operator()(P const& p) const {
    auto const force = acceleration * p.mass;
    return Interaction{force, -dot(force, p.position)};
  }

  void check() const {
    for (double g : acceleration.component) check_parameter("uniform-gravity", "acceleration", g, AllowedRange::any);
  }
};

/// F = charge E, energy -charge E . x.
template <int D>
struct UniformElectricField {
  static constexpr bool uniform = true;
  Vector<D> field;

  template <class P>
  requires requires(P const& p) { p.charge; }
  auto operator()(P const& p) const {
    auto const force = field * p.charge;
    return Interaction{force, -dot(force, p.position)};
  }

  void check() const {
    for (double e : field.component) check_parameter("uniform-electric-field", "field", e, AllowedRange::any);
  }
};

/// A flow that carries every fluid particle (Euler and its descendants) with the same velocity.
template <int D>
struct UniformFlow {
  static constexpr bool uniform = true;
  Vector<D> velocity;

  template <class P>
  auto operator()(P const&) const {
    if constexpr (std::is_same_v<typename P::Influence, Vector<D>>)
      return velocity;
    else
      return typename P::Influence{velocity, {}};
  }

  void check() const {
    for (double v : velocity.component) check_parameter("uniform-flow", "velocity", v, AllowedRange::any);
  }
};

}  // namespace boltzmann
