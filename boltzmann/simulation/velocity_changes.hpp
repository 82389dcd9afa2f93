// Changes of velocities at once: quenches and kicks, for events, and the exact temperature of a start.
//
//   simulation.happen(5, [&] { scale_to_temperature({{&atoms, all_particles(atoms)}}, 0.1, 1); }, false);
//
// Particles at rest (Mobility) are left out of all of them: their velocities stay, and they have no degree of freedom.
#pragma once

#include <boltzmann/particles/degrees_of_freedom.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// The mass-weighted mean velocity of those that move; 0 of none.
std::array<double, 3> common_velocity(std::vector<ChosenParticles> const& of);

/// Scales velocities to this temperature of their degrees of freedom (particles/degrees_of_freedom.hpp). Along the axes
/// of `common_stays` they are scaled relative to the common velocity, and one degree of freedom less counts (of one
/// particle alone: none less); Simulation::momentum_is_kept() gives those where a momentum would be lost otherwise. Error
/// if the temperature is negative, or it is not zero and nothing moves, or a class has no mass and velocity.
void scale_to_temperature(std::vector<ChosenParticles> const& of, double temperature, double boltzmann_constant,
                          std::array<bool, 3> const& common_stays = {true, true, true});
/// Multiplies velocities by a factor. Error if the class has none.
void scale_velocities(std::vector<ChosenParticles> const& of, double factor);
/// Adds a velocity. Error if the class has none.
void kick(std::vector<ChosenParticles> const& of, std::array<double, 3> const& velocity);

}  // namespace boltzmann
