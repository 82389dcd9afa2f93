// Start forces: whether the forces that a run begins with are too large for its step, and whose they are. Private to
// this room.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/simulation/moved.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// The part of a collision step (Scheme::collision_step) that is safe: forces between atoms rise over a tenth of their
/// law's length.
constexpr double collisions_followed = 0.1;

struct StartForces {
  double step;            ///< the longest in which no force moves its particle by more than a tenth of that length
  std::string too_large;  ///< a line, if a step of this size would bring a particle further than the length (or the
                          ///< box): who, which is nearest, and what to do
};

/// Of the influences as they stand. What is advised also suits the `collision_step`. Classes without mass and velocity are
/// left out. `added`: in the middle of a run, with particles that have just been added. `otherwise`: another cure than a
/// shorter step, if [minimise] is none.
StartForces forces_at_start(std::vector<Moved> const& moved, std::vector<AnyEnsemble*> const& all, Box const& box,
                            double step_size, double collision_step, bool added, std::string const& otherwise);

}  // namespace boltzmann
