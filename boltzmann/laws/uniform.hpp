// Uniform external fields: weight, an electric field, a background flow.
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

  static constexpr LawText text{.name = "uniform-gravity",
                                .doc = "weight: the same acceleration for every mass",
                                .formula = "-m acceleration . x",
                                .target = "Newton",
                                .source = "",
                                .typed = TypedLawText("-mass*dot(acceleration, position)")};
  static constexpr auto parameters() {
    return std::tuple{ParameterOf{&UniformGravity::acceleration,
                                  {"acceleration", dimensions::acceleration, "acceleration of every particle"}}};
  }

  template <class P>
  requires requires(P const& p) { p.mass; }
  auto operator()(P const& p) const {
    auto const force = acceleration * p.mass;
    return Interaction{force, -dot(force, p.position)};
  }
};

/// F = charge E, energy -charge E . x.
template <int D>
struct UniformElectricField {
  static constexpr bool uniform = true;
  Vector<D> field;

  static constexpr LawText text{.name = "uniform-electric-field",
                                .doc = "the same electric field everywhere",
                                .formula = "-charge field . x",
                                .target = "Coulomb",
                                .source = "",
                                .typed = TypedLawText("-charge*dot(field, position)")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&UniformElectricField::field, {"field", dimensions::electric_field, "force per charge"}}};
  }

  template <class P>
  requires requires(P const& p) { p.charge; }
  auto operator()(P const& p) const {
    auto const force = field * p.charge;
    return Interaction{force, -dot(force, p.position)};
  }
};

/// A flow that carries every fluid particle (Tracer and its descendants) with the same velocity.
template <int D>
struct UniformFlow {
  static constexpr bool uniform = true;
  Vector<D> velocity;

  static constexpr LawText text{.name = "uniform-flow",
                                .doc = "a flow that carries every fluid particle with the same velocity",
                                .formula = "velocity",
                                .target = "Tracer",
                                .source = "",
                                .has_energy = false,
                                .typed = TypedLawText("velocity")};
  static constexpr auto parameters() {
    return std::tuple{ParameterOf{&UniformFlow::velocity, {"velocity", dimensions::velocity, "velocity of the flow"}}};
  }

  template <class P>
  auto operator()(P const&) const {
    if constexpr (std::is_same_v<typename P::Influence, Vector<D>>)
      return velocity;
    else
      return typename P::Influence{velocity, {}};
  }
};

}  // namespace boltzmann
