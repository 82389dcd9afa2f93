// Appending particles to an ensemble: those that are added while a run goes on.
//
//   simulation.add_particles(5, [&] { append(atoms, projectiles); });
#pragma once

#include <boltzmann/particles/ensemble.hpp>

namespace boltzmann {

/// Puts copies of all particles of `more` behind those of `ensemble`, which keep their numbers. Error if their classes
/// differ.
void append(AnyEnsemble& ensemble, AnyEnsemble const& more);

}  // namespace boltzmann
