// Changes of velocities at once: quenches and kicks, for events.
//
//   simulation.happen(5, [&] { scale_to_temperature({{&atoms, all_particles(atoms)}}, 0.1, 1); }, false);
#pragma once

#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// Some particles of an ensemble, by number.
struct ChosenParticles {
  AnyEnsemble* ensemble;
  std::vector<std::uint32_t> which;
};

/// Scales the velocities of all of them, relative to their common one, to this temperature over the D (N - 1) degrees of
/// freedom that are left (one particle alone: D, of its whole velocity). Error if the temperature is negative, or it is
/// not zero and nobody moves, or a class has no mass and velocity.
void scale_to_temperature(std::vector<ChosenParticles> const& of, double temperature, double boltzmann_constant);
/// Multiplies velocities by a factor. Error if the class has none.
void scale_velocities(std::vector<ChosenParticles> const& of, double factor);
/// Adds a velocity. Error if the class has none.
void kick(std::vector<ChosenParticles> const& of, std::array<double, 3> const& velocity);

}  // namespace boltzmann
