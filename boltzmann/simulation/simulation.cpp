// The loop, and the checks that turn a failing simulation into one line.
#include <boltzmann/simulation/overlap.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double max_courant = 4;                   // the longest step that makes sense
constexpr std::uint32_t first_equilibration = 128;  // its number as a dissipation

/// Takes off the velocity of the centre of mass, and returns it.
std::array<double, 3> come_to_rest(AnyEnsemble& ensemble) {
  std::array<double, 3> drift{};
  int const mass = ensemble.field("mass").offset, velocity = ensemble.field("velocity").offset;
  for (int a = 0; a < ensemble.dimension(); ++a) {
    double total = 0, momentum = 0;
    for (std::size_t i = 0; i < ensemble.size(); ++i) {
      double const* row = ensemble.row(i);
      total += row[mass];
      momentum += row[mass] * row[velocity + a];
    }
    if (total > 0) drift[a] = momentum / total;
    for (std::size_t i = 0; i < ensemble.size(); ++i) ensemble.row(i)[velocity + a] -= drift[a];
  }
  return drift;
}

void set_moving(AnyEnsemble& ensemble, std::array<double, 3> const& drift) {
  int const velocity = ensemble.field("velocity").offset;
  for (std::size_t i = 0; i < ensemble.size(); ++i)
    for (int a = 0; a < ensemble.dimension(); ++a) ensemble.row(i)[velocity + a] += drift[a];
}

}  // namespace

Simulation::Simulation(Scheme& scheme, double step_size) : step_size_(0) {
  this->step_size(step_size);
  add(scheme);
}

void Simulation::add(Scheme& scheme) {
  schemes_.push_back(&scheme);
  checked_ = false;
}

