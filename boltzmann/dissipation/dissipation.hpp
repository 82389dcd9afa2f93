// Dissipation: friction and noise, which change velocities and internal energies between the steps of Newton's motion.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/integrators/integrator.hpp>
#include <boltzmann/particles/division.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstdint>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// The other parts of a simulation that a dissipation depends on.
struct Surroundings {
  std::vector<AnyEnsemble const*> massive;    ///< all ensembles that carry momentum and move
  std::array<bool, 3> momentum_is_kept = {};  ///< total momentum along this axis, conserved by forces, walls and other
                                              ///< dissipations
  bool equilibrates = false;                  ///< an equilibration to a temperature is pending
};

/// One part of a split equation of motion. After every step of the integrators (kick, drift, kick) a simulation calls
/// its dissipations for the time of the step. They do not move particles, so forces, which are functions of positions,
/// stay valid.
class Dissipation {
 public:
  Dissipation() = default;
  virtual ~Dissipation() = default;
  Dissipation(Dissipation const&) = delete;
  Dissipation& operator=(Dissipation const&) = delete;

  /// The ensembles that it changes.
  virtual std::vector<AnyEnsemble*> ensembles() const = 0;
  /// Refuses what can't run, by an Error of one line. Called before a run.
  virtual void check() = 0;
  /// Advances velocities and internal energies by context.dt. PhysicsFailure, naming the particle, if an internal
  /// energy would not be positive or a number is not finite.
  virtual void advance(StepContext const& context) = 0;
  /// Brings derived fields (temperatures) up to date for observers; changes nothing that the next step depends on.
  virtual void update_derived_fields() {}
  /// True if update_derived_fields() sets this field.
  virtual bool derives(AnyEnsemble const& /*ensemble*/, Field const& /*field*/) const { return false; }
  /// The sum of the internal energies of its ensembles; zero for dissipations without them.
  virtual double internal_energy() const { return 0; }
  /// The reason why every rank of a team has to act on all particles, in a few words; empty if each acts on its own.
  virtual std::string undivided() const { return "the dissipation " + kind(); }
  /// From here on it acts on this rank's particles (AnyEnsemble::share()); null: all. For all ranks, as is advance() in
  /// between.
  virtual void divide(Division* division) { division_ = division; }
  /// The energy given from outside (by a heat bath) since the start of the run.
  virtual double heat() const { return 0; }
  /// True if the momentum of its ensembles is conserved.
  virtual bool keeps_momentum() const { return false; }
  /// True if it needs settle() before a run, which describes its surroundings; Error if it can't act there.
  virtual bool asks_for_surroundings() const { return false; }
  virtual void settle(Surroundings const&) {}
  /// Called after the box has been stretched. PhysicsFailure if it has become too small.
  virtual void box_changed() {}
  /// The simulation's box is sheared: from here on velocities are relative to its flow. Error if it can't act there.
  /// The box must outlive it.
  virtual void act_in_flow(Box const&) {
    throw Error("shear: the dissipation " + kind() + " knows no velocities relative to the flow of a sheared box");
  }
  /// The contribution of friction between pairs to EnergyAndVirial::virial, for the current velocities; noise
  /// contributes nothing on average.
  virtual std::array<std::array<double, 3>, 3> virial() { return {}; }
  /// True if it ignores frozen particles of its ensembles, and acts on the others.
  virtual bool spares_resting() const { return false; }
  /// Its name in scenarios, for `bzm show`.
  virtual std::string kind() const { return "dissipation"; }
  /// Notes for the start of a run with such steps; warnings begin with "warning: ".
  virtual std::vector<std::string> warnings(double /*step_size*/) { return {}; }
  /// One line about the work done, for the end of a run.
  virtual std::string report() const { return ""; }
  virtual std::size_t bytes() const { return 0; }

  /// The state, besides the particles, that a restart needs; restore() restores it. Error if it does not fit.
  virtual std::vector<double> state() const { return {}; }
  virtual void restore(std::span<double const>) {}

  void threads(int count) { threads_ = count < 1 ? default_threads() : count; }
  int threads() const { return threads_; }
  /// Its number in the simulation, which the simulation sets: two dissipations never share noise.
  void number(std::uint32_t number) { number_ = number; }
  std::uint32_t number() const { return number_; }

 protected:
  /// Null unless a run is divided.
  Division* division() const { return division_; }

 private:
  Division* division_ = nullptr;
  int threads_ = default_threads();
  std::uint32_t number_ = 0;
};

}  // namespace boltzmann
