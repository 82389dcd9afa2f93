// Appending particles to an ensemble during a run.
//
//   simulation.add_particles(5, [&] { append(atoms, projectiles); });
#pragma once

#include <boltzmann/particles/ensemble.hpp>

namespace boltzmann {

/// Appends copies of all particles of `more` to `ensemble`, whose particles keep their numbers. Error if their classes
/// differ.
void append(AnyEnsemble& ensemble, AnyEnsemble const& more);

}  // namespace boltzmann
