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

  static constexpr LawText text{.name = "uniform-magnetic-field",
                                .doc = "the same magnetic field everywhere; charges gyrate about it",
                                .formula = "0: the force charge v x field does no work",
                                .target = "Coulomb",
                                .source = "",
                                .least_dimension = 2};
  static constexpr auto parameters() {
    return std::tuple{
        ParameterOf{&UniformMagneticField::field,
                    {.name = "field",
                     .dimension = dimensions::magnetic_field,
                     .doc = "force per charge and velocity; a vector in 3D, in 2D one number, out of the plane",
                     .axial = true}}};
  }

  template <class P>
  requires requires(P const& p) {
    p.charge;
    p.velocity;
  }
  auto operator()(P const& p) const {
    return Interaction{cross(field * -p.charge, p.velocity), decltype(p.charge + p.charge)(0)};
  }

  /// The angular velocity with which this field rotates the velocity of p: dv/dt = Omega x v, Omega = -charge B / mass.
  template <class P>
  auto rotation(P const& p) const {
    return field * (-p.charge / p.mass);
  }
};

}  // namespace boltzmann
