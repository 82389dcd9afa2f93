// Laws of pendulums: weight, and a spring from bob to bob (section 6.1 of the 1990 thesis). Both give torques.
#pragma once

#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// A spring between the bobs: potential (stiffness / 2) (d - rest_length)^2 of their distance d. The torque on each is
/// cross(arm, force on its own bob). The two torques differ, since Newton's third law applies to forces but not to
/// generalised forces; the energy is conserved.
struct PendulumCoupling {
  static constexpr Symmetry symmetry = Symmetry::general;

  double stiffness;
  double rest_length = 0;

  static constexpr LawText text{.name = "pendulum-coupling",
                                .doc = "a spring from bob to bob; its two torques differ, the energy is conserved",
                                .formula = "stiffness (d - rest_length)^2 / 2, d the distance of the bobs",
                                .target = "Pendulum",
                                .source = "Pendulum",
                                .greatest_dimension = 1};
  static constexpr auto parameters() {
    return std::tuple{ParameterOf{&PendulumCoupling::stiffness,
                                  {"stiffness", dimensions::spring_constant, "force constant", not_negative}},
                      ParameterOf{&PendulumCoupling::rest_length,
                                  {"rest_length", dimensions::length, "distance at which it neither pulls nor pushes",
                                   not_negative, "0"}}};
  }

  template <class P>
  auto operator()(P const& p, P const& q) const {
    auto const arm = p.arm();
    auto const apart = q.pivot + q.arm() - p.pivot - arm;
    auto const distance = max(magnitude(apart), 1e-150);
    auto const stretch = distance - rest_length;
    auto const force = apart * (stiffness * stretch / distance);
    return Interaction{cross(arm, force), 0.5 * stiffness * stretch * stretch};
  }
};

/// The weight of the bob in a uniform downward field `acceleration`: torque -m g l sin(angle), energy zero at the
/// lowest point.
struct PendulumGravity {
  double acceleration;

  static constexpr LawText text{.name = "pendulum-gravity",
                                .doc = "the weight of a bob as a torque",
                                .formula = "m acceleration l (1 - cos angle)",
                                .target = "Pendulum",
                                .source = "",
                                .greatest_dimension = 1,
                                .typed = TypedLawText("bob_mass*acceleration*length*(1 - cos(x))")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&PendulumGravity::acceleration, {"acceleration", dimensions::acceleration, "g, downwards"}}};
  }

  template <class P>
  auto operator()(P const& p) const {
    auto const weight = p.bob_mass * acceleration * p.length;
    auto const angle = p.position[0];
    return Interaction{Vector{-weight * sin(angle)}, weight * (1.0 - cos(angle))};
  }
};

}  // namespace boltzmann
