// Pendulum: a classical particle in a generalised coordinate, the angle of a bob that hangs from a pivot (section 6.1).
#pragma once

#include <boltzmann/particles/newton.hpp>

namespace boltzmann {

/// A pendulum. Its one coordinate is the angle from the vertical, so that Newton's law reads: the moment of inertia
/// times the angular acceleration is the torque. `position` is the angle, `velocity` the angular velocity, `mass` the
/// moment of inertia (bob_mass length^2), the influence a torque.
template <int D = 1, class Real = double>
struct Pendulum : Newton<D, Real> {
  static_assert(D == 1, "a pendulum has one coordinate, its angle");
  static constexpr char const* class_name = "Pendulum";

  Real length, bob_mass;
  Vector<2, Real> pivot;

  /// From the pivot to the bob: l (sin angle, -cos angle).
  Vector<2, Real> arm() const { return {length * sin(this->position[0]), -length * cos(this->position[0])}; }

  static FieldTable fields() {
    return FieldTable{}
        .add(&Pendulum::position, "position", dimensions::angle, "angle from the vertical")
        .add(&Pendulum::mass, "mass", dimensions::moment_of_inertia, "moment of inertia, bob_mass length^2")
        .add(&Pendulum::velocity, "velocity", dimensions::frequency, "angular velocity")
        .add(&Pendulum::length, "length", dimensions::length, "from the pivot to the bob")
        .add(&Pendulum::bob_mass, "bob_mass", dimensions::mass, "mass of the bob")
        .add(&Pendulum::pivot, "pivot", dimensions::length, "where it hangs, in the plane");
  }
};

}  // namespace boltzmann
