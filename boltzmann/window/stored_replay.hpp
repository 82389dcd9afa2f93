// Stored replay: the run of a folder with all that a window shows of it, ready to be replayed.
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
  /// Error (one line) if there is no such folder, it holds no run, or the run has stored no trajectory.
  explicit StoredReplay(std::string const& folder);

  Replay& replay() { return *replay_; }
  /// What the run itself asks for, by name, its views before its pictures; the table is not among them.
  std::vector<std::string> const& own_views() const { return own_views_; }

 private:
  std::unique_ptr<ScenarioSimulation> scenario_;
  std::unique_ptr<Recording> recording_;  // only asked what it would draw
  std::optional<Views> views_;
  std::optional<Replay> replay_;
  std::vector<std::string> own_views_;
};

}  // namespace boltzmann
