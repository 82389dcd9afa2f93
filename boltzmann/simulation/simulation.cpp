// The parts of a simulation, its loop, and its state.
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/schemes/after_others.hpp>
#include <boltzmann/schemes/restored_influences.hpp>
#include <boltzmann/simulation/conserved.hpp>
#include <boltzmann/simulation/keeps_numbers.hpp>
#include <boltzmann/simulation/run_votes.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <boltzmann/simulation/velocity_changes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::uint32_t first_equilibration = 128;  // number of random streams of equilibrations

void set_moving(AnyEnsemble& ensemble, std::array<double, 3> const& drift) {
  kick({{&ensemble, all_particles(ensemble)}}, drift);
}

/// Subtracts the velocity of the centre of mass from the moving particles, and returns it.
std::array<double, 3> come_to_rest(AnyEnsemble& ensemble) {
  auto const drift = common_velocity({{&ensemble, all_particles(ensemble)}});
  set_moving(ensemble, {-drift[0], -drift[1], -drift[2]});
  return drift;
}

/// Whole steps have particles of their own: in a divided run those of this rank, valid only in that division.
Dependence of_whole_steps(Dependence now, Division const* division) {
  if (division && now.schemes) *now.schemes += division->id() * 0x9E3779B97F4A7C15U;
  return now;
}

}  // namespace

Simulation::Simulation(Scheme& scheme, double step_size) : step_size_(0) {
  team();  // ranks above 0 print nothing from here on
  this->step_size(step_size);
  add(scheme);
}

void Simulation::add(Scheme& scheme) {
  if (comes_last(&scheme) && any_comes_last(schemes_))
    throw Error("two schemes would each have to come after the other: put all bodies into one");
  schemes_.insert(std::find_if(schemes_.begin(), schemes_.end(), comes_last), &scheme);
  checked_ = false;
}

void Simulation::every(std::int64_t steps, Scheme& scheme) {
  if (steps < 1) throw Error(fmt::format("a scheme is calculated every 1 or more steps, not every {}", steps));
  if (std::find(schemes_.begin(), schemes_.end(), &scheme) == schemes_.end())
    throw Error("a scheme with every > 1 is not part of the simulation; add it first");
  std::erase_if(slow_, [&](auto const& one) { return one.first == &scheme; });
  if (steps > 1) slow_.emplace_back(&scheme, steps);
  checked_ = false;
}

std::int64_t Simulation::every(Scheme const& scheme) const {
  for (auto const& [slow, steps] : slow_)
    if (slow == &scheme) return steps;
  return 1;
}

void Simulation::add(Dissipation& dissipation) {
  dissipation.number(static_cast<std::uint32_t>(dissipations_.size()));
  dissipations_.push_back(&dissipation);
  checked_ = false;
}

void Simulation::add(Barostat barostat) {
  barostat.number(static_cast<std::uint32_t>(barostats_.size()));
  barostats_.push_back(std::make_unique<Barostat>(std::move(barostat)));
  checked_ = false;
}

void Simulation::happen(double time, std::function<void()> event, bool lasting) {
  schedule(time, std::move(event), lasting, false);
}

void Simulation::add_particles(double time, std::function<void()> add) { schedule(time, std::move(add), false, true); }

bool Simulation::numbers_change() const {
  auto const changes = adaptations();
  return std::any_of(changes.begin(), changes.end(), [](auto const* one) { return !keeps_numbers(*one); }) ||
         std::any_of(events_.begin(), events_.end(), [](Event const& event) { return event.adds; });
}

/// Events of one step are called in the order of their registration.
void Simulation::schedule(double time, std::function<void()> event, bool lasting, bool adds) {
  if (!(time > 0) || !std::isfinite(time))
    throw Error(fmt::format("an event happens at a positive time since the start of the run, not at {}", time));
  // A time that is a whole number of steps, up to rounding, is that number.
  double const step = std::ceil(time / std::abs(step_size_) * (1 - 1e-12));
  if (step > 9e15) throw Error(fmt::format("an event at {} would happen after {:.3g} steps", told_time(time), step));
  auto const at = static_cast<std::int64_t>(step);
  events_.insert(events_.begin() + static_cast<std::ptrdiff_t>(first_event(at + 1)),
                 {at, std::move(event), lasting, adds});
}

