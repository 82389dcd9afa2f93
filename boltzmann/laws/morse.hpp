// The Morse law: a bond that can break, with a core of finite height.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// phi(r) = depth [(1 - e^(-a (r - r0)))^2 - 1]: minimum -depth at r0, stiffness 2 depth a^2 there. Two coincident
/// particles exert no force on each other, as they have no direction.
struct Morse {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  static constexpr bool positions_alone = true;

  double depth;
  double r0;
  double a;

  static constexpr LawText text{.name = "morse",
                                .doc = "a chemical bond that breaks, with a core of finite height",
                                .formula = "depth [(1 - exp(-a (r - r0)))^2 - 1]",
                                .target = "Newton",
                                .source = "Particle",
                                .typed = TypedLawText("depth*((1 - exp(-a*(r - r0)))^2 - 1)")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&Morse::depth, also({"depth", dimensions::energy, "depth of the well", not_negative}, "D")},
        ParameterOf{&Morse::r0, {"r0", dimensions::length, "distance of the minimum", positive}},
        ParameterOf{&Morse::a, also({"a", dimensions::wave_number, "steepness: 1/a is the width of the well", positive},
                                    "alpha")}};
  }

  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const r = q.position - p.position;
    auto const square = dot(r, r);
    using Real = std::remove_cvref_t<decltype(square)>;
    Real const distance = sqrt(square);
    Real const e = exp_of_rounded(a * r0 - a * distance);
    Real const strength = select(square > 0.0, Real((2 * depth * a) / distance), Real(0.0));
    return Interaction{r * (strength * (e - e * e)), depth * e * (e - 2.0)};
  }

  double length_scale() const { return 1 / a; }
};

}  // namespace boltzmann
