// The Lennard-Jones law (Eq 6.8 of the 1990 thesis).
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// phi(r) = depth [(r0/r)^12 - 2 (r0/r)^6]: minimum -depth at r0. (sigma = r0 / 2^(1/6).)
struct LennardJones {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  static constexpr bool positions_alone = true;
  static constexpr double r0_of_sigma = 1.122462048309373;  ///< 2^(1/6)

  double depth;
  double r0;

  static constexpr LawText text{.name = "lennard-jones",
                                .doc = "atoms of a noble gas: repulsion as r^-12, attraction as r^-6",
                                .formula = "depth [(r0/r)^12 - 2 (r0/r)^6]",
                                .target = "Newton",
                                .source = "Particle",
                                .typed = TypedLawText("depth*((r0/r)^12 - 2*(r0/r)^6)")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&LennardJones::depth,
                    also({"depth", dimensions::energy, "depth of the well", not_negative}, "epsilon")},
        ParameterOf{&LennardJones::r0,
                    also({"r0", dimensions::length, "distance of the minimum", positive}, "sigma", r0_of_sigma)}};
  }
  /// The same law in the other convention, 4 epsilon [(sigma/r)^12 - (sigma/r)^6].
  static constexpr LennardJones of_sigma(double epsilon, double sigma) {
    return {.depth = epsilon, .r0 = r0_of_sigma * sigma};
  }

  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const r = q.position - p.position;
    auto const inverse = 1.0 / dot(r, r);
    auto const s6 = cube(r0 * r0 * inverse);
    return Interaction{r * (-12 * depth * s6 * (s6 - 1.0) * inverse), depth * s6 * (s6 - 2.0)};
  }

  double length_scale() const { return r0; }
};

}  // namespace boltzmann
