// Start forces: checks whether the initial forces of a run are too large for its step, and names the particle. Private
// to this module.
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
  double step;            ///< the longest step in which no force moves its particle by more than a tenth of that length
  std::string too_large;  ///< a line if a step of this size would move a particle further than the length (or the box):
                          ///< the particle, its nearest neighbour, and the cure
};

/// Checks the current influences. The advised step also suits the `collision_step`. Classes without mass and velocity
/// are ignored. `added`: in the middle of a run, after particles have been added. `otherwise`: another cure than a
/// shorter step, if [minimise] is none.
StartForces forces_at_start(std::vector<Moved> const& moved, std::vector<AnyEnsemble*> const& all, Box const& box,
                            double step_size, double collision_step, bool added, std::string const& otherwise);

}  // namespace boltzmann
