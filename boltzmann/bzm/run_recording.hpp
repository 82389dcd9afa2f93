// A run of `bzm run`, with its progress line or in a window.
#pragma once

#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/recording/wall_time.hpp>
#include <boltzmann/scenario/scenario_recording.hpp>

namespace boltzmann::bzm {

/// Runs to the end, or under control of the window, and returns the exit status.
int run_recording(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps, std::int64_t planned,
                  bool quiet, WallTime const& wall, WindowRun const& window = {});

/// Runs under control of the window.
RunReport run_in_window(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps,
                        WindowRun const& options, bool quiet);

}  // namespace boltzmann::bzm