void Simulation::add(Dissipation& dissipation) {
  dissipation.number(static_cast<std::uint32_t>(dissipations_.size()));
  dissipations_.push_back(&dissipation);
  checked_ = false;
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

void Simulation::observe(std::uint64_t every, std::function<void(Simulation const&)> observer) {
  if (every == 0) throw Error("an observer looks every 1 or more steps, not every 0");
  observe_when([every](std::int64_t step) { return step % static_cast<std::int64_t>(every) == 0; },
               std::move(observer));
}

void Simulation::observe_when(std::function<bool(std::int64_t)> due, std::function<void(Simulation const&)> observer) {
  observations_.push_back({std::move(due), std::move(observer)});
}

void Simulation::observe_progress(std::function<void(Simulation const&)> observer) {
  progress_.push_back(std::move(observer));
}

void Simulation::adapt(std::uint64_t every, std::unique_ptr<Adaptation> adaptation) {
  if (every == 0) throw Error("an adaptation changes particles every 1 or more steps, not every 0");
  changes_.push_back({static_cast<std::int64_t>(every), std::move(adaptation)});
  checked_ = false;
}

void Simulation::adapt(std::uint64_t every, std::function<void()> change) {
  struct Call final : Adaptation {
    explicit Call(std::function<void()> what) : function(std::move(what)) {}
    void change() override { function(); }
    std::function<void()> function;
  };
  adapt(every, std::unique_ptr<Adaptation>(std::make_unique<Call>(std::move(change))));
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

void Simulation::check() {
  if (checked_) return;
  small_system_ = {};
  move_walls(time());
  accept_particles();
  ensembles_ = supervised_by(schemes_);
  stages_ = 0;
  bool reversible = false, inside_step = false;
  for (auto* ensemble : ensembles_) {
    Part const& part = ready_part(*ensemble);
    Method const method = part.integrator->method();
    for (auto const* scheme : schemes_)
      inside_step = inside_step || (method == Method::leap_frog && scheme->velocity_dependent(*ensemble));
    stages_ = std::max(stages_, part.stages);
    reversible = reversible || method == Method::reversible_leap_frog;
  }
  std::erase_if(parts_, [&](Part const& p) {
    return std::find(ensembles_.begin(), ensembles_.end(), p.ensemble) == ensembles_.end();
  });
  check_methods();
  take_lengths();
  check_dissipations();
  if (substeps_) check_substeps();
  if (reversible && !changes_.empty())
    throw Error("the reversible leap-frog can't take back what an adaptation does between steps; use leap-frog");
  if (reversible) make_reversible(grid_.position > 0 ? grid_ : choose_grid());
  for (auto* scheme : schemes_) {
    double const longest = scheme->longest_step();
    if (std::abs(step_size_) > max_courant * longest && !(substeps_ && substeps_->courant))
      throw Error(
          fmt::format("the step {} is far above the longest that makes sense, {} (sound and diffusion "
                      "must not outrun it)",
                      told_time(std::abs(step_size_)), told_time(longest)));
  }
  influences_.inside_step(inside_step);
  influences_.outdated();
  calculate(time());
  check_influences();
  note_start();
  checked_ = true;
}

/// The integrator of an ensemble, with its stages and with what it takes over from the schemes.
Simulation::Part const& Simulation::ready_part(AnyEnsemble& ensemble) {
  Part* part = part_of(ensemble);
  if (!part) part = &parts_.emplace_back(Part{&ensemble, usual_integrator(ensemble), 0, 0, {}, nullptr});
  part->integrator->threads(schemes_.front()->threads());
  bool const takes = part->integrator->takes_rotations();
  std::vector<Rotation> rotations;
  for (auto* scheme : schemes_)
    for (auto const& rotation : scheme->rotations(ensemble, takes)) rotations.push_back(rotation);
  if (takes) part->integrator->rotate(std::move(rotations));
  part->stages = part->integrator->stages();
  part->time_after.clear();
  for (int k = 0; k < part->stages; ++k) part->time_after.push_back(part->integrator->time_after(k));
  part->home = *std::find_if(schemes_.begin(), schemes_.end(),
                             [&](Scheme const* scheme) { return scheme->supervises(ensemble); });
  return *part;
}

/// Those that advance all ensembles together don't mix with others.
void Simulation::check_methods() {
  std::vector<GaussRadau::Part> together;
  Part const* other = nullptr;
  for (auto* ensemble : ensembles_) {
    Part const& part = *part_of(*ensemble);
    Method const method = part.integrator->method();
    for (auto const* scheme : schemes_)
      if (method == Method::symplectic_4 && scheme->velocity_dependent(*ensemble))
        throw Error("influences on ensemble '" + ensemble->name() +
                    "' depend on velocities, which symplectic-4 can't follow; use leap-frog, rk4 or gauss-radau");
    if (method == Method::gauss_radau && !part.integrator->same_for_all())
      throw Error("some particles of ensemble '" + ensemble->name() +
                  "' are frozen, which gauss-radau does not know; put them into an ensemble with deactivate");
    if (auto* equations = part.integrator->equations_of_motion())
      together.push_back({equations});
    else if (method != Method::deactivate)
      other = &part;
  }
  if (!together.empty() && other)
    throw Error("ensemble '" + together.front().equations->ensemble().name() +
                "' moves by gauss-radau, which advances all ensembles together; '" + other->ensemble->name() +
                "' moves by " + to_string(other->integrator->method()) + ": use gauss-radau for all (or deactivate)");
  gauss_radau_.shift_origin(
      together.size() == ensembles_.size() &&
      std::all_of(together.begin(), together.end(), [](auto const& part) { return part.equations->second_order(); }) &&
      std::all_of(schemes_.begin(), schemes_.end(), [](Scheme* scheme) { return scheme->translation_invariant(); }));
  gauss_radau_.parts(std::move(together));
}

void Simulation::check_substeps() const {
  for (auto* ensemble : ensembles_) {
    Method const method = this->method(*ensemble);
    if (method != Method::leap_frog && method != Method::symplectic_4 && method != Method::deactivate)
      throw Error("steps are divided into substeps where leap-frog or symplectic-4 advances; ensemble '" +
                  ensemble->name() + "' moves by " + to_string(method));
  }
  if (!dissipations_.empty() || !equilibrations_.empty())
    throw Error(
        "steps with friction and noise can't be divided into substeps: their random numbers are of whole steps");
  if (substeps_->courant && std::none_of(schemes_.begin(), schemes_.end(),
                                         [](Scheme* scheme) { return std::isfinite(scheme->longest_step()); }))
    throw Error("substeps: no scheme of the simulation has a Courant step; give distance or energy");
}

void Simulation::check_influences() const {
  for (auto* ensemble : ensembles_)
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      for (std::size_t c = 0; c < ensemble->influence_size(); ++c) {
        if (std::isfinite(ensemble->influence(i)[c])) continue;
        std::string why;
        for (auto const* scheme : schemes_)
          if (why.empty()) why = scheme->explain(*ensemble, i);
        throw Error(why.empty() ? fmt::format("the influence on particle {} of '{}' is not finite at the start", i,
                                              ensemble->name())
                                : why);
      }
}

void Simulation::check_dissipations() {
  std::vector<Dissipation*> all = dissipations_;
  for (auto const& equilibration : equilibrations_) all.push_back(equilibration.dissipation.get());
  for (auto* dissipation : all) {
    for (auto* ensemble : dissipation->ensembles()) {
      auto const* part = part_of(*ensemble);
      if (!part)
        throw Error("friction and noise act on ensemble '" + ensemble->name() +
                    "', which no scheme of the simulation supervises");
      bool const all = part->integrator->same_for_all();
      if (part->integrator->method() != Method::leap_frog || !all)
        throw Error("friction and noise act on ensemble '" + ensemble->name() +
                    "', which needs leap-frog for all its particles then, not " +
                    (all ? to_string(part->integrator->method()) : "some that are frozen"));
    }
    dissipation->check();
  }
}

FixedPoint Simulation::choose_grid() const {
  double extent = 0, mass = std::numeric_limits<double>::infinity();
  bool open = false;  // particles may fly off: leave them room for 512 boxes, and 4 otherwise
  for (auto const* scheme : schemes_)
    for (int a = 0; a < scheme->box().dimension(); ++a) {
      Box const& box = scheme->box();
      extent = std::max({extent, std::abs(box.low(a)), std::abs(box.high(a)), box.length(a)});
      bool const walled = box.walled(a, Box::End::low) && box.walled(a, Box::End::high);
      open = open || !(walled || box.periodic(a));
    }
  for (auto const& part : parts_)
    if (Field const* field = part.ensemble->find_field("mass"))
      for (std::size_t i = 0; i < part.ensemble->size(); ++i)
        mass = std::min(mass, part.ensemble->row(i)[field->offset]);
  if (!std::isfinite(mass) || !(mass > 0)) mass = 1;
  auto const power_of_two = [](double x) { return std::exp2(std::floor(std::log2(x))); };
  FixedPoint grid;
  grid.position = power_of_two(extent * (open ? 0x1p-42 : 0x1p-49));
  grid.velocity = power_of_two(grid.position / std::abs(step_size_) * 0x1p-4);
  grid.force = power_of_two(grid.velocity * mass / std::abs(step_size_) * 0x1p-3);
  return grid;
}

void Simulation::make_reversible(FixedPoint const& grid) {
  grid_ = grid;
  for (auto* scheme : schemes_) {
    scheme->make_reversible(grid.force);
    scheme->box().on_grid(grid.position);
  }
  for (auto& part : parts_) part.integrator->prepare(grid);
}

void Simulation::move_walls(double time) {
  for (auto* scheme : schemes_)
    if (scheme->box().walls_move()) scheme->box().move_walls(time);
}

/// The influences on particles as they are, unless they stand there.
void Simulation::calculate(double time) {
  if (influences_.hold()) return;
  move_walls(time);
  if (small_system_.call) {
    small_system_.call(small_system_.data);
  } else if (schemes_.size() == 1) {
    schemes_.front()->calculate(time);
  } else {
    for (auto* ensemble : ensembles_) ensemble->clear_influence();
    for (auto* scheme : schemes_) scheme->add_influences(time);
  }
  influences_.calculated();
}

void Simulation::advance(double dt, std::vector<Dissipation*> const& dissipations) {
  if (!gauss_radau_.parts().empty())
    advance_by_gauss_radau(dt);
  else if (substeps_)
    advance_in_substeps(dt);
  else
    advance(time(), dt);
  StepContext const context{dt, static_cast<std::uint64_t>(step_), seed_};
  if (!dissipations.empty()) calculate(time() + dt);
  for (auto* dissipation : dissipations) dissipation->advance(context);
  for (auto const& part : parts_) check_moves(part);
  for (auto const* scheme : schemes_)
    if (std::abs(dt) > max_courant * scheme->sound_step() && !(substeps_ && substeps_->courant))
      throw PhysicsFailure(
          fmt::format("sound has become so fast that the step {} is far above the longest that makes "
                      "sense, {}",
                      told_time(std::abs(dt)), told_time(scheme->sound_step())));
}

/// By the stages of the integrators.
void Simulation::advance(double start, double dt) {
  StepContext const context{dt, static_cast<std::uint64_t>(step_), seed_};
  double passed = 0;
  for (int stage = 0; stage < stages_; ++stage) {
    calculate(start + passed * dt);
    for (auto& part : parts_) {
      if (stage >= part.stages) continue;
      Motion const motion = part.integrator->advance(stage, context);
      if (motion == Motion::none) continue;
      influences_.outdated();
      passed = part.time_after[stage];
      if (motion != Motion::final) continue;
      move_walls(start + passed * dt);
      keep_in_box(part);
    }
  }
}

/// Puts back what has left the box during a step.
void Simulation::keep_in_box(Part& part) {
  try {
    work_ += part.home->box().apply(*part.ensemble, part.home->threads());
  } catch (PhysicsFailure const& failure) {
    throw PhysicsFailure(failure.what() + advice());
  }
}

void Simulation::advance_by_gauss_radau(double dt) {
  double const start = time();
  double passed = 0;
  std::function<void(double)> const influences = [this, &start, &passed](double since) {
    influences_.outdated();
    calculate(start + passed + since);
  };
  for (std::size_t k = 0; auto const& part : parts_)
    if (part.integrator->equations_of_motion()) gauss_radau_.parts()[k++].max_move = std::sqrt(part.longest_move2);
  while (passed != dt) {
    calculate(start + passed);
    double const rest = dt - passed, size = gauss_radau_.step(rest, schemes_.front()->threads(), influences);
    passed = size == rest ? dt : passed + size;
    influences_.outdated();
    move_walls(start + passed);
    for (auto& part : parts_) keep_in_box(part);
  }
}

/// Block steps (J. Makino, P. Hut, M. Kaplan and H. Saygin, New Astron. 12, 124 (2006)): a substep is dt / 2^n and
/// begins at a multiple of itself. It is the longest that is allowed both where it begins and where it ends.
void Simulation::advance_in_substeps(double dt) {
  constexpr std::uint64_t whole = std::uint64_t{1} << 40;
  double const start = time(), unit = dt / static_cast<double>(whole);
  auto const moment = [&](std::uint64_t at) {
    return at == whole ? start + dt : start + static_cast<double>(at) * unit;
  };
  auto const longer = [&](std::uint64_t size, double allowed) {
    return std::abs(static_cast<double>(size) * unit) > allowed;
  };
  calculate(start);
  double allowed = longest_substep(*substeps_, ensembles_, schemes_);
  for (std::uint64_t at = 0; at < whole;) {
    std::uint64_t size = at == 0 ? whole : at & (~at + 1);
    while (size > 0 && longer(size, allowed)) size /= 2;
    double const work = work_;
    keep_rows();
    for (bool fits = false; !fits;) {
      if (size == 0)
        throw PhysicsFailure(
            fmt::format("substeps would have to be shorter than a 10^12th of the step, {}", told_time(allowed)));
      advance(moment(at), static_cast<double>(size) * unit);
      calculate(moment(at + size));
      double const at_end = longest_substep(*substeps_, ensembles_, schemes_);
      fits = !longer(size, at_end);
      if (fits) {
        allowed = at_end;
        at += size;
        ++substep_counts_.done;
        for (auto const& part : parts_) check_moves(part);
      } else {
        restore_rows();
        move_walls(moment(at));
        work_ = work;
        size /= 2;
        ++substep_counts_.repeated;
      }
    }
  }
}

/// Rows and influences, for a substep that may be too long.
void Simulation::keep_rows() {
  before_substep_.clear();
  for (auto const* ensemble : ensembles_) {
    double const *row = ensemble->row(0), *influence = ensemble->influence(0);
    before_substep_.insert(before_substep_.end(), row, row + ensemble->size() * ensemble->stride());
    before_substep_.insert(before_substep_.end(), influence, influence + ensemble->size() * ensemble->influence_size());
  }
}

void Simulation::restore_rows() {
  double const* from = before_substep_.data();
  for (auto* ensemble : ensembles_) {
    std::size_t const rows = ensemble->size() * ensemble->stride(),
                      influences = ensemble->size() * ensemble->influence_size();
    std::copy_n(from, rows, ensemble->row(0));
    std::copy_n(from + rows, influences, ensemble->influence(0));
    from += rows + influences;
  }
  influences_.calculated();
}

std::unique_ptr<FusedSteps> Simulation::fused_steps(double dt) {
  if (schemes_.size() != 1 || !changes_.empty() || !dissipations_.empty() || substeps_) return nullptr;
  std::vector<Mover> movers;
  for (auto const& part : parts_) {
    Method const method = part.integrator->method();
    if ((method != Method::leap_frog && method != Method::deactivate) || !part.integrator->same_for_all())
      return nullptr;
    movers.push_back({part.ensemble, method == Method::leap_frog});
  }
  return schemes_.front()->fused_steps(movers, dt);
}

void Simulation::check_moves(Part const& part) const {
  LargestMove const& move = part.integrator->largest_move();
  if (move.not_finite == LargestMove::nobody && move.square <= part.longest_move2) return;
  auto const& name = part.ensemble->name();
  if (move.not_finite != LargestMove::nobody) {
    std::string why;
    for (auto const* scheme : schemes_)
      if (why.empty()) why = scheme->explain(*part.ensemble, move.not_finite);
    throw PhysicsFailure(
        fmt::format("particle {} of '{}' has a position or velocity that is not finite (or beyond the range of the "
                    "fixed-point grid){}{}",
                    move.not_finite, name, why.empty() ? "" : ": ", why));
  }
  double const moved = std::sqrt(move.square), allowed = std::sqrt(part.longest_move2);
  Dimension const unit = part.ensemble->fields().front().dimension;  // of what moves: a length, an angle
  auto const length = [&](double number) { return base().text(number, unit); };
  throw PhysicsFailure(fmt::format("particle {} of '{}' moved {} in one step, further than the length {} of its law{}",
                                   move.particle, name, length(moved), length(allowed), advice()));
}

/// What a failure may be told of, from the state that check() has seen.
void Simulation::note_start() {
  start_ = step_;
  collision_step_ = std::numeric_limits<double>::infinity();
  for (auto const* scheme : schemes_) collision_step_ = std::min(collision_step_, scheme->collision_step());
  overlap_ = overlap(schemes_, ensembles_, step_size_);
}

/// The cure of a step that has brought a particle too far, as far as it is known.
std::string Simulation::advice() const {
  if (step_ == start_ && !overlap_.empty()) return "; " + overlap_;
  auto const told = [&](double number) { return base().text(number, dimensions::time, 3); };
  double const safe = 0.1 * collision_step_;  // forces between atoms rise over a tenth of their law's length
  if (std::abs(step_size_) > safe)
    return fmt::format(
        "; at the speeds of the start a step above {} does not follow collisions, and forces need a shorter one; a "
        "tenth is safe to begin with: take a step below {}",
        told(collision_step_), told(safe));
  if (std::isfinite(safe))
    return fmt::format("; the speeds of the start allow the step ({}), forces do not: begin with half", told(safe));
  return "; take a shorter step";
}

UnitSystem const& Simulation::base() const { return schemes_.front()->spoken_units(); }

std::string Simulation::told_time(double number) const { return base().text(number, dimensions::time); }

void Simulation::speak_in(UnitSystem const& base) {
  for (auto* scheme : schemes_) scheme->speak_in(base);
}

void Simulation::update_derived_fields() const {
  for (auto* scheme : schemes_) scheme->complete(time());
  for (auto* dissipation : dissipations_) dissipation->update_derived_fields();
}

void Simulation::take_lengths() {
  for (auto& part : parts_) {
    double scale = std::numeric_limits<double>::infinity();
    for (auto const* scheme : schemes_) scale = std::min(scale, scheme->length_scale(*part.ensemble));
    part.longest_move2 = scale * scale;
  }
}

/// Puts all into the box; those that can't be there are refused.
void Simulation::accept_particles() {
  for (auto* scheme : schemes_)
    for (auto* ensemble : scheme->ensembles()) {
      scheme->box().check(*ensemble);
      scheme->box().wrap(*ensemble);
    }
}

/// Particles have been changed between steps.
void Simulation::take_particles() {
  accept_particles();
  influences_.particles_changed();
  small_system_ = schemes_.size() == 1 ? schemes_.front()->small_system() : Scheme::SmallSystem{};
  take_lengths();
}

void Simulation::adapt_now() {
  auto const sizes = [&] {
    std::vector<std::size_t> all;
    for (auto const& part : parts_) all.push_back(part.ensemble->size());
    return all;
  };
  bool completed = false;
  for (auto const& change : changes_) {
    if (step_ % change.every != 0) continue;
    if (!completed) update_derived_fields();
    auto const before = rows_checksum(ensembles_, true);
    auto const sizes_before = sizes();
    try {
      change.adaptation->change();
      auto const sizes_now = sizes();
      for (std::size_t k = 0; k < parts_.size(); ++k)
        if (sizes_now[k] != sizes_before[k] && !parts_[k].integrator->same_for_all())
          throw Error(
              fmt::format("ensemble '{}' had {} particles and has {} now, but some of them are frozen, by number",
                          parts_[k].ensemble->name(), sizes_before[k], sizes_now[k]));
      completed = sizes_now == sizes_before && rows_checksum(ensembles_, true) == before;
      if (!completed) take_particles();
    } catch (Error const& error) {
      throw Error(fmt::format("step {}: {}", step_, error.what()));
    } catch (PhysicsFailure const& failure) {
      throw PhysicsFailure(fmt::format("step {}: {}", step_, failure.what()));
    }
  }
}

bool Simulation::observation_due() const {
  return std::any_of(observations_.begin(), observations_.end(),
                     [&](Observation const& observation) { return observation.due(step_); });
}

void Simulation::observe_now() const {
  if (!observation_due()) return;
  update_derived_fields();
  for (auto const& observation : observations_)
    if (observation.due(step_)) observation.observer(*this);
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
    // A stop waits until the end: nothing could go on with half an equilibration.
    for (std::uint64_t n = 0; n < steps; ++n) {
      try {
        advance(step_size_, {dissipation.get()});
      } catch (PhysicsFailure const& failure) {
        throw PhysicsFailure(fmt::format("step {} of the equilibration: {}", n + 1, failure.what()));
      }
      ++step_;  // noise of its own for each
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

void Simulation::run(std::uint64_t steps) { run(steps, 1); }
void Simulation::rewind(std::uint64_t steps) { run(steps, -1); }

void Simulation::run(std::uint64_t steps, int direction) {
  pause_ = false;
  check();
  if (direction < 0 && !changes_.empty())
    throw Error("a run can't go backwards past steps between which an adaptation has changed particles");
  if (direction < 0 && !dissipations_.empty()) throw Error("a run with friction and noise can't go backwards");
  if (!begun_) {
    equilibrate_now();  // also for no steps: what is stored of them is where another run goes on
    begun_ = true;
    observe_now();
  }
  auto const running = influences_.begin_run(ensembles_);
  small_system_ = schemes_.size() == 1 ? schemes_.front()->small_system() : Scheme::SmallSystem{};
  double const dt = direction * step_size_;
  std::unique_ptr<FusedSteps> const whole = steps > 0 ? fused_steps(dt) : nullptr;
  for (std::uint64_t n = 0; n < steps && !stopped() && !pause_; ++n) {
    try {
      if (whole)
        whole->step(time());
      else
        advance(dt, dissipations_);
    } catch (PhysicsFailure const& failure) {
      throw PhysicsFailure(fmt::format("step {}: {}", step_ + direction, failure.what()));
    }
    step_ += direction;
    if (!changes_.empty()) adapt_now();
    if (!observations_.empty()) {
      if (whole && observation_due()) whole->store();
      observe_now();
    }
    for (auto const& observer : progress_) observer(*this);
  }
  if (whole) whole->store();
  update_derived_fields();
  influences_.end_run(ensembles_);
}

namespace {

/// Adds numbers of each particle that one of several schemes knows. `known` becomes false where a scheme knows none.
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
  bool energies = true, virials = true;  // of each particle, from every scheme
  auto const all = supervised_by(schemes_);
  for (auto* scheme : schemes_) {
    EnergyAndVirial part = scheme->measure(time());
    total.potential += part.potential;
    total.external += part.external;
    total.internal += part.internal;
    total.driven = total.driven || part.driven;
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
  total.work = work_;
  for (auto const* dissipation : dissipations_) {
    total.internal += dissipation->internal_energy();
    total.heat += dissipation->heat();
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
  for (auto const* scheme : schemes_) add(scheme->state());
  for (auto const* dissipation : dissipations_) add(dissipation->state());
  if (influences_.inside_step()) {
    bool const fresh = influences_.belong_to_state(ensembles_);
    state.push_back(fresh ? 1 : 0);
    for (auto const& part : parts_) {
      auto const* influence = part.ensemble->influence(0);
      if (fresh)
        state.insert(state.end(), influence, influence + part.ensemble->size() * part.ensemble->influence_size());
    }
  }
  for (auto const& change : changes_) add(change.adaptation->state());
  if (!gauss_radau_.parts().empty()) add(gauss_radau_.state());
  return state;
}

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
  check();
  std::size_t at = 6;
  auto const next = [&] {
    if (at >= state.size()) throw misfit();
    auto const count = static_cast<std::size_t>(state[at++]);
    if (at + count > state.size()) throw misfit();
    at += count;
    return state.subspan(at - count, count);
  };
  for (auto* scheme : schemes_) scheme->restore(next());
  for (auto* dissipation : dissipations_) dissipation->restore(next());
  if (influences_.inside_step() && at >= state.size()) throw misfit();
  bool const with_influences = influences_.inside_step() && state[at++] != 0;
  if (with_influences)
    for (auto const& part : parts_) {
      std::size_t const count = part.ensemble->size() * part.ensemble->influence_size();
      if (at + count > state.size()) throw misfit();
      std::copy_n(state.begin() + static_cast<std::ptrdiff_t>(at), count, part.ensemble->influence(0));
      at += count;
    }
  for (auto const& change : changes_) change.adaptation->restore(next());
  if (!gauss_radau_.parts().empty()) gauss_radau_.restore(next());
  take_lengths();
  update_derived_fields();
  influences_.restored(with_influences, ensembles_);
  begun_ = true;
}

}  // namespace boltzmann
