// Tethered: classical particles that are bound to points of their own.
#pragma once

#include <boltzmann/particles/newton.hpp>

namespace boltzmann {

/// A classical particle with an anchor and the stiffness of its tether; zero: free. See the law Tether.
template <int D, class Real = double>
struct Tethered : Newton<D, Real> {
  static constexpr char const* class_name = "Tethered";

  Real stiffness;
  Vector<D, Real> anchor;

  static FieldTable fields() {
    return Newton<D, Real>::fields()
        .add(&Tethered::stiffness, "stiffness", dimensions::spring_constant, "force constant of the tether")
        .add(&Tethered::anchor, "anchor", dimensions::length, "the point it is tethered to");
  }
};

}  // namespace boltzmann
