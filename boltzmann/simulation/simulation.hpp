// Simulation: the main loop. Schemes calculate influences, integrators advance particles, observers see finished steps.
#pragma once

#include <boltzmann/dissipation/dissipation.hpp>
#include <boltzmann/integrators/gauss_radau.hpp>
#include <boltzmann/integrators/methods.hpp>
#include <boltzmann/particles/division.hpp>
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/simulation/adaptation.hpp>
#include <boltzmann/simulation/barostat.hpp>
#include <boltzmann/simulation/freshness.hpp>
#include <boltzmann/simulation/minimise.hpp>
#include <boltzmann/simulation/substeps.hpp>
#include <boltzmann/simulation/velocity_forces.hpp>

#include <array>
#include <atomic>
#include <concepts>
#include <cstdint>
#include <deque>
#include <functional>
#include <memory>
#include <optional>
#include <utility>
#include <vector>

namespace boltzmann {

struct Descending;

/// A handle of an observer or an adaptation: for Simulation::forget.
enum class Attendant : std::uint64_t {};

class Simulation {
 public:
  /// A simulation of the ensembles of a scheme, in steps of this size (in the simulation's time unit). Scheme and
  /// ensembles must outlive it.
  Simulation(Scheme& scheme, double step_size);

  /// Adds a further scheme, whose influences are added (its ensembles may be the same or others).
  void add(Scheme& scheme);
  /// Adds a dissipation that acts after every step, for the time of the step (it must outlive the simulation). Its
  /// ensembles are advanced by leap-frog. A run with dissipations can't go backwards.
  void add(Dissipation& dissipation);

  /// Adds a barostat, which stretches the box at intervals of steps, after dissipations. All influences must be those
  /// of pairs, and all ensembles are advanced by leap-frog. A run with barostats can't go backwards.
  void add(Barostat barostat);
  /// Calculates the influences of one of several schemes only at intervals of steps, multiplied by the interval:
  /// impulses of slow forces between steps of fast ones (r-RESPA: M. Tuckerman, B. J. Berne and G. J. Martyna, J. Chem.
  /// Phys. 97, 1990 (1992)). Velocities, and energies with them, are those of a step at multiples of `every`. All
  /// ensembles move by leap-frog then. Error unless `every` is 1 or more and the simulation has that scheme.
  void every(std::int64_t steps, Scheme& scheme);
  std::int64_t every(Scheme const& scheme) const;

  /// Sets the method of an ensemble, instead of the default of its class (usual_method). A class with equations of
  /// motion of its own has no default.
  template <class P>
  void integrate(Ensemble<P>& ensemble, Method method) {
    integrate(ensemble, make_integrator(ensemble, method));
  }
  /// Sets a custom integrator for this ensemble; it replaces the one before.
  void integrate(AnyEnsemble& ensemble, std::unique_ptr<Integrator> integrator);

  /// Calls the observer at step 0 (when the run starts) and whenever the step number is a multiple of `every`.
  /// Observers must not change anything.
  Attendant observe(std::uint64_t every, std::function<void(Simulation const&)> observer);
  /// Calls the observer at the steps for which due(step) is true. If sums(step) is true as well, the observer uses
  /// global sums only (measure() and measures.hpp), so that a divided run need not gather rows.
  Attendant observe_when(std::function<bool(std::int64_t step)> due, std::function<void(Simulation const&)> observer,
                         std::function<bool(std::int64_t step)> sums = {});
  /// Calls the observer after every step, for its number and time only: particles are not brought up to date (see
  /// FusedSteps), which saves that cost.
  Attendant observe_progress(std::function<void(Simulation const&)> observer);

  /// Lets an adaptation change particles, or their number, after every step whose number is a multiple of `every`,
  /// before observers are called. A run with adaptations can't go backwards, nor use the reversible leap-frog.
  Attendant adapt(std::uint64_t every, std::unique_ptr<Adaptation> adaptation);
  template <std::derived_from<Adaptation> A>
  Attendant adapt(std::uint64_t every, A adaptation) {
    return adapt(every, std::unique_ptr<Adaptation>(std::make_unique<A>(std::move(adaptation))));
  }
  Attendant adapt(std::uint64_t every, std::function<void()> change);
  /// Removes an observer or an adaptation. Does nothing if there is none. Observers may remove themselves and each
  /// other, and may add others.
  void forget(Attendant attendant);
  /// In the order of their calls.
  std::vector<Adaptation const*> adaptations() const;

