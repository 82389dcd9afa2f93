// From a scenario's output plan to a recording.
#pragma once

#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/simulation/recording.hpp>

#include <memory>
#include <string>

namespace boltzmann::bzm {

Picture picture_of(PicturePlan const& plan);

/// A recording of all that the scenario asks for. Takes the scenario's diagnoses over.
std::unique_ptr<Recording> make_recording(ScenarioSimulation& scenario, std::string const& folder, bool overwrite);

/// Runs to the end and gives the exit status.
int run_recording(Recording& recording, std::int64_t steps, std::int64_t planned, bool quiet);

}  // namespace boltzmann::bzm
