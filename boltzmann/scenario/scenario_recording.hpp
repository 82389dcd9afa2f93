// From a scenario to the recording of its run.
#pragma once

#include <boltzmann/recording/recording.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <memory>
#include <string>

namespace boltzmann {

/// The title of pictures and windows: the scenario's, else the name of the folder.
std::string title_of(ScenarioSimulation const& scenario, std::string const& folder);

/// A recording of all that the scenario asks for. Takes the scenario's diagnoses over.
std::unique_ptr<Recording> make_recording(ScenarioSimulation& scenario, std::string const& folder,
                                          RecordingOptions const& options);

}  // namespace boltzmann
