// What a run conserves: energy, momentum and angular momentum of a state, where they are defined.
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
  std::optional<double> energy;  ///< kinetic + potential + external + internal, less what has come from outside: work
                                 ///< and heat; none if a law gives no energy or a class no mass
  std::string no_energy;         ///< why there is none
  double work = 0;               ///< that moving walls, and particles that were added, have done since the start
  double heat = 0;               ///< that heat baths have given since the start of the run
  std::optional<std::array<double, 3>> momentum;          ///< none where a class has no mass
  std::optional<std::array<double, 3>> angular_momentum;  ///< about the origin; none on periodic axes
  double energy_scale = 0;                                ///< kinetic energy + |potential| + |external|
  double momentum_scale = 0;                              ///< sum of |m v|
  double angular_momentum_scale = 0;                      ///< sum of |m r x v|
  /// What rounding of positions makes of these in a run: that of 100 eps (length) / (step) in every velocity. Where the
  /// scales are smaller, nothing moves, and a relative drift means nothing.
  double energy_rounding = 0, momentum_rounding = 0, angular_momentum_rounding = 0;
  int dimension = 3;
  bool driven = false;   ///< something may change the energy uncounted: friction, noise, adaptations, ...
  bool isolated = true;  ///< no walls, no heat bath, nothing from outside or without reaction: momentum is conserved
};

/// Of the present state. Calculates the energies of all schemes once.
Conserved conserved(Simulation const& simulation);

/// A line of warning if the energy should be conserved and has changed by more than a tenth of what there was, or is, of
/// kinetic, potential and internal energies; one if momentum should be and has changed by more than a hundredth of the
/// sum of |m v|. None for changes that are rounding.
std::vector<std::string> drift_warnings(Conserved const& start, Conserved const& end, UnitSystem const& units);

/// The lines of the table at the end of a run: each quantity at both ends and its drift. Energy ("energy less
/// work and heat" where there was some): relative to its own start (to its scale if it starts near zero, to
/// what was given if that is more); momenta: relative to their scales, since totals are often zero. Where a scale is
/// itself rounding, the drift is a part of it.
std::vector<std::string> conserved_table(Conserved const& start, Conserved const& end, UnitSystem const& units);

}  // namespace boltzmann
