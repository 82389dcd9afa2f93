// Creates the recording of a scenario's run.
#pragma once

#include <boltzmann/recording/recording.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <memory>
#include <string>

namespace boltzmann {

/// The title of pictures and windows: the scenario's, else the name of the folder.
std::string title_of(ScenarioSimulation const& scenario, std::string const& folder);

/// A recording of all output that the scenario defines. Moves the scenario's diagnoses into it.
std::unique_ptr<Recording> make_recording(ScenarioSimulation& scenario, std::string const& folder,
                                          RecordingOptions const& options);

}  // namespace boltzmann