  /// Calls an event once, at the end of the first step that ends at this time since the start of the run or later,
  /// after adaptations and before observers. `lasting`: it sets a number of a law or a bath, a method, ..., and is
  /// repeated when a run is resumed after it; otherwise it changes particles, which a checkpoint contains. A run with
  /// events can't go backwards. Error unless the time is positive.
  void happen(double time, std::function<void()> event, bool lasting);
  /// Adds particles once, at such a time: `add` extends ensembles and keeps existing rows (append() of
  /// loaders/append.hpp). The change of energy counts as work. The run ends with an Error that names the step if
  /// particles are at invalid positions, or if their forces would move a particle in one step further than the law's
  /// length.
  void add_particles(double time, std::function<void()> add);
  /// True if the number of particles changes during a run, by adaptations or by such events.
  bool numbers_change() const;

  /// Brings a body to a temperature before the first step of a new run (not of a resumed one). It does this number of
  /// steps with this dissipation in place of the simulation's own, on velocities relative to the common one of each
  /// ensemble. Observers are not called during equilibration, steps are not counted, and moving walls are at rest.
  void equilibrate(std::shared_ptr<Dissipation> dissipation, std::uint64_t steps);

  /// Before the first step of a new run (not of a resumed one), and before equilibrate(), particles are moved to a
  /// minimum of their energy (minimise.hpp). Initial forces may be too large before.
  void minimise_first(MinimiseOptions const& options);
  /// The result of the last minimisation; nothing: there was none.
  std::optional<Minimised> const& minimised() const { return minimised_; }

  /// Prepares the simulation, and throws an Error of one line if it can't run. Reasons: an ensemble without an
  /// integrator, particles at invalid positions, influences that are not finite (two coincident particles), or a force
  /// that would move its particle in the first step further than its law's length (or the box). run() calls it once.
  void check();

  /// Advances by this number of steps; fewer if stop() is called (from an observer, a signal handler or another
  /// thread): the current step is finished first. PhysicsFailure, naming step and particle, if a number is not finite,
  /// or a particle has escaped or moved further in one step than its law's length.
  void run(std::uint64_t steps);
  /// The same with the negative step: the step number decreases. With the reversible leap-frog it retraces the
  /// trajectory to the last bit.
  void rewind(std::uint64_t steps);
  void stop() { std::atomic_ref(stop_).store(true, std::memory_order_relaxed); }
  bool stopped() const { return std::atomic_ref(stop_).load(std::memory_order_relaxed); }
  /// Stops the present run() after its step, or the next one before its first step if none is in progress: a call from
  /// another thread is not lost if that run() is about to begin. The run() that stops clears it.
  void pause() { std::atomic_ref(pause_).store(true, std::memory_order_relaxed); }
  /// Cancels a pause() that no run() has seen.
  void clear_pause() { std::atomic_ref(pause_).store(false, std::memory_order_relaxed); }
  /// Allows runs again after a stop().
  void clear_stop() { std::atomic_ref(stop_).store(false, std::memory_order_relaxed); }

  /// Brings influences, and the fields that schemes derive from others (a density), up to date with the current rows,
  /// laws and boxes. Call it between two runs after you have written rows and before you read influences. It does
  /// nothing if they are up to date. Observers of a run see current influences. The exception is FusedSteps, for which
  /// observers call it, too. Error if particles are at invalid positions or an influence is not finite.
  void refresh();
  /// Inside a run, from observe_progress(): brings rows up to date if FusedSteps advance particles of their own.
  void store_rows() {
    if (running_ && whole_.steps) whole_.steps->store(time());
  }
  /// Declares that observers of this simulation read influences: FusedSteps, which keep none, then have them calculated
  /// for each observation.
  void observers_read_influences() { observers_read_influences_ = true; }
  /// True if refresh() derives this field from others.
  bool derives(AnyEnsemble const& ensemble, Field const& field) const;

  /// Notifies the simulation that variables of the program which laws read have changed since the last run():
  /// influences are recalculated. Not needed for particles, schemes, boxes and laws with numbers of their own.
  void laws_changed();

  std::int64_t step() const { return step_; }
  double time() const { return base_time_ + static_cast<double>(step_ - base_step_) * step_size_; }
  double step_size() const { return step_size_; }
  /// Sets the step size; time() continues from its current value. Call it between two run(), or from an observer. Error
  /// unless it is finite and not zero (negative: backwards).
  void step_size(double size);
  /// For ensembles that move by gauss-radau: the limit of the last term of the series in each of their steps, relative
  /// to the first. Error unless it is between 1e-14 and 0.01.
  void tolerance(double tolerance);
  GaussRadau const& gauss_radau() const { return gauss_radau_; }
  /// Divides steps from now on into 2^n equal parts, adaptively, as short as the options require at the beginning and
  /// the end of each part. So output times are kept, and a run backwards divides steps alike. Ensembles move by
  /// leap-frog or symplectic-4 then. Error if an option is not positive.
  void divide_steps(SubstepOptions const& options);
  bool divides_steps() const { return substeps_.has_value(); }
  /// The number of substeps so far in divided steps, and of those that were too long and repeated.
  SubstepCounts const& substeps() const { return substep_counts_; }
  /// The seed of the random numbers of steps; loaders have theirs as an argument.
  std::uint64_t seed() const { return seed_; }
  void seed(std::uint64_t seed) { seed_ = seed; }
  /// Units of error messages and advice; by default plain numbers. A Recording sets it.
  void speak_in(UnitSystem const& units);
  /// Sets the threads of all present parts; below 1: those of the machine. No bit depends on it.
  void threads(int count);

