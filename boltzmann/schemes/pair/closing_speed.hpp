// How fast particles come together: what a step must be short enough for. Private to this room.
#pragma once

namespace boltzmann {

class AnyEnsemble;
class Box;

/// The speed at which particles of `a` may meet those of `b` (of one ensemble if they are the same): the difference of
/// their mean velocities, or twice the speed at which a wall and the body that it faces approach each other (what the
/// wall has reflected meets the rest at that), and three thermal speeds. Zero for classes without velocity.
double closing_speed(Box const& box, AnyEnsemble const& a, AnyEnsemble const& b);

}  // namespace boltzmann
