// Minimise: moves particles downhill in energy until forces are negligible, before a run or separately.
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

/// When the descent ends, and the size of its steps. It ends at the first criterion that is met.
struct MinimiseOptions {
  std::optional<double> force = {};     ///< limit of all forces. Without `force` and `energy`: no force moves its
                                        ///< particle further than a millionth of its law's length in a step of the run
  std::optional<double> energy = {};    ///< ten steps change the energy by less than this, twice in succession
  std::int64_t steps = 10000;           ///< at most
  std::optional<double> step = {};      ///< the first step in time, which grows up to ten times; default: that of the
                                        ///< run
  std::optional<double> distance = {};  ///< limit of a particle's motion in a step; default: a tenth of its law's
                                        ///< length (of the mean distance if the law has none)
};
OptionTable const& minimise_options();

struct Minimised {
  std::optional<double> energy_before = {}, energy_after = {};  ///< potential and external; none if a law gives none
  double force_before = 0, force_after = 0;  ///< the largest; at a wall without the component that presses on it
  std::string ensemble = {};                 ///< of the particle with the largest force
  std::size_t particle = 0;                  ///< its number
  std::int64_t steps = 0;                    ///< steps done
  bool converged = false;                    ///< a tolerance was met
  std::size_t separated = 0;                 ///< particles whose force was not finite (two coincident ones), moved
                                             ///< apart
};

/// Moves the particles of all ensembles on which forces act to a minimum of their energy. The method is FIRE (E.
/// Bitzek, P. Koskinen, F. Gaehler, M. Moseler and P. Gumbsch, Phys. Rev. Lett. 97, 170201 (2006)) in the form of J.
/// Guenole and others (Comput. Mater. Sci. 175, 109584 (2020)). A limit on the motion of each particle pushes
/// overlapping particles apart gently. Deactivated ensembles and frozen particles rest; a particle that a wall stops
/// stays at the wall. Velocities and all other fields are kept, and count as zero for laws that depend on them; moving
/// walls are at rest. The same bits for any number of threads. The simulation is checked afterwards
/// (Simulation::check). Error if no force moves anything, if particles are smooth (their pressure does work on their
/// heat, so that there is no minimum), if a tolerance is on the energy and a law gives none, or if a force stays
/// infinite or NaN.
Minimised minimise(Simulation& simulation, MinimiseOptions const& options = {});

/// One line: "energy -12.1 eV to -13.4 eV, largest force 2e-9 eV/angstrom, 312 steps, converged".
std::string text(Minimised const& minimised, UnitSystem const& units);

/// Error for invalid numbers.
void check(MinimiseOptions const& options);

}  // namespace boltzmann