  std::vector<Scheme*> const& schemes() const { return schemes_; }
  std::vector<Dissipation*> const& dissipations() const { return dissipations_; }
  std::vector<std::unique_ptr<Barostat>> const& barostats() const { return barostats_; }
  /// True if there are past or future events.
  bool has_events() const { return !events_.empty(); }
  /// True if an equilibrate() is pending.
  bool equilibrates() const { return !equilibrations_.empty(); }
  /// Each once, in the order of the schemes; none before check().
  std::vector<AnyEnsemble*> const& ensembles() const { return ensembles_; }
  Method method(AnyEnsemble const& ensemble) const;
  /// The reason why every rank of a team has to advance all particles, in a few words ("friction and noise"); empty if
  /// each rank advances its own.
  std::string undivided() const;
  /// The least number of particles for a division: with fewer, messages cost more than they save. Default 1,000.
  void divide_from(std::size_t particles) { divided_from_ = particles; }
  /// Energies and virial of the current state, over all schemes and dissipations. In an observer for all ranks of a
  /// team.
  EnergyAndVirial measure() const;
  /// The axes along which the total momentum of all particles with mass is known to be conserved: by influences, walls
  /// and baths, and because no particle rests. After check(); in an observer for all ranks of a team.
  std::array<bool, 3> momentum_is_kept() const;

  /// The state, besides the particles, that determines the bits of the next step.
  std::vector<double> state() const;
  /// Restores a state after the ensembles' rows have been restored: the next step has the same bits as in an
  /// uninterrupted run.
  void restore(std::int64_t step, double step_size, std::uint64_t seed, std::span<double const> state);

 private:
  struct Part {
    AnyEnsemble* ensemble;
    std::unique_ptr<Integrator> integrator;
    double longest_move2;  // square of the law's length
    int stages;
    std::vector<double> time_after;  // of each stage
    Scheme* home;                    // the first that has the ensemble: its box keeps the particles
  };
  static bool is_leap_frog(Part const& part) { return part.integrator->method() == Method::leap_frog; }
  // Observations that are removed during a run are deleted when it ends.
  struct Observation {
    Attendant attendant;
    std::function<bool(std::int64_t step)> due;
    std::function<void(Simulation const&)> observer;
    std::function<bool(std::int64_t step)> sums;
    bool forgotten = false;
  };
  struct Change {
    Attendant attendant;
    std::int64_t every;
    std::unique_ptr<Adaptation> adaptation;
    bool forgotten = false;
  };
  struct Progress {
    Attendant attendant;
    std::function<void(Simulation const&)> observer;
    bool forgotten = false;
  };

  struct Event {
    std::int64_t step;
    std::function<void()> happen;
    bool lasting, adds;
  };

  struct Equilibration {
    std::shared_ptr<Dissipation> dissipation;
    std::uint64_t steps;
  };

  static constexpr double max_courant = 4;  // the longest sensible step

  // minimise.cpp
  friend Minimised minimise(Simulation& simulation, MinimiseOptions const& options);
  std::pair<std::vector<Descending>, double> descending(MinimiseOptions const& options) const;

  // checks.cpp: before the first step.
  void check(bool added);
  void make_ready();
  void check_start(bool added);
  std::vector<Moved> moved() const;
  Part const& ready_part(AnyEnsemble& ensemble);
  void find_velocity_forces();
  void check_methods();
  void check_velocity_forces() const;
  void check_substeps() const;
  void check_slow_schemes();
  void check_influences() const;
  void check_dissipations();
  void check_barostats();
  void settle_dissipations();
  FixedPoint choose_grid() const;
  void make_reversible(FixedPoint const& grid);

  // sheared_box.cpp
  void check_shear();
  void establish_flow();

  // advance.cpp: one step.
  void move_walls(double time);
  void calculate(double time) { calculate(time, step_); }
  void calculate(double time, std::int64_t step);
  void add_all_influences(double time, std::int64_t step);
  void add_impulse(Scheme& scheme, double time, std::int64_t times);
  void advance(double dt, std::vector<Dissipation*> const& dissipations);
  void advance(double start, double dt);
  void keep_in_box(Part& part);
  void advance_by_gauss_radau(double dt);
  void advance_in_substeps(double dt);
  double longest_substep_now(std::vector<Moved> const& moving);
  void keep_rows();
  void restore_rows();
  std::unique_ptr<FusedSteps> fused_steps(double dt);
  FusedSteps* whole_steps(double dt, std::optional<Dependence> const& now);
  void refresh_in_run();
  std::uint64_t checksum(bool with_influences = true) const;
  Dependence dependence(bool with_influences) const;
  void check_moves();
  void check_move(Part const& part, LargestMove const& move) const;
  std::string advice() const;
  /// The cure if smooth particles need shorter steps than at the start; empty if there are none.
  std::string advice_on_substeps() const;