/// The first of this step or a later one.
std::size_t Simulation::first_event(std::int64_t step) const {
  auto const found = std::lower_bound(events_.begin(), events_.end(), step,
                                      [](Event const& event, std::int64_t at) { return event.step < at; });
  return static_cast<std::size_t>(found - events_.begin());
}

void Simulation::integrate(AnyEnsemble& ensemble, std::unique_ptr<Integrator> integrator) {
  checked_ = false;
  if (Part* const part = part_of(ensemble))
    part->integrator = std::move(integrator);
  else
    parts_.push_back({&ensemble, std::move(integrator), 0, 0, {}, nullptr});
}

Simulation::Part* Simulation::part_of(AnyEnsemble const& ensemble) {
  auto const part = std::find_if(parts_.begin(), parts_.end(), [&](Part const& p) { return p.ensemble == &ensemble; });
  return part == parts_.end() ? nullptr : &*part;
}

Attendant Simulation::observe(std::uint64_t every, std::function<void(Simulation const&)> observer) {
  if (every == 0) throw Error("the interval of an observer must be 1 step or more, not 0");
  return observe_when([every](std::int64_t step) { return step % static_cast<std::int64_t>(every) == 0; },
                      std::move(observer));
}

Attendant Simulation::observe_when(std::function<bool(std::int64_t)> due,
                                   std::function<void(Simulation const&)> observer,
                                   std::function<bool(std::int64_t)> sums) {
  observations_.push_back({Attendant{++attendants_}, std::move(due), std::move(observer), std::move(sums)});
  return observations_.back().attendant;
}

Attendant Simulation::observe_progress(std::function<void(Simulation const&)> observer) {
  progress_.push_back({Attendant{++attendants_}, std::move(observer)});
  return progress_.back().attendant;
}

Attendant Simulation::adapt(std::uint64_t every, std::unique_ptr<Adaptation> adaptation) {
  if (every == 0) throw Error("an adaptation changes particles every 1 or more steps, not every 0");
  checked_ = false;
  changes_.push_back({Attendant{++attendants_}, static_cast<std::int64_t>(every), std::move(adaptation)});
  return changes_.back().attendant;
}

Attendant Simulation::adapt(std::uint64_t every, std::function<void()> change) {
  struct Call final : Adaptation {
    explicit Call(std::function<void()> what) : function(std::move(what)) {}
    void change() override { function(); }
    std::function<void()> function;
  };
  return adapt(every, std::unique_ptr<Adaptation>(std::make_unique<Call>(std::move(change))));
}

void Simulation::forget(Attendant attendant) {
  auto const mark = [&](auto& all) {
    for (auto& one : all) one.forgotten = one.forgotten || one.attendant == attendant;
  };
  mark(observations_), mark(changes_), mark(progress_);
  if (!running_) drop_forgotten();
}

void Simulation::drop_forgotten() {
  auto const drop = [](auto& all) { std::erase_if(all, [](auto const& one) { return one.forgotten; }); };
  drop(observations_), drop(changes_), drop(progress_);
}

std::vector<Adaptation const*> Simulation::adaptations() const {
  std::vector<Adaptation const*> all;
  for (auto const& change : changes_) all.push_back(change.adaptation.get());
  return all;
}

void Simulation::equilibrate(std::shared_ptr<Dissipation> dissipation, std::uint64_t steps) {
  dissipation->number(first_equilibration + static_cast<std::uint32_t>(equilibrations_.size()));
  equilibrations_.push_back({std::move(dissipation), steps});
  checked_ = false;
}

void Simulation::step_size(double size) {
  if (!std::isfinite(size) || size == 0)
    throw Error(fmt::format("the step size is a finite time other than zero, not {}", size));
  base_time_ = time();
  base_step_ = step_;
  step_size_ = size;
  influences_.outdated();
}

