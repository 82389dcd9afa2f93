// Simulation: the loop. Schemes calculate influences, integrators advance particles, observers look at finished steps.
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

/// Who looks at a run, or changes particles during it: for Simulation::forget.
enum class Attendant : std::uint64_t {};

class Simulation {
 public:
  /// A simulation of what the scheme supervises, in steps of this size (in the simulation's time unit). Scheme and
  /// ensembles must outlive it.
  Simulation(Scheme& scheme, double step_size);

  /// A further scheme that adds its influences (its ensembles may be the same or others).
  void add(Scheme& scheme);
  /// A dissipation that acts after every step, for the time of the step (it must outlive the simulation). Its ensembles
  /// are advanced by leap-frog. A run with dissipations can't go backwards.
  void add(Dissipation& dissipation);

  /// A pressure that is held by stretching the box, every so many steps, after dissipations. All influences are those of
  /// pairs, and all ensembles are advanced by leap-frog. A run with barostats can't go backwards.
  void add(Barostat barostat);
  /// The influences of one of several schemes are calculated every so many steps only, and count as often there: impulses
  /// of slow forces between steps of quick ones (r-RESPA: M. Tuckerman, B. J. Berne and G. J. Martyna, J. Chem. Phys. 97,
  /// 1990 (1992)). Velocities, and energies with them, are those of a step at multiples of `every`. All ensembles move by
  /// leap-frog then. Error unless `every` is 1 or more and the simulation has that scheme.
  void every(std::int64_t steps, Scheme& scheme);
  std::int64_t every(Scheme const& scheme) const;

  /// How an ensemble is advanced, if not as its class usually is (usual_method). A class with equations of motion of
  /// its own has no usual method.
  template <class P>
  void integrate(Ensemble<P>& ensemble, Method method) {
    integrate(ensemble, make_integrator(ensemble, method));
  }
  /// The same by an integrator of one's own, for this ensemble; it replaces the one before.
  void integrate(AnyEnsemble& ensemble, std::unique_ptr<Integrator> integrator);

  /// Calls the observer at step 0 (when the run starts) and whenever the step number is a multiple of `every`.
  /// Observers change nothing.
  Attendant observe(std::uint64_t every, std::function<void(Simulation const&)> observer);
  /// The same at the steps for which due(step) is true. At those for which sums(step) is, too, it asks for sums over
  /// particles alone (measure() and measures.hpp): where a run is divided over ranks, rows of others need not come then.
  Attendant observe_when(std::function<bool(std::int64_t step)> due, std::function<void(Simulation const&)> observer,
                         std::function<bool(std::int64_t step)> sums = {});
  /// Calls the observer after every step, for its number and time only: whatever it costs to bring particles up to date
  /// (see FusedSteps) is not spent.
  Attendant observe_progress(std::function<void(Simulation const&)> observer);

  /// Lets something change particles, or their number, after every step whose number is a multiple of `every`, before
  /// observers look. A run with adaptations can't go backwards, nor by the reversible leap-frog.
  Attendant adapt(std::uint64_t every, std::unique_ptr<Adaptation> adaptation);
  template <std::derived_from<Adaptation> A>
  Attendant adapt(std::uint64_t every, A adaptation) {
    return adapt(every, std::unique_ptr<Adaptation>(std::make_unique<A>(std::move(adaptation))));
  }
  Attendant adapt(std::uint64_t every, std::function<void()> change);
  /// An observer or an adaptation is not called any more. Nothing happens if there is none such. Observers may forget
  /// themselves, and each other, and may bring others.
  void forget(Attendant attendant);
  /// In the order in which they are called.
  std::vector<Adaptation const*> adaptations() const;

  /// Something happens once, at the end of the first step that ends at this time since the start of the run or later,
  /// after adaptations and before observers look. `lasting`: it sets a number of a law or a bath, a method, ..., and is
  /// done again where a run is resumed behind it; else it changes particles, which a checkpoint holds. A run with events
  /// can't go backwards. Error unless the time is positive.
  void happen(double time, std::function<void()> event, bool lasting);
  /// Particles are added once, at such a time too: `add` makes ensembles longer and leaves the rows that are there as
  /// they are (append() of loaders/append.hpp). By how much that changes the energy is counted as work. The run ends with
  /// an Error that names the step if they can't be where they are, or their forces would throw somebody in one step
  /// further than the law's length.
  void add_particles(double time, std::function<void()> add);
  /// Whether particles come or go while it runs, by adaptations or by such events.
  bool numbers_change() const;

