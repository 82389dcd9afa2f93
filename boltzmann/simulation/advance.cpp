// One step by any method, and the checks that turn a failing step into one line.
#include <boltzmann/integrators/driven_fields.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <boltzmann/simulation/start_forces.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace boltzmann {
namespace {

/// The field with a rate of its own that is not finite; null: there is none, or another number is not finite.
Field const* driven_field_not_finite(AnyEnsemble const& ensemble, std::size_t i) {
  Field const* driven = nullptr;
  for (auto const& field : ensemble.fields())
    for (int c = 0; c < field.components; ++c) {
      if (std::isfinite(ensemble.row(i)[field.offset + c])) continue;
      if (ensemble.number_driven(field) < 0) return nullptr;
      driven = &field;
    }
  return driven;
}

/// Influences, and rates of fields.
Division::Carried influences_on(AnyEnsemble& ensemble) {
  Division::Carried all;
  if (ensemble.size() == 0) return all;
  if (ensemble.influence_size() > 0) all.emplace_back(ensemble.influence(0), ensemble.influence_size());
  std::size_t const rates = ensemble.influences().size() - ensemble.size() * ensemble.influence_size();
  for (std::size_t k = 0; k * ensemble.size() * ensemble.rate_stride() < rates; ++k)
    all.emplace_back(ensemble.rate(k), ensemble.rate_stride());
  return all;
}

/// The end of a step is computed exactly like the beginning of the next. Influences that are calculated there are valid
/// for the next step, and a resumed run recalculates them at the time of its first step.
double end_of_step(double base_time, std::int64_t steps_before, double step_size, double dt) {
  return base_time + static_cast<double>(steps_before + ((dt > 0) == (step_size > 0) ? 1 : -1)) * step_size;
}

}  // namespace

void Simulation::move_walls(double time) {
  for (auto* scheme : schemes_)
    if (scheme->box().moves()) scheme->box().move_walls(time);
}

/// Calculates the influences on particles at this step, unless they are up to date.
void Simulation::calculate(double time, std::int64_t step) {
  if (influences_.hold()) return;
  move_walls(time);
  if (small_system_.call) {
    small_system_.call(small_system_.data);
  } else if (schemes_.size() == 1 && !velocity_forces_.takes(*schemes_.front())) {
    schemes_.front()->calculate(time);
  } else {
    add_all_influences(time, step);
  }
  if (velocity_forces_.any()) velocity_forces_.complete(time, in_second_kick_);
  influences_.calculated();
}

/// Calls several schemes in their order. In a divided run particles migrate before.
void Simulation::add_all_influences(double time, std::int64_t step) {
  if (is_divided())
    for (auto* scheme : with_lists_)
      if (step % every(*scheme) == 0) scheme->bring_particles();
  for (auto* ensemble : ensembles_) ensemble->clear_influence();
  for (auto* scheme : schemes_) {
    if (velocity_forces_.takes(*scheme)) continue;
    std::int64_t const steps = every(*scheme);
    if (steps == 1)
      scheme->add_influences(time);
    else if (step % steps == 0)
      add_impulse(*scheme, time, steps);
  }
}

/// Adds the impulse of a slow scheme for this number of steps.
void Simulation::add_impulse(Scheme& scheme, double time, std::int64_t times) {
  of_others_.clear();
  for (auto* ensemble : scheme.ensembles()) {
    auto const influences = ensemble->influences();
    of_others_.insert(of_others_.end(), influences.begin(), influences.end());
    ensemble->clear_influence();
  }
  scheme.add_influences(time);
  double const* others = of_others_.data();
  for (auto* ensemble : scheme.ensembles())
    for (double& influence : ensemble->influences()) influence = *others++ + static_cast<double>(times) * influence;
}

void Simulation::advance(double dt, std::vector<Dissipation*> const& dissipations) {
  if (!gauss_radau_.parts().empty())
    advance_by_gauss_radau(dt);
  else if (substeps_)
    advance_in_substeps(dt);
  else
    advance(time(), dt);
  double const end = end_of_step(base_time_, step_ - base_step_, step_size_, dt);
  StepContext const context{dt, static_cast<std::uint64_t>(step_), seed_, end};
  if (!dissipations.empty()) calculate(end, step_ + (dt > 0 ? 1 : -1));
  for (auto* dissipation : dissipations) {
    dissipation->advance(context);
    if (division_) division_->moved();
  }
  if (!dissipations.empty() && velocity_forces_.any()) velocity_forces_.refresh(end);
  // Observers may trigger a list rebuild. Migrated particles carry their integrator state.
  if (is_divided())
    division_->carry([this](AnyEnsemble const& of) {
      auto const one = std::find(ensembles_.begin(), ensembles_.end(), &of);
      return one == ensembles_.end() ? Division::Carried{} : influences_on(**one);
    });
  check_moves();
  for (auto const* scheme : schemes_)
    if (std::abs(dt) > max_courant * scheme->sound_step() && !(substeps_ && substeps_->courant))
      throw PhysicsFailure(
          fmt::format("the step has become too long: with the sound of now the longest that makes sense is {}, and the "
                      "step is {}{}",
                      told_time(scheme->sound_step()), told_time(std::abs(dt)), advice_on_substeps()));
}

