// Dissipation: what changes velocities and internal energies between the steps of Newton's motion: friction and noise.
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

/// What is around a dissipation in its simulation.
struct Surroundings {
  std::vector<AnyEnsemble const*> massive;    ///< all ensembles that carry momentum and move
  std::array<bool, 3> momentum_is_kept = {};  ///< in total along this axis, by forces, walls and other dissipations
  bool equilibrates = false;                  ///< velocities are still to be brought to a temperature
};

/// One part of a split equation of motion. After every step of the integrators (kick, drift, kick) a simulation lets
/// its dissipations act for the time of the step, on the particles where they stand; forces, which are functions of
/// positions, stay what they are.
class Dissipation {
 public:
  Dissipation() = default;
  virtual ~Dissipation() = default;
  Dissipation(Dissipation const&) = delete;
  Dissipation& operator=(Dissipation const&) = delete;

  /// The ensembles that it changes.
  virtual std::vector<AnyEnsemble*> ensembles() const = 0;
  /// Refuses what can't run: Error with one line. Called before a run.
  virtual void check() = 0;
  /// Advances velocities and internal energies by context.dt. PhysicsFailure, naming the particle, if an internal
  /// energy would not be positive or something is not finite.
  virtual void advance(StepContext const& context) = 0;
  /// Brings what follows from others (temperatures) up to date for observers; it changes nothing that the next step
  /// depends on.
  virtual void update_derived_fields() {}
  /// The sum of the internal energies of its ensembles; zero for dissipations without.
  virtual double internal_energy() const { return 0; }
  /// Why every rank of a team acts on all particles, in a few words; empty if each acts on its share.
  virtual std::string undivided() const { return "the dissipation " + kind(); }
  /// From here on shares are acted on (AnyEnsemble::share()); null: all again. For all ranks, as is advance() in between.
  virtual void divide(Division* division) { division_ = division; }
  /// The energy that has come from outside (from a heat bath) since the start of the run.
  virtual double heat() const { return 0; }
  /// Whether the momentum of its ensembles is kept.
  virtual bool keeps_momentum() const { return false; }
  /// Whether it has to know its surroundings, which it is told before a run; Error if it can't act there.
  virtual bool asks_for_surroundings() const { return false; }
  virtual void settle(Surroundings const&) {}
  /// The box has been stretched. PhysicsFailure if it has become too small.
  virtual void box_changed() {}
  /// The simulation's box is sheared: from here on velocities are those relative to its flow. Error if it can't act there.
  /// The box outlives it.
  virtual void act_in_flow(Box const&) {
    throw Error("shear: the dissipation " + kind() + " knows no velocities relative to the flow of a sheared box");
  }
  /// What friction between pairs adds to EnergyAndVirial::virial, for velocities as they are; noise adds nothing in the
  /// mean.
  virtual std::array<std::array<double, 3>, 3> virial() { return {}; }
  /// Whether it leaves frozen particles of its ensembles alone, and acts on the others.
  virtual bool spares_resting() const { return false; }
  /// What it is, for `bzm show`: its word in scenarios.
  virtual std::string kind() const { return "dissipation"; }
  /// What one should know before a run with such steps; warnings begin with "warning: ".
  virtual std::vector<std::string> warnings(double /*step_size*/) { return {}; }
  /// One line about the work done, for the end of a run.
  virtual std::string report() const { return ""; }
  virtual std::size_t bytes() const { return 0; }

  /// What, besides the particles, has to go on after a restart; restore() takes it back. Error if it does not fit.
  virtual std::vector<double> state() const { return {}; }
  virtual void restore(std::span<double const>) {}

  void threads(int count) { threads_ = count < 1 ? default_threads() : count; }
  int threads() const { return threads_; }
  /// Its place among the dissipations of a simulation, which gives it: two dissipations never share noise.
  void number(std::uint32_t number) { number_ = number; }
  std::uint32_t number() const { return number_; }

 protected:
  /// While a run is divided.
  Division* division() const { return division_; }

 private:
  Division* division_ = nullptr;
  int threads_ = default_threads();
  std::uint32_t number_ = 0;
};

}  // namespace boltzmann