void Simulation::tolerance(double tolerance) {
  if (!(tolerance >= 1e-14 && tolerance <= 0.01))
    throw Error(fmt::format("the tolerance is a number between 1e-14 and 0.01, not {}", tolerance));
  gauss_radau_.tolerance(tolerance);
}

void Simulation::divide_steps(SubstepOptions const& options) {
  boltzmann::check(options);
  substeps_ = options;
  checked_ = false;
}

void Simulation::threads(int count) {
  for (auto* scheme : schemes_) scheme->threads(count);
  for (auto* dissipation : dissipations_) dissipation->threads(count);
  for (auto& part : parts_) part.integrator->threads(count < 1 ? default_threads() : count);
}

Method Simulation::method(AnyEnsemble const& ensemble) const {
  for (auto const& part : parts_)
    if (part.ensemble == &ensemble) return part.integrator->method();
  return usual_method(ensemble);
}

UnitSystem const& Simulation::units() const { return schemes_.front()->spoken_units(); }

std::string Simulation::told_time(double number) const { return units().text(number, dimensions::time); }

void Simulation::speak_in(UnitSystem const& units) {
  for (auto* scheme : schemes_) scheme->speak_in(units);
}

std::uint64_t Simulation::checksum(bool with_influences) const {
  return rows_checksum(ensembles_, schemes_.front()->threads(), with_influences);
}

Dependence Simulation::dependence(bool with_influences) const {
  Dependence now{checksum(with_influences), 0};
  for (auto const* scheme : schemes_) {
    auto const revision = scheme->revision();
    now.schemes =
        now.schemes && revision ? std::optional(*now.schemes * 0x9E3779B97F4A7C15U + *revision) : std::nullopt;
  }
  return now;
}

void Simulation::laws_changed() {
  influences_.particles_changed();
  whole_ = {};
}

void Simulation::take_lengths() {
  for (auto& part : parts_) {
    double scale = std::numeric_limits<double>::infinity();
    for (auto const* scheme : schemes_) scale = std::min(scale, scheme->length_scale(*part.ensemble));
    part.longest_move2 = scale * scale;
  }
}

/// Wraps all particles into the box; refuses those at invalid positions.
void Simulation::accept_particles() {
  for (auto* scheme : schemes_)
    for (auto* ensemble : scheme->ensembles()) {
      check_masses(*ensemble);
      scheme->box().check(*ensemble);
      scheme->box().wrap(*ensemble);
    }
}

/// After particles have been changed between steps.
void Simulation::take_particles() {
  accept_particles();
  influences_.particles_changed();
  small_system_ = schemes_.size() == 1 ? schemes_.front()->small_system() : Scheme::SmallSystem{};
  take_lengths();
}

void Simulation::adapt_now() {
  bool completed = false, changed = false;
  for (auto const& change : changes_) {
    if (step_ % change.every != 0 || change.forgotten) continue;
    if (!completed) update_derived_fields();
    interrupt_division();
    changed = true;
    auto const before = checksum();
    auto const sizes_before = sizes();
    rows_before_change_ = before;
    try {
      change.adaptation->change();
      rows_before_change_.reset();
      auto const sizes_now = sizes();
      for (std::size_t k = 0; k < parts_.size(); ++k)
        if (sizes_now[k] != sizes_before[k] && !parts_[k].integrator->same_for_all())
          throw Error(
              fmt::format("ensemble '{}' had {} particles and has {} now, but some of them are frozen, by number",
                          parts_[k].ensemble->name(), sizes_before[k], sizes_now[k]));
      completed = sizes_now == sizes_before && checksum() == before;
      if (!completed) take_particles();
    } catch (Error const& error) {
      throw Error(fmt::format("step {}: {}", step_, error.what()));
    } catch (PhysicsFailure const& failure) {
      throw PhysicsFailure(fmt::format("step {}: {}", step_, failure.what()));
    }
  }
  if (changed) divide();
}

