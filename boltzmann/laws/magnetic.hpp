// A uniform magnetic field: it turns velocities and does no work.
#pragma once

#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/laws/parameter.hpp>

namespace boltzmann {

/// F = charge v x B, energy zero. In 2D the field is one number, along z, out of the plane. The unit of B is such that
/// charge times velocity times field is a force (the tesla of SI); with a field in gauss, divide it by the speed of
/// light.
template <int D>
struct UniformMagneticField {
  static_assert(D >= 2, "a magnetic field needs a plane in which velocities turn: 2D or 3D");
  static constexpr bool velocity_dependent = true, uniform = true;

  Vector<cross_dimension<D>> field;

  template <class P>
  requires requires(P const& p) {
    p.charge;
    p.velocity;
  }
  auto operator()(P const& p) const {
    return Interaction{cross(field * -p.charge, p.velocity), decltype(p.charge + p.charge)(0)};
  }

  /// The angular velocity with which this field turns the velocity of p: dv/dt = Omega x v, Omega = -charge B / mass.
  template <class P>
  auto rotation(P const& p) const {
    return field * (-p.charge / p.mass);
  }

  void check() const {
    for (double b : field.component) check_parameter("uniform-magnetic-field", "field", b, AllowedRange::any);
  }
};

}  // namespace boltzmann
