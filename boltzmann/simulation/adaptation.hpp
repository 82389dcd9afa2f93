// Adaptation: changes particles, or their number, between steps.
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/diagnoses/flow_impulse.hpp>

#include <span>
#include <string>
#include <vector>

namespace boltzmann {

class Adaptation {
 public:
  virtual ~Adaptation() = default;
  /// Changes rows of ensembles, or their number. Fields that schemes derive (densities) are those of the last step.
  virtual void change() = 0;
  /// One line about all changes so far, for the end of a run; empty: none.
  virtual std::string report(UnitSystem const&) const { return ""; }
  /// Circulation and impulse of a plane flow of all vortices removed so far.
  virtual FlowImpulse taken() const { return {}; }
  /// The state for checkpoints. restore() restores it; Error if it does not fit.
  virtual std::vector<double> state() const { return {}; }
  virtual void restore(std::span<double const>) {}
};

}  // namespace boltzmann