void Simulation::happen_now() {
  std::size_t k = first_event(step_);
  if (k == events_.size() || events_[k].step != step_) return;
  update_derived_fields();
  bool added = false;
  try {
    for (; k < events_.size() && events_[k].step == step_; ++k) {
      interrupt_division();
      auto const happen = events_[k].happen;  // it may add others
      auto const before = sizes();
      if (events_[k].adds) {
        added = true;
        add_now(happen);
      } else {
        happen();
        if (!events_[k].lasting) settle_velocities();
        if (sizes() != before)
          throw Error("only add_particles() (C++) may add particles in an event, and no event may remove them");
      }
    }
    checked_ = false;  // laws and methods may have changed
    check(added);
  } catch (Error const& error) {
    throw Error(fmt::format("step {}: {}", step_, error.what()));
  } catch (PhysicsFailure const& failure) {
    throw PhysicsFailure(fmt::format("step {}: {}", step_, failure.what()));
  }
  influences_.particles_changed();
  take_particles();
  divide();
}

/// Rigid bonds remove changes of velocities along them.
void Simulation::settle_velocities() {
  for (auto const& part : parts_) part.integrator->settle_velocities();
}

/// The change of energy, as far as it is known, counts as work.
void Simulation::add_now(std::function<void()> const& add) {
  auto const before = sizes();
  auto const energy = conserved(*this).energy;
  add();
  auto const now = sizes();
  for (std::size_t e = 0; e < before.size(); ++e)
    if (now[e] < before[e])
      throw Error(fmt::format("an event adds particles and takes none away, but '{}' has had {} and has {} now",
                              parts_[e].ensemble->name(), before[e], now[e]));
  take_particles();
  if (auto const changed = conserved(*this).energy; energy && changed) work_ += *changed - *energy;
}

std::vector<std::size_t> Simulation::sizes() const {
  std::vector<std::size_t> all;
  for (auto const& part : parts_) all.push_back(part.ensemble->size());
  return all;
}

bool Simulation::observation_due() const {
  return std::any_of(observations_.begin(), observations_.end(),
                     [&](Observation const& one) { return !one.forgotten && one.due(step_); });
}

bool Simulation::change_due() const {
  return std::any_of(changes_.begin(), changes_.end(),
                     [&](Change const& one) { return !one.forgotten && step_ % one.every == 0; }) ||
         first_event(step_) != first_event(step_ + 1);
}

void Simulation::observe_now() const {
  if (!observation_due()) return;
  update_derived_fields();
  std::optional<Division::Sums> sums;
  if (is_divided() && sums_suffice())
    sums.emplace(*division_);
  else if (is_divided())
    gather_particles();
  std::size_t const count = observations_.size();  // others may be added
  for (std::size_t k = 0; k < count; ++k)
    if (auto const& one = observations_[k]; !one.forgotten && one.due(step_)) one.observer(*this);
}

void Simulation::equilibrate_now() {
  if (equilibrations_.empty()) return;
  auto const equilibrations = std::move(equilibrations_);
  equilibrations_.clear();
  for (auto* scheme : schemes_) scheme->box().hold_walls(true);
  for (auto const& [dissipation, steps] : equilibrations) {
    dissipation->threads(schemes_.front()->threads());
    std::vector<std::array<double, 3>> drifts;
    for (auto* ensemble : dissipation->ensembles()) drifts.push_back(come_to_rest(*ensemble));
    if (velocity_forces_.any()) influences_.outdated();
    // A stop waits until the end: an equilibration can't be resumed halfway.
    for (std::uint64_t n = 0; n < steps; ++n) {
      try {
        advance(step_size_, {dissipation.get()});
        settle_velocities();
      } catch (PhysicsFailure const& failure) {
        throw PhysicsFailure(fmt::format("step {} of the equilibration: {}", n + 1, failure.what()));
      }
      ++step_;  // each step has its own noise
    }
    step_ = base_step_;
    for (std::size_t e = 0; auto* ensemble : dissipation->ensembles()) {
      come_to_rest(*ensemble);
      set_moving(*ensemble, drifts[e++]);
    }
  }
  for (auto* scheme : schemes_) scheme->box().hold_walls(false);
  work_ = 0;
  take_particles();
}

