// Stored replay: the run of a folder with all its views, ready to be replayed.
#pragma once

#include <boltzmann/recording/recording.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/window/replay.hpp>

#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

class StoredReplay {
 public:
  /// Throws Error (one line) if the folder does not exist, it holds no run, or the run has stored no trajectory.
  explicit StoredReplay(std::string const& folder);

  Replay& replay() { return *replay_; }
  /// The names of the run's own views and then its pictures, without the table.
  std::vector<std::string> const& own_views() const { return own_views_; }

 private:
  std::unique_ptr<ScenarioSimulation> scenario_;
  std::unique_ptr<Recording> recording_;  // only provides the pictures
  std::optional<Views> views_;
  std::optional<Replay> replay_;
  std::vector<std::string> own_views_;
};

}  // namespace boltzmann
