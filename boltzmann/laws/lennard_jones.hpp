// The Lennard-Jones law (Eq 6.8 of the 1990 thesis).
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// phi(r) = depth [(r0/r)^12 - 2 (r0/r)^6]: minimum -depth at r0. (sigma = r0 / 2^(1/6).)
struct LennardJones {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  static constexpr bool positions_alone = true;

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
        ParameterOf{&LennardJones::depth, {"depth", dimensions::energy, "depth of the well", not_negative}},
        ParameterOf{&LennardJones::r0, {"r0", dimensions::length, "distance of the minimum: 2^(1/6) sigma", positive}}};
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