  /// Before the first step of a run that begins (not of one that is resumed), so many steps are done with this
  /// dissipation in place of the simulation's own, on velocities relative to the common one of each ensemble: a body is
  /// brought to a temperature. Nobody observes these steps, they are not counted, and moving walls stand still.
  void equilibrate(std::shared_ptr<Dissipation> dissipation, std::uint64_t steps);

  /// Before the first step of a run that begins (not of one that is resumed), and before equilibrate(), particles are
  /// moved to a minimum of their energy (minimise.hpp). Forces of the start may be too large until then.
  void minimise_first(MinimiseOptions const& options);
  /// What the last one has come to; nothing: there was none.
  std::optional<Minimised> const& minimised() const { return minimised_; }

  /// Makes ready and refuses what can't run: an ensemble without an integrator, particles where they can't be,
  /// influences that are not finite (two particles at one place), a force that would move its particle in the first
  /// step further than its law's length (or the box). Error with one line. run() calls it once.
  void check();

  /// Advances by so many steps; less if stop() is called (from an observer, a signal handler or another thread): the
  /// step is finished first. PhysicsFailure, naming step and particle, if something is not finite, has escaped, or
  /// moved further in one step than its law's length.
  void run(std::uint64_t steps);
  /// The same with the negative step: the step number counts down. With the reversible leap-frog it retraces to the
  /// last bit.
  void rewind(std::uint64_t steps);
  void stop() { std::atomic_ref(stop_).store(true, std::memory_order_relaxed); }
  bool stopped() const { return std::atomic_ref(stop_).load(std::memory_order_relaxed); }
  /// Stops the present run() after its step, or the next one before its first step if none is under way: a call from
  /// another thread is not lost if that run() is about to begin. The run() that stops clears it.
  void pause() { std::atomic_ref(pause_).store(true, std::memory_order_relaxed); }
  /// Takes a pause() back that no run() has seen.
  void clear_pause() { std::atomic_ref(pause_).store(false, std::memory_order_relaxed); }
  /// Runs go on again after a stop().
  void clear_stop() { std::atomic_ref(stop_).store(false, std::memory_order_relaxed); }

  /// Brings influences, and the fields that schemes derive from others (a density), up to date with the rows, laws and
  /// boxes as they are now. Call it between two runs after you have written rows and before you read influences. It
  /// does nothing if they are up to date. Observers of a run find influences up to date, except those of FusedSteps,
  /// for which they call it, too. Error if particles are where they can't be or an influence is not finite.
  void refresh();
  /// Inside a run, from observe_progress(): brings rows up to date where FusedSteps advance particles of their own.
  void store_rows() {
    if (running_ && whole_.steps) whole_.steps->store(time());
  }
  /// Observers of this simulation read influences: FusedSteps, which keep none, then have them calculated for each look.
  void observers_read_influences() { observers_read_influences_ = true; }
  /// Whether refresh() finds this field from others.
  bool derives(AnyEnsemble const& ensemble, Field const& field) const;

  /// Laws read variables of the program, and these have changed since the last run(): influences are calculated anew.
  /// What particles, schemes, boxes and laws with numbers of their own hold need not be told of.
  void laws_changed();

  std::int64_t step() const { return step_; }
  double time() const { return base_time_ + static_cast<double>(step_ - base_step_) * step_size_; }
  double step_size() const { return step_size_; }
  /// For the steps to come; time() goes on from where it is. Between two run(), or from an observer. Error unless it is
  /// finite and not zero (negative: backwards).
  void step_size(double size);
  /// Of ensembles that move by gauss-radau: how large the last term of the series may be in each of their steps, in
  /// parts of the first. Error unless it is between 1e-14 and 0.01.
  void tolerance(double tolerance);
  GaussRadau const& gauss_radau() const { return gauss_radau_; }
  /// Steps are divided from now on: into 2^n equal parts, and these again, as short as the options ask where they
  /// begin and where they end. So steps end when they should, and a run backwards divides them alike. Ensembles move by
  /// leap-frog or symplectic-4 then. Error if an option is not positive.
  void divide_steps(SubstepOptions const& options);
  bool divides_steps() const { return substeps_.has_value(); }
  /// How many substeps there were so far in divided steps, and how many that were too long and done again.
  SubstepCounts const& substeps() const { return substep_counts_; }
  /// Of the random numbers of steps; loaders take theirs as an argument.
  std::uint64_t seed() const { return seed_; }
  void seed(std::uint64_t seed) { seed_ = seed; }
  /// The units in which failures and advice are told; plain numbers without it. A Recording says it.
  void speak_in(UnitSystem const& units);
  /// Of everything that there is by now; below 1: as many as the machine has. No bit depends on it.
  void threads(int count);

