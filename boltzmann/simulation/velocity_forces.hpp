// VelocityForces: leap-frog under forces that depend on velocities.
//
// Forces between particles kick as usual, but the second half kick of a step is solved for the velocity at its end,
// v = v_half + (dt/2) a(x, v). It is the adjoint of the first half kick, so the step is symmetric in time and of second
// order. External forces on an ensemble act during the drift, by the implicit midpoint rule:
//   v_mid = v + (dt/2) a(x + (dt/2) v_mid, v_mid),  x' = x + dt v_mid,  v' = 2 v_mid - v.
// It is symmetric, too, keeps quadratic invariants (a force perpendicular to the velocity does no work; for a uniform
// magnetic field it is Boris' push), and free particles in a rotating frame move on circles. Both: E. Hairer,
// C. Lubich and G. Wanner, Geometric Numerical Integration, 2nd ed. (2006), II.3 and IV.2.
//
// Ensembles that do not move by Newton's law alone, and rigid molecules, get external forces as kicks, like those
// between particles.
#pragma once

#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/particles/division.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/schemes/scheme.hpp>

#include <memory>
#include <vector>

namespace boltzmann {

class VelocityForces {
 public:
  /// An ensemble that leap-frog advances.
  struct Mover {
    AnyEnsemble* ensemble;
    Integrator* integrator;
  };
  VelocityForces();
  ~VelocityForces();

  /// Finds the laws that depend on velocities and act on these ensembles, and makes the schemes omit them from
  /// Scheme::add_influences().
  void find(std::vector<Scheme*> const& schemes, std::vector<Mover> const& movers);
  bool any() const { return !kicked_.empty() || !drifting_.empty(); }
  /// True if a scheme is added here completely, not by Scheme::calculate().
  bool takes(Scheme const& scheme) const;
  /// True if second_kick() advances this ensemble.
  bool kicks(AnyEnsemble const& ensemble) const;

  /// Adds the influences that depend on velocities to the others, which schemes have just calculated. Before the second
  /// kick it excludes those that act during the drift.
  void complete(double time, bool before_second_kick);
  /// Recalculates them for the current velocities; particles have not moved since the last complete().
  void refresh(double time);

  /// Before the first stage of an ensemble: subtracts the influences that act during the drift.
  void begin_drift(AnyEnsemble& ensemble, double time, int threads);
  /// After it: applies them. `time` is that of the start of the step. PhysicsFailure if the midpoint iteration does not
  /// converge.
  void end_drift(AnyEnsemble& ensemble, double time, double dt, int threads);
  /// The last stage. `time` is that of the end of the step. PhysicsFailure if the step is too long for convergence of
  /// the velocity at its end. `division` is null unless the run is divided over ranks.
  void second_kick(int stage, StepContext const& context, double time, Division* division, int threads);

 private:
  struct Source;
  struct Kicked;
  struct Drifting;

  Drifting* drifting(AnyEnsemble const& ensemble);
  void add_between(double time);
  void add_outside(double time, bool of_drifting);
  void restore_others();
  double kick(int stage, StepContext const& context, Division* division, int threads);
  [[noreturn]] void refuse(double dt, std::string const& who, double factor) const;

  std::vector<std::unique_ptr<Source>> sources_;
  std::vector<Kicked> kicked_;
  std::vector<Drifting> drifting_;
  UnitSystem const* units_ = nullptr;
};

}  // namespace boltzmann