  // divided_run.cpp: over the ranks of a team.
  bool is_divided() const { return division_ && division_->goes_on(); }
  std::vector<Scheme*> schemes_with_lists() const;
  std::vector<Integrator::Carried> held_inside_step(AnyEnsemble const& ensemble);
  void divide();
  void end_division();
  void interrupt_division();
  void gather_particles() const;
  bool sums_suffice() const;
  void check_moves_together();

  void refuse_backwards() const;
  void begin();
  void run(std::uint64_t steps, int direction);
  bool take_step(int direction, FusedSteps* whole, bool last);
  void complete_last_step(FusedSteps* whole, bool last);
  Part* part_of(AnyEnsemble const& ensemble);
  UnitSystem const& units() const;
  std::string told_time(double number) const;
  void update_derived_fields() const;
  bool paused() const { return std::atomic_ref(pause_).load(std::memory_order_relaxed); }
  void take_lengths();
  void accept_particles();
  void take_particles();
  std::vector<std::size_t> sizes() const;
  void adapt_now();
  void schedule(double time, std::function<void()> event, bool lasting, bool adds);
  std::size_t first_event(std::int64_t step) const;
  void happen_now();
  void add_now(std::function<void()> const& add);
  void set_mobility(Part const& part);
  StretchedSystem stretched_system();
  void stretch_box(double dt);
  bool observation_due() const;
  bool change_due() const;
  void observe_now() const;
  void drop_forgotten();
  void settle_velocities();
  void equilibrate_now();

  std::vector<Scheme*> schemes_;
  std::vector<std::pair<Scheme const*, std::int64_t>> slow_;  // with their intervals in steps
  std::vector<Dissipation*> dissipations_;
  std::vector<AnyEnsemble*> ensembles_;
  std::vector<Part> parts_;
  // A deque, so that elements keep their addresses.
  std::deque<Observation> observations_;
  std::deque<Change> changes_;
  std::deque<Progress> progress_;
  std::uint64_t attendants_ = 0;
  std::vector<std::unique_ptr<Barostat>> barostats_;
  mutable std::optional<std::array<bool, 3>> momentum_is_kept_;  // cached
  std::vector<Event> events_;                                    // in the order of their steps
  std::vector<Equilibration> equilibrations_;
  std::optional<MinimiseOptions> minimisation_;
  std::optional<Minimised> minimised_;
  GaussRadau gauss_radau_;
  VelocityForces velocity_forces_;
  bool in_second_kick_ = false;  // influences are calculated for the second kick
  std::optional<SubstepOptions> substeps_;
  SubstepCounts substep_counts_;
  std::vector<double> before_substep_, of_others_;
  FixedPoint grid_;
  Scheme::SmallSystem small_system_;
  double step_size_;
  std::int64_t step_ = 0, base_step_ = 0;
  double base_time_ = 0, work_ = 0;
  // At the state of check(): the steps that collisions and forces allow.
  double collision_step_ = 0, force_step_ = 0;
  std::uint64_t seed_ = 1;
  int stages_ = 0;
  Freshness influences_;
  std::unique_ptr<Division> division_;
  std::vector<Scheme*> with_lists_;  // of a divided run; the first one decides on owners
  std::size_t divided_from_ = 1000;
  struct {
    std::unique_ptr<FusedSteps> steps = {};
    double dt = 0;
    Dependence are_for = {};  // the dependences when they were stored, without influences
  } whole_;
  std::uint64_t checked_rows_ = 0;                        // checksum of the rows for which check() has calculated
                                                          // influences
  std::optional<std::uint64_t> rows_before_change_ = {};  // while an adaptation acts
  bool checked_ = false, begun_ = false, running_ = false, observers_read_influences_ = false;
  mutable bool stop_ = false;   // accessed atomically: a signal or another thread may set it
  mutable bool pause_ = false;  // likewise
};

/// Removes an observer or an adaptation from a simulation when destroyed.
class Attending {
 public:
  Attending(Simulation& simulation, Attendant attendant) : simulation_(simulation), attendant_(attendant) {}
  ~Attending() { simulation_.forget(attendant_); }
  Attending(Attending const&) = delete;
  Attending& operator=(Attending const&) = delete;

 private:
  Simulation& simulation_;
  Attendant attendant_;
};

}  // namespace boltzmann
