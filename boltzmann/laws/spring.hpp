// The spring: Hooke's law with a rest length.
#pragma once

#include <boltzmann/laws/central.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// phi(r) = stiffness (r - rest_length)^2 / 2. In 1D the spring keeps the order of its ends, as in a chain of lumped
/// masses (section 6.2 of the 1990 thesis): compressed, it pushes them apart. Two coincident particles exert no force
/// on each other, as they have no direction.
struct Spring {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  static constexpr bool positions_alone = true;

  double stiffness;
  double rest_length = 0;

  static constexpr LawText text{.name = "spring",
                                .doc = "Hooke's law with a rest length; in 1D it keeps the order of its ends",
                                .formula = "stiffness (r - rest_length)^2 / 2",
                                .target = "Newton",
                                .source = "Particle",
                                .typed = TypedLawText("0.5*stiffness*(r - rest_length)^2")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&Spring::stiffness, {"stiffness", dimensions::spring_constant, "force constant", not_negative}},
        ParameterOf{
            &Spring::rest_length,
            {"rest_length", dimensions::length, "length at which it neither pulls nor pushes", not_negative, "0"}}};
  }

  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const [direction, distance] = separation(p, q);
    auto const extension = distance - rest_length;
    return Interaction{direction * (stiffness * extension), 0.5 * stiffness * extension * extension};
  }

  /// Beyond the rest length the ends may have exchanged their order.
  double length_scale() const { return rest_length > 0 ? rest_length : __builtin_inf(); }
};

}  // namespace boltzmann
