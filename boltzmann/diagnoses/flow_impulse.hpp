// The impulse of a plane flow, from which forces on bodies follow.
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <span>

namespace boltzmann {

/// The impulse of a plane flow over its density, sum Gamma (y, -x) over vortices and over the sheets of bodies; and their
/// circulation.
struct FlowImpulse {
  std::array<double, 2> impulse{};
  double circulation = 0;

  FlowImpulse& operator+=(FlowImpulse const& more) {
    impulse[0] += more.impulse[0], impulse[1] += more.impulse[1];
    circulation += more.circulation;
    return *this;
  }
};
FlowImpulse flow_impulse(std::span<AnyEnsemble* const> ensembles);

/// True for panels, the outline of a body.
bool is_body(AnyEnsemble const& ensemble);

}  // namespace boltzmann
