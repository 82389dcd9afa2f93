// Instant changes of velocities: quenches and kicks, for events, and the exact temperature of a start.
//
//   simulation.happen(5, [&] { scale_to_temperature({{&atoms, all_particles(atoms)}}, 0.1, 1); }, false);
//
// Particles at rest (Mobility) are excluded: their velocities are kept, and they have no degrees of freedom.
#pragma once

#include <boltzmann/particles/degrees_of_freedom.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// The mass-weighted mean velocity of moving particles; 0 if there are none.
std::array<double, 3> common_velocity(std::vector<ChosenParticles> const& of);

/// Scales velocities to this temperature of their degrees of freedom (particles/degrees_of_freedom.hpp). Along the axes
/// of `common_stays` they are scaled relative to the common velocity, and one degree of freedom less counts (none less
/// for a single particle). Simulation::momentum_is_kept() gives the axes with a conserved momentum. Error if the
/// temperature is negative, or it is not zero and nothing moves, or a class has no mass and velocity.
void scale_to_temperature(std::vector<ChosenParticles> const& of, double temperature, double boltzmann_constant,
                          std::array<bool, 3> const& common_stays = {true, true, true});
/// Multiplies velocities by a factor. Error if the class has none.
void scale_velocities(std::vector<ChosenParticles> const& of, double factor);
/// Adds a velocity. Error if the class has none.
void kick(std::vector<ChosenParticles> const& of, std::array<double, 3> const& velocity);

}  // namespace boltzmann
