// Creates the recording of a scenario's run.
#include <boltzmann/scenario/scenario_recording.hpp>

#include <filesystem>

namespace boltzmann {

std::string title_of(ScenarioSimulation const& scenario, std::string const& folder) {
  return scenario.title.empty() ? std::filesystem::path(folder).filename().string() : scenario.title;
}

std::unique_ptr<Recording> make_recording(ScenarioSimulation& scenario, std::string const& folder,
                                          RecordingOptions const& options) {
  auto recording = std::make_unique<Recording>(*scenario.simulation, scenario.units, folder, options);
  if (!scenario.title.empty()) recording->title(scenario.title);
  recording->scenario(scenario.resolved);
  recording->planned(scenario.steps);
  if (scenario.stop_when) recording->stop_when(scenario.stop, scenario.stop_when);
  auto const& output = scenario.output;
  if (output.diagnoses > 0)
    for (auto& diagnosis : scenario.diagnoses)
      recording->diagnose(static_cast<std::uint64_t>(output.diagnoses), std::move(diagnosis));
  recording->elements(scenario.elements);
  if (output.trajectory > 0) recording->trajectory(static_cast<std::uint64_t>(output.trajectory));
  if (output.mesh > 0) recording->mesh(static_cast<std::uint64_t>(output.mesh));
  if (output.checkpoint > 0) recording->checkpoint(static_cast<std::uint64_t>(output.checkpoint));
  for (auto const& plan : output.pictures) recording->picture(plan);
  return recording;
}

}  // namespace boltzmann