void Simulation::run(std::uint64_t steps) {
  run_together([&] { run(steps, 1); });
}

void Simulation::rewind(std::uint64_t steps) {
  run_together([&] { run(steps, -1); });
}

void Simulation::refuse_backwards() const {
  if (!changes_.empty())
    throw Error("a run can't go backwards past steps between which an adaptation has changed particles");
  if (!dissipations_.empty()) throw Error("a run with friction and noise can't go backwards");
  if (!barostats_.empty()) throw Error("a run whose box is stretched can't go backwards");
  if (!events_.empty()) throw Error("a run with events can't go backwards");
}

/// Everything before the first step.
void Simulation::begin() {
  if (begun_) return;
  if (minimisation_) minimise(*this, *std::exchange(minimisation_, std::nullopt));
  equilibrate_now();  // also for no steps: a resumed run continues from the same state
  establish_flow();
  begun_ = true;
  if (observation_due()) {
    if (checksum(false) != checked_rows_) influences_.outdated();
    calculate(time());
  }
  observe_now();
}

void Simulation::run(std::uint64_t steps, int direction) {
  in_second_kick_ = false;
  struct Running {
    explicit Running(Simulation& of) : simulation(of) {}
    ~Running() {
      simulation.running_ = false;
      simulation.rows_before_change_.reset();
      simulation.clear_pause();
      simulation.drop_forgotten();
    }
    Simulation& simulation;
  } const running_now(*this);
  check();
  for (auto const* ensemble : ensembles_) check_masses(*ensemble);
  running_ = true;
  if (direction < 0) refuse_backwards();
  RunVotes votes(steps);
  votes.begin(
      [&] {
        return (checksum() + std::bit_cast<std::uint64_t>(direction * step_size_)) *
                   (2 * static_cast<std::uint64_t>(step_) + 1) +
               seed_;
      },
      stopped());
  begin();
  std::optional<Dependence> now;
  if (influences_.kept() || whole_.steps) now = dependence(!whole_.steps);
  divide();
  struct Together {
    Simulation* simulation;
    ~Together() {
      try {
        simulation->end_division();
      } catch (PhysicsFailure const&) {  // of particles of another rank; the original failure is reported
      }
    }
  } const together{this};
  auto const running = influences_.begin_run(now);
  small_system_ = schemes_.size() == 1 ? schemes_.front()->small_system() : Scheme::SmallSystem{};
  bool const last = any_comes_last(schemes_);
  Division const* const division = is_divided() ? division_.get() : nullptr;
  if (now) now = of_whole_steps(*now, division);
  FusedSteps* const whole = steps > 0 ? whole_steps(direction * step_size_, now) : nullptr;
  for (RunVotes::Done done; votes.go_on(done, stopped(), paused()); ++done.steps) {
    done.looked = take_step(direction, whole, last);
    done.divided = is_divided();
  }
  if (votes.stopped()) stop();
  if (steps == 0) calculate(time());
  complete_last_step(whole, last);
  influences_.end_run([&] { return dependence(true); });
  if (whole) whole_.are_for = of_whole_steps(dependence(false), division);
  votes.end([&] { return checksum(); });
}

