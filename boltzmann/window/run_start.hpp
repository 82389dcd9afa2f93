// RunStart: the initial state of a run, and the distance from it after the run has been reversed to its start.
#pragma once

#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

class RunStart {
 public:
  /// Copies all particles, unless the run can't be reversed or there are more than four million.
  void keep(Simulation const& simulation);
  bool kept() const { return kept_; }

  /// The largest distance of a particle from its initial position, and the largest difference of a velocity. None if
  /// there is no copy.
  struct Missed {
    double position = 0, velocity = 0;
  };
  std::optional<Missed> missed(Simulation const& simulation) const;

 private:
  std::vector<Checkpoint::Rows> rows_;
  bool kept_ = false;
};

/// Why a simulation can't be reversed, in one line; empty if it can.
std::string no_rewind(Simulation const& simulation);

}  // namespace boltzmann
