// The Rydberg law: the universal binding curve of Rose, Ferrante and Smith.
#pragma once

#include <boltzmann/laws/central.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// phi(r) = -depth (1 + x + alpha x^3) e^-x with x = a (r - r0) / r0: minimum -depth at r0, stiffness depth (a / r0)^2
/// there. In the scaled distance x it is the universal binding curve, which fits the cohesive energies of most metals;
/// the cubic term makes the core harder (alpha = 0.185 for PVDF in the DPDE source). Two coincident particles exert no
/// force on each other, as they have no direction.
struct Rydberg {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  static constexpr bool positions_alone = true;

  double depth;
  double r0;
  double a;
  double alpha = 0;  ///< from 0 to below 4/9 there is one minimum and no maximum

  static constexpr LawText text{
      .name = "rydberg",
      .doc = "the universal binding curve of Rose, Ferrante and Smith, for metals",
      .formula = "-depth (1 + x + alpha x^3) exp(-x), x = a (r - r0)/r0",
      .target = "Newton",
      .source = "Particle",
      .typed = TypedLawText("-depth*(1 + a*(r/r0 - 1) + alpha*(a*(r/r0 - 1))^3)*exp(-a*(r/r0 - 1))")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&Rydberg::depth, {"depth", dimensions::energy, "depth of the well", not_negative}},
        ParameterOf{&Rydberg::r0, {"r0", dimensions::length, "distance of the minimum", positive}},
        ParameterOf{&Rydberg::a, {"a", dimensions::none, "steepness: r0/a is the width of the well", positive}},
        ParameterOf{&Rydberg::alpha,
                    {"alpha", dimensions::none, "cubic term: above 0 a harder core", any_number, "0"}}};
  }

  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const [direction, distance] = separation(p, q);
    auto const x = a / r0 * (distance - r0);
    auto const e = depth * exp(-x);
    return Interaction{direction * (a / r0 * x * (1.0 - alpha * x * (3.0 - x)) * e),
                       -(1.0 + x * (1.0 + alpha * x * x)) * e};
  }

  double length_scale() const { return r0 / a; }
};

}  // namespace boltzmann
