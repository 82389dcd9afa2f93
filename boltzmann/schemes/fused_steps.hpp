// Whole steps: what a scheme offers that can advance its particles by itself, faster than by influences that are stored
// and an integrator that reads them.
#pragma once

namespace boltzmann {

class AnyEnsemble;

/// An ensemble of a simulation, and whether the leap-frog moves it (else it stays put).
struct Mover {
  AnyEnsemble* ensemble;
  bool moves;
};

/// A run of leap-frog steps. Between store() calls the rows of ensembles are out of date.
class FusedSteps {
 public:
  virtual ~FusedSteps() = default;
  /// Advances from `time` by a step. PhysicsFailure, naming the particle, if one is not finite, too fast, or has left.
  virtual void step(double time) = 0;
  /// Puts the state of now, the `time` at which the next step will begin (positions, and velocities at the same time),
  /// into the rows, unless they have it.
  virtual void store(double time) = 0;
};

}  // namespace boltzmann
