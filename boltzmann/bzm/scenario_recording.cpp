// What run, resume, check and render share.
#include <boltzmann/bzm/scenario_recording.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>

namespace boltzmann::bzm {

std::string title_of(ScenarioSimulation const& scenario, std::string const& folder) {
  return scenario.title.empty() ? std::filesystem::path(folder).filename().string() : scenario.title;
}

std::unique_ptr<Recording> make_recording(ScenarioSimulation& scenario, std::string const& folder, bool overwrite) {
  auto recording = std::make_unique<Recording>(*scenario.simulation, scenario.base, folder, overwrite);
  if (!scenario.title.empty()) recording->title(scenario.title);
  recording->scenario(scenario.resolved);
  recording->planned(scenario.steps);
  if (scenario.stop_when) recording->stop_when(scenario.stop, scenario.stop_when);
  auto const& output = scenario.output;
  if (output.diagnoses > 0 && !scenario.diagnoses.empty())
    recording->diagnoses(static_cast<std::uint64_t>(output.diagnoses), std::move(scenario.diagnoses));
  if (output.trajectory > 0) recording->trajectory(static_cast<std::uint64_t>(output.trajectory));
  if (output.mesh > 0) recording->mesh(static_cast<std::uint64_t>(output.mesh));
  if (output.checkpoint > 0) recording->checkpoint(static_cast<std::uint64_t>(output.checkpoint));
  for (auto const& plan : output.pictures) recording->picture(plan);
  return recording;
}

WallTime::WallTime(std::optional<double> hours) : begun_(Clock::now()) {
  if (hours) seconds_ = 3600 * *hours - std::clamp(36 * *hours, 2.0, 60.0);
}

double WallTime::seconds() const {
  if (!seconds_) return 0;
  return std::max(*seconds_ - std::chrono::duration<double>(Clock::now() - begun_).count(), 1e-9);
}

int run_recording(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps, std::int64_t planned,
                  bool quiet, WallTime const& wall, WindowRun const& window) {
  auto const report = window.open
                          ? run_in_window(scenario, recording, steps, window, quiet)
                          : run_with_progress(recording, static_cast<std::uint64_t>(std::max<std::int64_t>(steps, 0)),
                                              {.quiet = quiet, .planned = planned, .seconds = wall.seconds()});
  if (report.out_of_time) fmt::print(stderr, "bzm resume {} goes on with the run\n", recording.folder());
  return report.interrupted ? 130 : report.out_of_time ? out_of_time_status : 0;
}

}  // namespace boltzmann::bzm
