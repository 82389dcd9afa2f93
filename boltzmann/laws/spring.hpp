// The spring: Hooke's law with a rest length.
#pragma once

#include <boltzmann/laws/central.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// phi(r) = stiffness (r - rest_length)^2 / 2. In 1D the spring keeps the order of its ends, as in a chain of lumped
/// masses (section 6.2 of the 1990 thesis): compressed, it pushes them apart. Two particles at one place don't push
/// each other: they have no direction.
struct Spring {
  static constexpr Symmetry symmetry = Symmetry::antisymmetric;

  double stiffness;
  double rest_length = 0;

  template <class P, class Q>
  auto operator()(P const& p, Q const& q) const {
    auto const [direction, distance] = separation(p, q);
    auto const extension = distance - rest_length;
    return Interaction{direction * (stiffness * extension), 0.5 * stiffness * extension * extension};
  }

  /// Beyond the rest length the ends may have changed places.
  double length_scale() const { return rest_length > 0 ? rest_length : __builtin_inf(); }
  void check() const {
    check_parameter("spring", "stiffness", stiffness, AllowedRange::non_negative);
    check_parameter("spring", "rest_length", rest_length, AllowedRange::non_negative);
  }
};

}  // namespace boltzmann
