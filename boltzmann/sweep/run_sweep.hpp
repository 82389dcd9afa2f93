// A scenario with [sweep]: all its runs one after the other, each in a folder of its own.
#pragma once

#include <boltzmann/recording/wall_time.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <cstddef>
#include <functional>
#include <memory>
#include <optional>
#include <string>

namespace boltzmann {

struct SweepOptions {
  ScenarioText text;  ///< of the scenario
  Overrides overrides;
  std::string folder;  ///< for the results
  bool quiet = false, force = false;
  bool lasting = true;  ///< the results are to survive a loss of power
  /// Called with the simulation of each run before it begins: it may observe it.
  std::function<void(Simulation& simulation)> attend = {};
};

/// Loads every value once, so that mistakes are told before anything runs. ScenarioErrors with all of them.
void check_sweep(ScenarioText const& text, Overrides const& overrides, SweepPlan const& plan);

struct SweepReport {
  std::size_t failed = 0;                         ///< so many of the runs that were begun
  bool interrupted = false, out_of_time = false;  ///< by a signal, by the wall time: resume_sweep() goes on
};
/// Does all runs and writes what they say together. `scenario` is what is in the file, with its plan.
SweepReport run_sweep(SweepOptions const& options, WallTime const& wall, std::unique_ptr<ScenarioSimulation> scenario);

/// Whether there is a sweep in the folder, finished or not.
bool holds_sweep(std::string const& folder);
/// Goes on with it: runs that are done are not done again.
SweepReport resume_sweep(std::string const& folder, std::optional<int> threads, bool quiet, WallTime const& wall);
/// Removes its files, and the folders of its runs.
void remove_sweep(std::string const& folder);

}  // namespace boltzmann
