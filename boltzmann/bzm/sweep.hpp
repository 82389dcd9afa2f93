// bzm run and bzm resume of a scenario with [sweep]: all its runs one after the other, each in a folder of its own.
#pragma once

#include <boltzmann/bzm/scenario_recording.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <optional>
#include <string>

namespace boltzmann::bzm {

struct SweepOptions {
  ScenarioText text;    ///< of the scenario
  Overrides overrides;  ///< of the command line
  std::string folder;   ///< for the results
  bool quiet = false, force = false;
};

/// Loads every value once, so that mistakes are told before anything runs. ScenarioErrors with all of them.
void check_sweep(ScenarioText const& text, Overrides const& overrides, SweepPlan const& plan);

/// Does all runs and writes what they say together. `scenario` is what is in the file, with its plan. Gives the exit
/// status: 3 if a run failed, 4 if the wall time is over, 130 if a signal has stopped it.
int run_sweep(SweepOptions const& options, WallTime const& wall, std::unique_ptr<ScenarioSimulation> scenario);

/// Whether there is a sweep in the folder, finished or not.
bool holds_sweep(std::string const& folder);
/// Goes on with it: runs that are done are not done again.
int resume_sweep(std::string const& folder, std::optional<int> threads, bool quiet, WallTime const& wall);
/// Removes its files, and the folders of its runs.
void remove_sweep(std::string const& folder);

}  // namespace boltzmann::bzm