/// By the stages of the integrators.
void Simulation::advance(double start, double dt) {
  StepContext const context{dt, static_cast<std::uint64_t>(step_), seed_};
  double passed = 0;
  // A substep that is not the last one ends earlier.
  double const whole_end = end_of_step(base_time_, step_ - base_step_, step_size_, dt), own_end = start + dt;
  double const rounding = 4 * std::numeric_limits<double>::epsilon() * (std::abs(start) + std::abs(whole_end));
  auto const moment = [&](double part) {
    return part != 1 ? start + part * dt : std::abs(own_end - whole_end) <= rounding ? whole_end : own_end;
  };
  int const threads = schemes_.front()->threads();
  bool const solves = velocity_forces_.any();
  for (int stage = 0; stage < stages_; ++stage) {
    in_second_kick_ = solves && stage == 1;
    calculate(moment(passed), passed == 1 ? step_ + (dt > 0 ? 1 : -1) : step_);
    auto const advance_part = [&](Part& part) {
      if (stage >= part.stages) return;
      bool const drifts = solves && stage == 0 && is_leap_frog(part);
      if (drifts) velocity_forces_.begin_drift(*part.ensemble, start, threads);
      Motion const motion = part.integrator->advance(stage, context);
      if (drifts) velocity_forces_.end_drift(*part.ensemble, start, dt, threads);
      if (division_) division_->moved();
      if (motion == Motion::none) return;
      influences_.outdated();
      passed = part.time_after[stage];
      if (motion != Motion::final) return;
      move_walls(moment(passed));
      keep_in_box(part);
    };
    // Particles of leap-frog have their final velocities before others continue.
    for (auto& part : parts_)
      if (!in_second_kick_ || (is_leap_frog(part) && !velocity_forces_.kicks(*part.ensemble))) advance_part(part);
    if (std::exchange(in_second_kick_, false)) {
      velocity_forces_.second_kick(stage, context, moment(1), is_divided() ? division_.get() : nullptr, threads);
      for (auto& part : parts_)
        if (!is_leap_frog(part)) advance_part(part);
    }
    // From the first stage on integrator state migrates with the particles; before, it may have an old size.
    if (is_divided() && stage == 0)
      division_->carry([this](AnyEnsemble const& ensemble) {
        Division::Carried all;
        for (auto const& [numbers, count] : held_inside_step(ensemble)) all.emplace_back(numbers, count);
        return all;
      });
  }
}

namespace {

/// While it lives, rows have the velocities of the half step instead of predicted ones. The ends of the box change both
/// alike.
class HalfStepVelocities {
 public:
  HalfStepVelocities(AnyEnsemble& ensemble, double* half) : ensemble_(ensemble), half_(half) {
    if (!half_) return;
    Field const& velocity = ensemble.field("velocity");
    offset_ = velocity.offset;
    D_ = static_cast<std::size_t>(velocity.components);
    predicted_.resize(D_ * ensemble.size());
    each([](double& v, double& half, double& predicted) {
      predicted = v;
      v = half;
    });
  }
  ~HalfStepVelocities() {
    if (!half_) return;
    each([](double& v, double& half, double& predicted) {
      if (v != half) predicted += v - half;
      half = v;
      v = predicted;
    });
  }
  HalfStepVelocities(HalfStepVelocities const&) = delete;
  HalfStepVelocities& operator=(HalfStepVelocities const&) = delete;

 private:
  template <class F>
  void each(F const& f) {
    for (std::size_t i = 0; i < ensemble_.size(); ++i)
      for (std::size_t a = 0; a < D_; ++a)
        f(ensemble_.row(i)[offset_ + static_cast<int>(a)], half_[i * D_ + a], predicted_[i * D_ + a]);
  }

