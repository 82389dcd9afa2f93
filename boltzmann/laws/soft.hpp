// The soft repulsion of dissipative particle dynamics (Groot and Warren 1997).
#pragma once

#include <boltzmann/laws/central.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// A force repulsion (1 - r / range) up to the range, zero beyond: phi(r) = repulsion range / 2 (1 - r / range)^2. For
/// lumps of fluid, which may overlap (Eq 5 of Groot and Warren, J. Chem. Phys. 107, 4423; their a is the repulsion).
/// Two coincident particles exert no force on each other, as they have no direction.
struct Soft {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;
  static constexpr bool positions_alone = true;

  double repulsion;
  double range;

  static constexpr LawText text{.name = "soft",
                                .doc = "lumps of fluid that may lie on top of each other: Groot and Warren's repulsion",
                                .formula = "repulsion range/2 (1 - r/range)^2 up to the range",
                                .target = "Newton",
                                .source = "Particle",
                                .typed = TypedLawText("0.5*repulsion*range*max(1 - r/range, 0)^2")};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&Soft::repulsion,
                    {"repulsion", dimensions::force, "greatest force, between particles at one place", not_negative}},
        ParameterOf{&Soft::range, {"range", dimensions::length, "distance from which on there is no force", positive}}};
  }

  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const [direction, distance] = separation(p, q);
    using Real = std::remove_cvref_t<decltype(distance)>;
    Real const part = 1.0 - distance * (1 / range);
    Real const overlap = select(part > 0.0, part, Real(0.0));
    return Interaction{direction * (-repulsion * overlap), 0.5 * repulsion * range * overlap * overlap};
  }

  double length_scale() const { return range; }
};

}  // namespace boltzmann
