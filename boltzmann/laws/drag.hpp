// Drag: friction against a medium at rest.
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// F = -friction v: velocities decay as exp(-friction t / m).
struct Drag {
  static constexpr bool velocity_dependent = true;

  double friction;

  static constexpr LawText text{.name = "drag",
                                .doc = "friction against a medium at rest",
                                .formula = "force -friction v",
                                .target = "Newton",
                                .source = "",
                                .has_energy = false,
                                .typed = TypedLawText("-friction*velocity")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&Drag::friction, {"friction", dimensions::friction, "force per velocity", not_negative}}};
  }

  template <class P>
  requires requires(P const& p) { p.velocity; }
  auto operator()(P const& p) const { return p.velocity * -friction; }
};

}  // namespace boltzmann
