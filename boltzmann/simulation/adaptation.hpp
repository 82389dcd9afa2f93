// Adaptation: what changes particles between steps. The simulation then takes them as they are, and as many as they
// are.
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
  /// Changes rows of ensembles, or their number. Fields that schemes find (densities) are those of the step that has
  /// just been done.
  virtual void change() = 0;
  /// One line about what was done so far, for the end of a run; empty: nothing to say.
  virtual std::string report(UnitSystem const&) const { return ""; }
  /// Circulation and impulse of a plane flow that have gone with the vortices which it took away, so far.
  virtual FlowImpulse taken() const { return {}; }
  /// What it remembers, for checkpoints. restore() takes it back; Error if it does not fit.
  virtual std::vector<double> state() const { return {}; }
  virtual void restore(std::span<double const>) {}
};

}  // namespace boltzmann