  std::vector<Scheme*> const& schemes() const { return schemes_; }
  std::vector<Dissipation*> const& dissipations() const { return dissipations_; }
  std::vector<std::unique_ptr<Barostat>> const& barostats() const { return barostats_; }
  /// Whether something is still to happen, or has happened.
  bool has_events() const { return !events_.empty(); }
  /// Whether equilibrate() is still to be done.
  bool equilibrates() const { return !equilibrations_.empty(); }
  /// Each once, in the order of the schemes; none before check().
  std::vector<AnyEnsemble*> const& ensembles() const { return ensembles_; }
  Method method(AnyEnsemble const& ensemble) const;
  /// Why every rank of a team advances all particles by itself, in a few words ("friction and noise"); empty where each
  /// advances its share.
  std::string undivided() const;
  /// How many particles there must be for that: with fewer, messages cost more than they save. 1,000 unless told.
  void divide_from(std::size_t particles) { divided_from_ = particles; }
  /// Energies and virial of the present state, over all schemes and dissipations. In an observer for all ranks of a team.
  EnergyAndVirial measure() const;
  /// Along which axes the total momentum of all particles with mass is kept, as far as is known: by influences, walls,
  /// baths, and because nothing rests. After check(); in an observer for all ranks of a team.
  std::array<bool, 3> momentum_is_kept() const;

  /// What, besides the particles, determines the bits of the next step.
  std::vector<double> state() const;
  /// Takes a state back after the ensembles' rows have been restored: the next step has the same bits as if the run had
  /// never stopped.
  void restore(std::int64_t step, double step_size, std::uint64_t seed, std::span<double const> state);

 private:
  struct Part {
    AnyEnsemble* ensemble;
    std::unique_ptr<Integrator> integrator;
    double longest_move2;  // square of the law's length
    int stages;
    std::vector<double> time_after;  // of each stage
    Scheme* home;                    // the first that supervises the ensemble: its box keeps the particles
  };
  static bool is_leap_frog(Part const& part) { return part.integrator->method() == Method::leap_frog; }
  // Those that are forgotten during a run go when it ends.
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

  static constexpr double max_courant = 4;  // the longest step that makes sense

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
  /// The cure where smooth particles need shorter steps than at the start; empty where there are none.
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
  std::vector<std::pair<Scheme const*, std::int64_t>> slow_;  // and steps between two calculations
  std::vector<Dissipation*> dissipations_;
  std::vector<AnyEnsemble*> ensembles_;
  std::vector<Part> parts_;
  // Places that stay when others come.
  std::deque<Observation> observations_;
  std::deque<Change> changes_;
  std::deque<Progress> progress_;
  std::uint64_t attendants_ = 0;
  std::vector<std::unique_ptr<Barostat>> barostats_;
  mutable std::optional<std::array<bool, 3>> momentum_is_kept_;  // once it was asked for
  std::vector<Event> events_;                                    // by their steps
  std::vector<Equilibration> equilibrations_;
  std::optional<MinimiseOptions> minimisation_;
  std::optional<Minimised> minimised_;
  GaussRadau gauss_radau_;
  VelocityForces velocity_forces_;
  bool in_second_kick_ = false;  // influences are calculated for it
  std::optional<SubstepOptions> substeps_;
  SubstepCounts substep_counts_;
  std::vector<double> before_substep_, of_others_;
  FixedPoint grid_;
  Scheme::SmallSystem small_system_;
  double step_size_;
  std::int64_t step_ = 0, base_step_ = 0;
  double base_time_ = 0, work_ = 0;
  // Of the state that check() has seen: the steps that collisions and forces allow.
  double collision_step_ = 0, force_step_ = 0;
  std::uint64_t seed_ = 1;
  int stages_ = 0;
  Freshness influences_;
  std::unique_ptr<Division> division_;
  std::vector<Scheme*> with_lists_;  // while it goes on, the one first that says who owns what
  std::size_t divided_from_ = 1000;
  struct {
    std::unique_ptr<FusedSteps> steps = {};
    double dt = 0;
    Dependence are_for = {};  // as they were stored; influences, which they don't read, are not asked for
  } whole_;
  std::uint64_t checked_rows_ = 0;                        // checksum of the rows that check() has calculated for
  std::optional<std::uint64_t> rows_before_change_ = {};  // while an adaptation acts
  bool checked_ = false, begun_ = false, running_ = false, observers_read_influences_ = false;
  mutable bool stop_ = false;   // read and written as an atomic one: a signal or another thread may set it
  mutable bool pause_ = false;  // the same
};

/// Somebody who attends a simulation as long as this lives.
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
