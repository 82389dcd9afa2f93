// The closing speed of particles, which limits the time step. Private to this module.
#pragma once

namespace boltzmann {

class AnyEnsemble;
class Box;

/// The speed at which particles of `a` may meet those of `b` (of one ensemble if they are the same). It is three
/// thermal speeds plus the difference of their mean velocities, or plus twice the speed at which a wall and the body in
/// front of it approach each other (reflected particles meet the rest at that speed). Zero for classes without
/// velocity.
double closing_speed(Box const& box, AnyEnsemble const& a, AnyEnsemble const& b);

}  // namespace boltzmann
