// A scenario with [sweep]: runs all its runs one after the other, each in a folder of its own.
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
  ScenarioText text;  ///< the scenario, with its sweep
  Overrides overrides;
  std::string folder;  ///< for the results
  bool quiet = false, force = false;
  bool lasting = true;  ///< write results through to the disk, so that they survive a loss of power
  /// Called with the simulation of each run before it starts, for example to add observers.
  std::function<void(Simulation& simulation)> attend = {};
};

/// Loads every value once, so that mistakes are reported before anything runs. Throws ScenarioErrors with all of them.
void check_sweep(ScenarioText const& text, Overrides const& overrides, SweepPlan const& plan);

struct SweepReport {
  std::size_t failed = 0;                         ///< number of failed runs
  bool interrupted = false, out_of_time = false;  ///< stopped by a signal, or by the wall time; resume_sweep()
                                                  ///< continues
};
/// Executes all runs and writes the joint results. `scenario` is the text of the file, with its plan.
SweepReport run_sweep(SweepOptions const& options, WallTime const& wall, std::unique_ptr<ScenarioSimulation> scenario);

/// True if the folder holds a sweep, finished or not.
bool holds_sweep(std::string const& folder);
/// Continues the sweep of a folder. Finished runs are not repeated.
SweepReport resume_sweep(std::string const& folder, std::optional<int> threads, bool quiet, WallTime const& wall);
/// Removes the files of a sweep and the folders of its runs.
void remove_sweep(std::string const& folder);

}  // namespace boltzmann
