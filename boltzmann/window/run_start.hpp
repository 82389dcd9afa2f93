// RunStart: where a run began, and by how much it is missed when the run has gone all the way back.
#pragma once

#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

class RunStart {
 public:
  /// Copies all particles, unless the run can't go back or they are more than four million.
  void keep(Simulation const& simulation);
  bool kept() const { return kept_; }

  /// The furthest that a particle is from where it was, and by how much its velocity differs at most. None if there is
  /// nothing to compare with.
  struct Missed {
    double position = 0, velocity = 0;
  };
  std::optional<Missed> missed(Simulation const& simulation) const;

 private:
  std::vector<Checkpoint::Rows> rows_;
  bool kept_ = false;
};

/// Why a simulation can't go back, in one line; empty if it can.
std::string no_rewind(Simulation const& simulation);

}  // namespace boltzmann