/// One step, and everything that follows it. True if observers or others were called in a divided run, which may have
/// taken any time.
bool Simulation::take_step(int direction, FusedSteps* whole, bool last) {
  try {
    double const dt = direction * step_size_;
    if (whole)
      whole->step(time());
    else
      advance(dt, dissipations_);
    if (!barostats_.empty()) stretch_box(dt);
    if (last && stages_ == 0) influences_.outdated();  // nothing has moved, but a stream may have changed
  } catch (PhysicsFailure const& failure) {
    throw PhysicsFailure(fmt::format("step {}: {}", step_ + direction, failure.what()));
  }
  step_ += direction;
  bool const looked = division_ && (observation_due() || change_due());
  if (!changes_.empty()) adapt_now();
  if (!events_.empty()) happen_now();
  if (!observations_.empty()) {
    if (whole && observation_due()) {
      whole->store(time());
      if (observers_read_influences_) refresh_in_run();
    } else if (observation_due()) {
      calculate(time());  // unless they are valid: the next step would begin with them in any case
    }
    observe_now();
  }
  for (auto const& one : progress_)
    if (!one.forgotten) one.observer(*this);
  return looked;
}

/// Brings everything that observers may read up to date, on all ranks.
void Simulation::complete_last_step(FusedSteps* whole, bool last) {
  if (whole) {
    whole->store(time());
    influences_.outdated();
  } else if (influences_.of_others()) {
    calculate(time());
  }
  bool const divided = is_divided();
  if (divided) {
    update_derived_fields();
    gather_particles();
    end_division();
  }
  if (last) calculate(time());
  if (!divided) update_derived_fields();
}

namespace {

/// Adds per-particle numbers of one of several schemes. `known` becomes false if a scheme has none.
void add_up(std::vector<std::vector<double>> const& part, Scheme const& scheme,
            std::vector<AnyEnsemble*> const& ensembles, std::vector<std::vector<double>>& total, bool& known) {
  auto const& own = scheme.ensembles();
  known = known && part.size() == own.size();
  if (!known) return total.clear();
  total.resize(ensembles.size());
  for (std::size_t k = 0; k < own.size(); ++k) {
    auto& sums =
        total[static_cast<std::size_t>(std::find(ensembles.begin(), ensembles.end(), own[k]) - ensembles.begin())];
    sums.resize(part[k].size());
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += part[k][i];
  }
}

}  // namespace

EnergyAndVirial Simulation::measure() const {
  auto total = EnergyAndVirial::known();
  total.reciprocal = true;
  bool energies = true, virials = true;  // per particle, from every scheme
  auto const all = supervised_by(schemes_);
  for (auto* scheme : schemes_) {
    EnergyAndVirial part = scheme->measure(time());
    total.potential += part.potential;
    total.external += part.external;
    total.internal += part.internal;
    total.driven = total.driven || part.driven;
    total.reciprocal = total.reciprocal && part.reciprocal;
    for (int a = 0; a < 3; ++a)
      for (int b = 0; b < 3; ++b) total.virial[a][b] += part.virial[a][b];
    if (!part.unknown.empty()) total.unknown = part.unknown;
    if (!part.no_virial.empty()) total.no_virial = part.no_virial;
    if (schemes_.size() == 1) {
      total.per_particle = std::move(part.per_particle);
      total.virial_per_particle = std::move(part.virial_per_particle);
    } else {
      add_up(part.per_particle, *scheme, all, total.per_particle, energies);
      add_up(part.virial_per_particle, *scheme, all, total.virial_per_particle, virials);
    }
  }
  for (auto const& part : parts_)  // particles at rest absorb momentum
    total.reciprocal =
        total.reciprocal && part.integrator->method() != Method::deactivate && part.integrator->same_for_all();
  total.work = work_;
  bool const sheared = schemes_.front()->box().sheared();
  total.driven = total.driven || sheared;  // by moving images
  for (auto* dissipation : dissipations_) {
    total.internal += dissipation->internal_energy();
    total.heat += dissipation->heat();
    if (!sheared) continue;  // at rest, friction transfers no momentum on average
    auto const friction = dissipation->virial();
    for (std::size_t a = 0; a < 3; ++a)
      for (std::size_t b = 0; b < 3; ++b) total.virial[a][b] += friction[a][b];
  }
  return total;
}

