// The finitely extensible spring (FENE) between the beads of polymer models.
#pragma once

#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

#include <cmath>
#include <limits>

namespace boltzmann {

/// phi(r) = -stiffness max_length^2 / 2 ln(1 - (r / max_length)^2): a spring that can't be stretched to max_length.
/// Beyond it force and energy are NaN: the chain is torn, and the run ends. K. Kremer and G. S. Grest, J. Chem. Phys.
/// 92, 5057 (1990), use stiffness 30 and max_length 1.5 with a repulsion between beads.
struct Fene {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  static constexpr bool positions_alone = true;

  double stiffness;
  double max_length;

  static constexpr LawText text{.name = "fene",
                                .doc = "a spring of finite length, which joins the beads of polymers",
                                .formula = "-stiffness max_length^2/2 ln(1 - (r/max_length)^2)",
                                .target = "Newton",
                                .source = "Particle",
                                .typed = TypedLawText("-0.5*stiffness*max_length^2*log(1 - (r/max_length)^2)")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&Fene::stiffness, {"stiffness", dimensions::spring_constant, "force constant", not_negative}},
        ParameterOf{&Fene::max_length,
                    {"max_length", dimensions::length, "length to which it can't be stretched", positive}}};
  }

  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    using std::log;
    auto const r = q.position - p.position;
    using Real = std::remove_cvref_t<decltype(dot(r, r))>;
    Real const left = 1.0 - dot(r, r) * (1 / (max_length * max_length));
    Real const nothing = std::numeric_limits<double>::quiet_NaN();
    Real const pull = select(left > 0.0, Real(stiffness / left), nothing);
    return Interaction{r * pull, select(left > 0.0, -0.5 * stiffness * max_length * max_length * log(left), nothing)};
  }

  double length_scale() const { return max_length; }
};

}  // namespace boltzmann
