// Fused steps: an interface of schemes that advance their particles themselves. This is faster than storing influences
// that an integrator then reads.
#pragma once

namespace boltzmann {

class AnyEnsemble;

/// An ensemble of a simulation, and whether leap-frog moves it (otherwise it is fixed).
struct Mover {
  AnyEnsemble* ensemble;
  bool moves;
};

/// A sequence of leap-frog steps. Between store() calls the rows of ensembles are out of date.
class FusedSteps {
 public:
  virtual ~FusedSteps() = default;
  /// Advances by one step from `time`. Throws PhysicsFailure, naming the particle, if a particle is not finite, too
  /// fast, or has left the box.
  virtual void step(double time) = 0;
  /// Stores the state (positions, and velocities at the same time) in the rows, unless they are up to date. `time` is
  /// the time at which the next step begins.
  virtual void store(double time) = 0;
};

}  // namespace boltzmann
