// From a scenario's output plan to a recording.
#pragma once

#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <chrono>
#include <memory>
#include <optional>
#include <string>

namespace boltzmann::bzm {

/// The title of pictures and windows: the scenario's, else the name of the folder.
std::string title_of(ScenarioSimulation const& scenario, std::string const& folder);

/// A recording of all that the scenario asks for. Takes the scenario's diagnoses over.
std::unique_ptr<Recording> make_recording(ScenarioSimulation& scenario, std::string const& folder, bool overwrite);

/// The wall time of --hours, which begins with it.
class WallTime {
 public:
  explicit WallTime(std::optional<double> hours);
  /// What is left but for a reserve for pictures and tables, 1 % but 2 s at least and a minute at most; 0: there is no
  /// limit.
  double seconds() const;

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point begun_;
  std::optional<double> seconds_;
};

/// Runs to the end, or as somebody at a window wants, and gives the exit status.
int run_recording(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps, std::int64_t planned,
                  bool quiet, WallTime const& wall, WindowRun const& window = {});

/// Runs as somebody at a window wants.
RunReport run_in_window(ScenarioSimulation const& scenario, Recording& recording, std::int64_t steps,
                        WindowRun const& options, bool quiet);

}  // namespace boltzmann::bzm
