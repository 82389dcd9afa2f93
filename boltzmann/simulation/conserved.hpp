// Conserved quantities of a run: energy, momentum and angular momentum of a state, where they are defined.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// Totals over all ensembles whose class has a mass and a velocity.
struct Conserved {
  std::optional<double> energy;  ///< kinetic + potential + external + internal, minus work and heat from outside the
                                 ///< system; none if a law gives no energy or a class no mass
  std::string no_energy;         ///< the reason why there is none
  double work = 0;               ///< done by moving walls, and added particles, since the start
  double heat = 0;               ///< given by heat baths since the start of the run
  std::optional<std::array<double, 3>> momentum;          ///< none if a class has no mass
  std::optional<std::array<double, 3>> angular_momentum;  ///< about the origin; none on periodic axes
  double energy_scale = 0;                                ///< kinetic energy + |potential| + |external|
  double momentum_scale = 0;                              ///< sum of |m v|
  double angular_momentum_scale = 0;                      ///< sum of |m r x v|
  /// The effect of rounding of positions on these in a run: an error of 100 eps (length) / (step) in every velocity. If
  /// the scales are smaller, nothing moves, and a relative drift is meaningless.
  double energy_rounding = 0, momentum_rounding = 0, angular_momentum_rounding = 0;
  int dimension = 3;
  bool driven = false;   ///< the energy may change without being counted: by friction, noise, adaptations, ...
  bool isolated = true;  ///< no walls, no heat bath, no external or one-sided forces: momentum is conserved
};

/// The totals of the current state. Calculates the energies of all schemes once.
Conserved conserved(Simulation const& simulation);

/// PhysicsFailure, naming a particle if possible, unless these energies are finite: those of measure(), or those of
/// conserved().
void need_finite(Simulation const& simulation, EnergyAndVirial const& measures);
void need_finite(Simulation const& simulation, Conserved const& total);

/// A line of warning if the energy should be conserved and has changed by more than a tenth of the initial or final
/// kinetic, potential and internal energies. Another one if momentum should be conserved and has changed by more than a
/// hundredth of the sum of |m v|. None for changes within rounding.
std::vector<std::string> drift_warnings(Conserved const& start, Conserved const& end, UnitSystem const& units);

/// The lines of the table at the end of a run: each quantity at start and end, and its drift. The drift of the energy
/// ("energy less work and heat" if there was some) is relative to its own start; if it starts near zero, to its scale;
/// if more energy was given, to that. The drifts of momenta are relative to their scales, since totals are often zero.
/// If a scale itself is rounding, the drift is relative to that.
std::vector<std::string> conserved_table(Conserved const& start, Conserved const& end, UnitSystem const& units);

}  // namespace boltzmann
