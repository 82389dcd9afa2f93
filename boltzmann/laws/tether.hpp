// The tether: a spring from each particle to an anchor of its own (section 6.3 of the 1990 thesis, the boundary of the
// metal).
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// F = -stiffness (position - anchor), energy stiffness |position - anchor|^2 / 2; both are fields of the particle
/// (class Tethered). The distance to the anchor is not wrapped, even along a periodic axis.
struct Tether {
  static constexpr LawText text{
      .name = "tether",
      .doc = "a spring from each particle to its own anchor; anchor and stiffness are fields of the particle",
      .formula = "stiffness |x - anchor|^2 / 2",
      .target = "Tethered",
      .source = "",
      .typed = TypedLawText("0.5*stiffness*dot(position - anchor, position - anchor)")};
  static constexpr auto parameters() { return std::tuple{}; }

  template <class P>
  requires requires(P const& p) {
    p.anchor;
    p.stiffness;
  }
  auto operator()(P const& p) const {
    auto const r = p.anchor - p.position;
    return Interaction{r * p.stiffness, 0.5 * p.stiffness * dot(r, r)};
  }
};

}  // namespace boltzmann