std::vector<double> Simulation::state() const {
  std::vector<double> state{
      static_cast<double>(base_step_), base_time_, grid_.position, grid_.velocity, grid_.force, work_};
  auto const add = [&](std::vector<double> const& part) {
    state.push_back(static_cast<double>(part.size()));
    state.insert(state.end(), part.begin(), part.end());
  };
  if (!barostats_.empty()) {
    auto const edges = schemes_.front()->box().edges();
    state.insert(state.end(), edges.begin(), edges.end());
    for (auto const& barostat : barostats_) add(barostat->state());
  }
  for (auto const* scheme : schemes_) add(scheme->state());
  for (auto const* dissipation : dissipations_) add(dissipation->state());
  if (influences_.inside_step()) {
    bool const fresh = influences_.belong_to_state(dependence(true));
    state.push_back(fresh ? 1 : 0);
    for (auto const& part : parts_) {
      auto const influences = part.ensemble->influences();
      if (fresh) state.insert(state.end(), influences.begin(), influences.end());
    }
  }
  for (auto const& change : changes_) add(change.adaptation->state());
  if (!gauss_radau_.parts().empty()) add(gauss_radau_.state());
  return state;
}

namespace {

/// Sets these edges along periodic axes; walls are at their position at this time.
void stretch_to(std::span<double const> edges, Scheme& scheme) {
  Box& box = scheme.box();
  auto now = box.edges();
  for (int a = 0; a < box.dimension(); ++a)
    if (box.periodic(a))
      for (int const end : {a, 3 + a}) now[end] = edges[end];
  box.edges(now);
  scheme.box_changed();
}

}  // namespace

void Simulation::restore(std::int64_t step, double step_size, std::uint64_t seed, std::span<double const> state) {
  auto const misfit = [] { return Error("the checkpoint does not fit this simulation: its state has another length"); };
  if (state.size() < 6) throw misfit();
  grid_ = {state[2], state[3], state[4]};
  step_size_ = step_size;
  step_ = step;
  base_step_ = static_cast<std::int64_t>(state[0]);
  base_time_ = state[1];
  work_ = state[5];
  seed_ = seed;
  minimisation_.reset();
  equilibrations_.clear();
  begun_ = true;  // the start has been done
  std::size_t at = 6;
  auto const next = [&] {
    if (at >= state.size()) throw misfit();
    auto const count = static_cast<std::size_t>(state[at++]);
    if (at + count > state.size()) throw misfit();
    at += count;
    return state.subspan(at - count, count);
  };
  if (!barostats_.empty()) {  // before particles are wrapped into the box
    if (state.size() < at + 6) throw misfit();
    for (auto* scheme : schemes_) stretch_to(state.subspan(at, 6), *scheme);
    at += 6;
    for (auto const& barostat : barostats_) barostat->restore(next());
  }
  for (auto const& event : events_)
    if (event.lasting && event.step <= step_) event.happen();
  check();
  move_walls(time());
  for (auto* scheme : schemes_) scheme->restore(next());
  for (auto* dissipation : dissipations_) dissipation->restore(next());
  if (influences_.inside_step() && at >= state.size()) throw misfit();
  bool const with_influences = influences_.inside_step() && state[at++] != 0;
  if (with_influences)
    for (auto const& part : parts_) {
      std::size_t const count = part.ensemble->influences().size();
      if (at + count > state.size()) throw misfit();
      std::copy_n(state.begin() + static_cast<std::ptrdiff_t>(at), count, part.ensemble->influences().begin());
      at += count;
    }
  if (with_influences)
    for (auto* scheme : schemes_)
      if (auto* counts = dynamic_cast<RestoredInfluences*>(scheme)) counts->influences_restored();
  for (auto const& change : changes_) change.adaptation->restore(next());
  if (!gauss_radau_.parts().empty()) gauss_radau_.restore(next());
  if (at != state.size())
    throw Error(
        "the checkpoint does not fit this simulation: it has an adaptation that this simulation lacks; resume with the "
        "program that has it");
  take_lengths();
  update_derived_fields();
  whole_ = {};
  influences_.restored(with_influences, dependence(true));
}

}  // namespace boltzmann