  AnyEnsemble& ensemble_;
  double* half_;
  int offset_ = 0;
  std::size_t D_ = 0;
  std::vector<double> predicted_;
};

/// True if velocities may change when a particle leaves.
bool changes_velocities(Box const& box) {
  bool changes = box.sheared() || !box.regions().empty();
  for (int a = 0; a < box.dimension(); ++a)
    changes = changes || (box.boundary(a) != Boundary::periodic && box.boundary(a) != Boundary::open);
  return changes;
}

}  // namespace

/// Brings particles that have left back into the box.
void Simulation::keep_in_box(Part& part) {
  bool const changes = changes_velocities(part.home->box());
  HalfStepVelocities const half_step(*part.ensemble, changes ? part.integrator->half_step_velocities() : nullptr);
  try {
    Division* const division = is_divided() ? division_.get() : nullptr;
    work_ += part.home->box().apply(*part.ensemble, part.home->threads(), division);
  } catch (PhysicsFailure const& failure) {
    throw PhysicsFailure(failure.what() + advice());
  }
}

StretchedSystem Simulation::stretched_system() {
  return {schemes_, ensembles_, momentum_is_kept(), [this] { return measure(); },
          [this](double time) {
            add_all_influences(time, 0);
            if (velocity_forces_.any()) velocity_forces_.complete(time, false);
            if (is_divided()) division_->gather_influences();
          }};
}

/// After a step that is done but not counted yet.
void Simulation::stretch_box(double dt) {
  double const end = end_of_step(base_time_, step_ - base_step_, step_size_, dt);
  StepContext const context{dt, static_cast<std::uint64_t>(step_), seed_, end};
  for (auto const& barostat : barostats_) {
    if ((step_ + 1) % barostat->every() != 0) continue;
    if (is_divided()) gather_particles();  // every rank stretches all particles
    work_ += barostat->act(stretched_system(), context);
    influences_.particles_changed();
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
    if (part.integrator->equations_of_motion()) {
      gauss_radau_.parts()[k++].max_move = std::sqrt(part.longest_move2);
      if (equations_of_fields(*part.integrator)) ++k;
    }
  while (passed != dt) {
    calculate(start + passed);
    double const rest = dt - passed, size = gauss_radau_.step(rest, schemes_.front()->threads(), influences);
    passed = size == rest ? dt : passed + size;
    influences_.outdated();
    move_walls(passed == dt ? end_of_step(base_time_, step_ - base_step_, step_size_, dt) : start + passed);
    for (auto& part : parts_) keep_in_box(part);
  }
}

/// Block steps (J. Makino, P. Hut, M. Kaplan and H. Saygin, New Astron. 12, 124 (2006)): a substep is dt / 2^n and
/// begins at a multiple of itself. It is the longest one allowed both at its beginning and at its end.
void Simulation::advance_in_substeps(double dt) {
  constexpr std::uint64_t whole = std::uint64_t{1} << 40;
  double const start = time(), unit = dt / static_cast<double>(whole);
  double const end = end_of_step(base_time_, step_ - base_step_, step_size_, dt);
  auto const moment = [&](std::uint64_t at) { return at == whole ? end : start + static_cast<double>(at) * unit; };
  auto const longer = [&](std::uint64_t size, double allowed) {
    return std::abs(static_cast<double>(size) * unit) > allowed;
  };
  calculate(start);
  std::vector<Moved> const moving = moved();
  double allowed = longest_substep_now(moving);
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
      double const at_end = longest_substep_now(moving);
      fits = !longer(size, at_end);
      if (fits) {
        allowed = at_end;
        at += size;
        ++substep_counts_.done;
        check_moves();
      } else {
        restore_rows();
        move_walls(moment(at));
        work_ = work;
        size /= 2;
        ++substep_counts_.repeated;
      }
    }
  }
  before_substep_.clear();
}

double Simulation::longest_substep_now(std::vector<Moved> const& moving) {
  double const longest = longest_substep(*substeps_, moving, schemes_);
  return is_divided() ? division_->least(longest) : longest;
}

/// Saves rows and influences, to repeat a substep that was too long.
void Simulation::keep_rows() {
  before_substep_.clear();
  for (auto const* ensemble : ensembles_) {
    double const* row = ensemble->row(0);
    auto const influences = ensemble->influences();
    before_substep_.insert(before_substep_.end(), row, row + ensemble->size() * ensemble->stride());
    before_substep_.insert(before_substep_.end(), influences.begin(), influences.end());
  }
}

