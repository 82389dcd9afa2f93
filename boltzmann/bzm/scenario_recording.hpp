// From a scenario's output plan to a recording.
#pragma once

#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/simulation/recording.hpp>

#include <memory>
#include <string>

namespace boltzmann::bzm {

/// The title of pictures and windows: the scenario's, else the name of the folder.
std::string title_of(ScenarioSimulation const& scenario, std::string const& folder);

Picture picture_of(PicturePlan const& plan);

/// A recording of all that the scenario asks for. Takes the scenario's diagnoses over.
std::unique_ptr<Recording> make_recording(ScenarioSimulation& scenario, std::string const& folder, bool overwrite);

/// Runs to the end, or as somebody at a window wants, and gives the exit status.
int run_recording(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps, std::int64_t planned,
                  bool quiet, WindowRun const& window = {});

/// Runs as somebody at a window wants.
RunReport run_in_window(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps,
                        WindowRun const& options, bool quiet);

}  // namespace boltzmann::bzm
