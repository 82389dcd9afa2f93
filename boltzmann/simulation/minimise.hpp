// Minimise: particles are moved downhill until no force is left that matters, before a run or on their own.
//
//   auto const found = minimise(simulation, {.force = 1e-8});
//   std::puts(text(found, units).c_str());
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/core/unit_system.hpp>

#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>

namespace boltzmann {

class Simulation;

/// When the descent ends, and how large its steps are. Of several ends the first that is reached.
struct MinimiseOptions {
  std::optional<double> force = {};     ///< no force is larger. Without `force` and `energy`: none moves its particle
                                        ///< further than a millionth of its law's length in a step of the run
  std::optional<double> energy = {};    ///< ten steps change the energy by less than this, twice in succession
  std::int64_t steps = 10000;           ///< at most so many
  std::optional<double> step = {};      ///< the first step in time, which grows up to ten times; that of the run
  std::optional<double> distance = {};  ///< no particle is moved further in a step; a tenth of its law's length (of the
                                        ///< mean distance, where the law has none)
};
OptionTable const& minimise_options();

struct Minimised {
  std::optional<double> energy_before = {}, energy_after = {};  ///< potential and external; none if a law gives none
  double force_before = 0, force_after = 0;  ///< the largest; of particles at a wall the part that does not press on it
  std::string ensemble = {};                 ///< whose particle feels it
  std::size_t particle = 0;                  ///< ... by number
  std::int64_t steps = 0;                    ///< that were done
  bool converged = false;                    ///< whether a tolerance was met
  std::size_t separated = 0;                 ///< particles whose force was not finite (two at one place), moved apart
};

/// Moves the particles of all ensembles that forces act on to a minimum of their energy, by FIRE (E. Bitzek,
/// P. Koskinen, F. Gaehler, M. Moseler and P. Gumbsch, Phys. Rev. Lett. 97, 170201 (2006)) as J. Guenole and others have
/// it (Comput. Mater. Sci. 175, 109584 (2020)), with a bound on the way of each particle, so that overlaps are pushed
/// apart and nothing explodes. Deactivated ensembles and frozen particles stay; what a wall stops lies on it. Velocities
/// and all other fields stay as they are, and count as zero for laws that depend on them; moving walls stand still. The
/// same bits for any number of threads. The simulation is checked then (Simulation::check). Error where there is nothing
/// that a force moves, or particles are smooth (their pressure does work on their heat, so that nothing is at its least),
/// or a tolerance is on the energy and a law gives none, or a force that is not finite stays so.
Minimised minimise(Simulation& simulation, MinimiseOptions const& options = {});

/// In a line: "energy -12.1 eV to -13.4 eV, largest force 2e-9 eV/angstrom, 312 steps, converged".
std::string text(Minimised const& minimised, UnitSystem const& units);

/// Error for numbers that can't be.
void check(MinimiseOptions const& options);

}  // namespace boltzmann