void Simulation::restore_rows() {
  double const* from = before_substep_.data();
  for (auto* ensemble : ensembles_) {
    std::size_t const rows = ensemble->size() * ensemble->stride();
    auto const influences = ensemble->influences();
    std::copy_n(from, rows, ensemble->row(0));
    std::copy_n(from + rows, influences.size(), influences.begin());
    from += rows + influences.size();
  }
  if (division_) division_->moved();
  influences_.calculated();
}

/// Reuses those of the last run, if they can continue from here.
FusedSteps* Simulation::whole_steps(double dt, std::optional<Dependence> const& now) {
  bool const can_go_on = whole_.steps && whole_.dt == dt && now && now->schemes && whole_.are_for == *now;
  if (!can_go_on) {
    whole_ = {};
    whole_ = {fused_steps(dt), dt, {}};
  }
  whole_.are_for.schemes.reset();  // until they are stored again
  return whole_.steps.get();
}

std::unique_ptr<FusedSteps> Simulation::fused_steps(double dt) {
  if (schemes_.size() != 1 || !changes_.empty() || !dissipations_.empty() || !events_.empty() || !barostats_.empty() ||
      substeps_ || velocity_forces_.any())
    return nullptr;
  std::vector<Mover> movers;
  for (auto const& part : parts_) {
    Method const method = part.integrator->method();
    if ((method != Method::leap_frog && method != Method::deactivate) || !part.integrator->same_for_all() ||
        !part.ensemble->driven().empty())
      return nullptr;
    movers.push_back({part.ensemble, method == Method::leap_frog});
  }
  return schemes_.front()->fused_steps(movers, dt);
}

void Simulation::check_moves() {
  if (is_divided()) return check_moves_together();
  for (auto const& part : parts_) check_move(part, part.integrator->largest_move());
}

void Simulation::check_move(Part const& part, LargestMove const& move) const {
  if (move.not_finite == LargestMove::nobody && move.square <= part.longest_move2) return;
  auto const& name = part.ensemble->name();
  if (move.not_finite != LargestMove::nobody) {
    if (Field const* field = driven_field_not_finite(*part.ensemble, move.not_finite))
      throw PhysicsFailure(
          fmt::format("particle {} of '{}' has a {} that is not finite: its rate has become too large, or "
                      "is not defined there",
                      move.not_finite, name, field->name));
    std::string why;
    for (auto const* scheme : schemes_)
      if (why.empty()) why = scheme->explain(*part.ensemble, move.not_finite);
    throw PhysicsFailure(
        fmt::format("particle {} of '{}' has a position or velocity that is not finite (or beyond the range of the "
                    "fixed-point grid){}{}",
                    move.not_finite, name, why.empty() ? "" : ": ", why));
  }
  double const moved = std::sqrt(move.square), allowed = std::sqrt(part.longest_move2);
  Dimension const unit = part.ensemble->fields().front().dimension;  // of the coordinate: a length, an angle
  auto const length = [&](double number) { return units().text(number, unit); };
  throw PhysicsFailure(fmt::format("particle {} of '{}' moved {} in one step, further than the length {} of its law{}",
                                   move.particle, name, length(moved), length(allowed), advice()));
}

std::string Simulation::advice_on_substeps() const {
  bool const sound =
      std::any_of(schemes_.begin(), schemes_.end(), [](Scheme const* s) { return std::isfinite(s->sound_step()); });
  if (!sound || substeps_) return "";
  if (!dissipations_.empty()) return "; take a shorter step";  // random numbers belong to whole steps
  return "; let steps be divided where they must: substeps = { courant = 0.4 } in [run] (divide_steps() in C++)";
}

/// The cure for a step that has moved a particle too far, if it is known.
std::string Simulation::advice() const {
  auto const told = [&](double number) { return units().text(number, dimensions::time, 3); };
  double const of_speeds = collisions_followed * collision_step_, safe = std::min(of_speeds, force_step_);
  if (auto const divided = advice_on_substeps(); !divided.empty()) return divided;
  if (std::abs(step_size_) > of_speeds)
    return fmt::format("; take a step below {}: a longer one does not follow collisions at the speeds of the start",
                       told(safe));
  if (std::abs(step_size_) > safe)
    return fmt::format("; the forces of the start are too large for it: take a step below {}", told(safe));
  if (std::isfinite(safe))
    return fmt::format("; the speeds and forces of the start allow this step, later ones do not: take a step below {}",
                       told(0.5 * std::abs(step_size_)));
  return "; take a shorter step";
}

}  // namespace boltzmann
