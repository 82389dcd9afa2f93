// Checks before the first step, so that an invalid simulation ends with one line.
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/rigid_motion.hpp>
#include <boltzmann/integrators/driven_fields.hpp>
#include <boltzmann/schemes/after_others.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/molecules/molecule_scheme.hpp>
#include <boltzmann/schemes/velocity_influences.hpp>
#include <boltzmann/simulation/simulation.hpp>
#include <boltzmann/simulation/start_forces.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {

void Simulation::check() { check(false); }

/// `added`: particles have been added during the run.
void Simulation::check(bool added) {
  if (checked_) return;
  make_ready();
  if (!minimisation_) check_start(added);
  checked_ = true;
  if (!begun_) checked_rows_ = checksum(false);
}

/// All preparations that do not depend on the size of forces.
void Simulation::make_ready() {
  small_system_ = {};
  whole_ = {};
  division_.reset();
  momentum_is_kept_.reset();
  move_walls(time());
  accept_particles();
  ensembles_ = supervised_by(schemes_);
  stages_ = 0;
  bool reversible = false, inside_step = any_comes_last(schemes_);
  for (auto* ensemble : ensembles_) {
    Part const& part = ready_part(*ensemble);
    Method const method = part.integrator->method();
    bool const driven = !ensemble->driven().empty();
    inside_step = inside_step || (method == Method::leap_frog && (driven || part.integrator->predicts_velocities()));
    stages_ = std::max(stages_, part.stages);
    reversible = reversible || method == Method::reversible_leap_frog;
  }
  std::erase_if(parts_, [&](Part const& p) {
    return std::find(ensembles_.begin(), ensembles_.end(), p.ensemble) == ensembles_.end();
  });
  find_velocity_forces();
  check_methods();
  check_shear();
  take_lengths();
  check_dissipations();
  if (substeps_) check_substeps();
  if (!slow_.empty()) check_slow_schemes();
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
  settle_dissipations();
  if (!barostats_.empty()) check_barostats();
}

/// By the steps of the run.
std::vector<Moved> Simulation::moved() const {
  std::vector<Moved> all;
  for (auto const* ensemble : ensembles_)
    for (auto const& part : parts_)
      if (part.ensemble == ensemble && part.integrator->method() != Method::deactivate &&
          !part.integrator->equations_of_motion())
        all.push_back({ensemble, part.integrator->resting(), std::sqrt(part.longest_move2)});
  return all;
}

/// Checks that forces are finite, and not too large for the first step of a run, or after particles have been added.
/// Stores what a later error message needs.
void Simulation::check_start(bool added) {
  check_influences();
  collision_step_ = std::numeric_limits<double>::infinity();
  for (auto const* scheme : schemes_) collision_step_ = std::min(collision_step_, scheme->collision_step());
  StartForces const forces = forces_at_start(moved(), ensembles_, schemes_.front()->box(), step_size_, collision_step_,
                                             added, dissipations_.empty() ? advice_on_substeps() : "");
  force_step_ = forces.step;
  if ((begun_ && !added) || substeps_) return;
  if (!forces.too_large.empty()) throw Error(forces.too_large);
  if (added) return;
  for (auto* scheme : schemes_) {
    auto* const mesh = dynamic_cast<MeshScheme*>(scheme);
    auto* const pairs = mesh ? &mesh->pairs() : dynamic_cast<PairScheme*>(scheme);
    if (auto const line = pairs ? pairs->overlap(step_size_) : ""; !line.empty()) throw Error(line);
  }
}

/// Prepares the integrator of an ensemble: its stages, and the work that it does for the schemes.
Simulation::Part const& Simulation::ready_part(AnyEnsemble& ensemble) {
  Part* part = part_of(ensemble);
  if (!part) part = &parts_.emplace_back(Part{&ensemble, usual_integrator(ensemble), 0, 0, {}, nullptr});
  part->integrator->threads(schemes_.front()->threads());
  // If other forces depend on the velocity, a magnetic field is applied as a force, too.
  bool takes = part->integrator->takes_rotations();
  for (auto* scheme : schemes_)
    if (auto const* laws = scheme->velocity_influences()) takes = takes && !laws->push(ensemble);
  std::vector<Rotation> rotations;
  for (auto* scheme : schemes_)
    for (auto const& rotation : scheme->rotations(ensemble, takes)) rotations.push_back(rotation);
  if (part->integrator->takes_rotations())
    part->integrator->rotate(takes ? std::move(rotations) : std::vector<Rotation>{});
  std::vector<RateSource*> sources;
  for (auto* scheme : schemes_)
    if (auto* source = scheme->rate_source(ensemble)) sources.push_back(source);
  part->integrator->rates_from(sources.size() == 1 ? sources.front() : nullptr);
  part->stages = part->integrator->stages();
  part->time_after.clear();
  for (int k = 0; k < part->stages; ++k) part->time_after.push_back(part->integrator->time_after(k));
  set_mobility(*part);
  part->home = *std::find_if(schemes_.begin(), schemes_.end(),
                             [&](Scheme const* scheme) { return scheme->supervises(ensemble); });
  return *part;
}

/// Forces on particles of leap-frog.
void Simulation::find_velocity_forces() {
  std::vector<VelocityForces::Mover> movers;
  for (auto* ensemble : ensembles_) {
    Part const& part = *part_of(*ensemble);
    if (is_leap_frog(part)) movers.push_back({ensemble, part.integrator.get()});
  }
  in_second_kick_ = false;
  velocity_forces_.find(schemes_, movers);
  check_velocity_forces();
}

/// The velocities at the end of a step are solved together for all ensembles that interact.
void Simulation::check_velocity_forces() const {
  auto const moves = [this](AnyEnsemble const& ensemble) { return method(ensemble) != Method::deactivate; };
  for (auto* scheme : schemes_) {
    auto const* const laws = scheme->velocity_influences();
    if (!laws) continue;
    for (auto const* target : scheme->ensembles())
      for (auto const* source : scheme->ensembles())
        if (method(*target) != method(*source) && moves(*target) && moves(*source) &&
            (method(*target) == Method::leap_frog || method(*source) == Method::leap_frog) &&
            laws->couple(*target, *source))
          throw Error(
              fmt::format("forces between '{}' and '{}' depend on velocities, but '{}' moves by {} and '{}' by {}: use "
                          "one integrator "
                          "for both, leap-frog or rk4",
                          target->name(), source->name(), target->name(), to_string(method(*target)), source->name(),
                          to_string(method(*source))));
  }
}

/// Sets which particles its integrator leaves at rest, and the degrees of freedom that rigid bonds remove.
void Simulation::set_mobility(Part const& part) {
  Mobility mobility;
  mobility.all_rest = part.integrator->method() == Method::deactivate;
  auto const resting = part.integrator->resting();
  if (!resting.empty()) mobility.rests.assign(part.ensemble->size(), 0);
  for (auto const i : resting)
    if (i < mobility.rests.size()) mobility.rests[i] = 1;
  auto const taken = part.integrator->taken_freedom();
  mobility.taken.assign(taken.begin(), taken.end());
  mobility.taken.resize(taken.empty() ? 0 : part.ensemble->size(), 0.0);
  part.ensemble->mobility = std::move(mobility);
}

/// Methods that advance all ensembles together can't be combined with others.
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
    if (auto* equations = part.integrator->equations_of_motion()) {
      together.push_back({equations});
      if (auto* fields = equations_of_fields(*part.integrator)) together.push_back({fields});
    } else if (method != Method::deactivate) {
      other = &part;
    }
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
  for (auto* ensemble : ensembles_)
    for (auto const& field : ensemble->driven())
      if (field.diffuses)
        throw Error("steps can't be divided into substeps where a field diffuses, as on ensemble '" + ensemble->name() +
                    "': its random numbers are of whole steps");
  if (!dissipations_.empty() || !equilibrations_.empty())
    throw Error(
        "steps with friction and noise can't be divided into substeps: their random numbers are of whole steps");
  if (substeps_->courant && std::none_of(schemes_.begin(), schemes_.end(),
                                         [](Scheme* scheme) { return std::isfinite(scheme->longest_step()); }))
    throw Error("substeps: no scheme of the simulation has a Courant step; give distance or energy");
}

/// Impulses require a common step of all ensembles, and forces that depend only on positions.
void Simulation::check_slow_schemes() {
  if (slow_.size() == schemes_.size()) throw Error("every: all influences have every > 1; take a longer step instead");
  if (substeps_)
    throw Error("every: steps that are divided into substeps have no steps in common; leave out one of both");
  for (auto* ensemble : ensembles_) {
    Method const method = this->method(*ensemble);
    if (method != Method::leap_frog && method != Method::deactivate)
      throw Error("every: influences with every > 1 are for leap-frog; ensemble '" + ensemble->name() + "' moves by " +
                  to_string(method));
    for (auto const& [scheme, steps] : slow_)
      if (scheme->velocity_dependent(*ensemble))
        throw Error("every: influences with every > 1 may depend on positions alone; those on ensemble '" +
                    ensemble->name() + "' depend on velocities");
    bool const predicts = part_of(*ensemble)->integrator->predicts_velocities() || !ensemble->driven().empty();
    if (predicts || any_comes_last(schemes_))
      throw Error("every: influences with every > 1 may depend on positions alone; those on ensemble '" +
                  ensemble->name() + "' depend on more");
  }
}

void Simulation::check_influences() const {
  // A law of several particles also gives other particles than the cause forces that are not finite.
  constexpr int most_asked = 30;
  int asked = 0;
  std::string first;
  for (auto* ensemble : ensembles_)
    for (std::size_t i = 0; i < ensemble->size() && asked < most_asked; ++i) {
      double const* const influence = ensemble->influence(i);
      if (std::all_of(influence, influence + ensemble->influence_size(), [](double x) { return std::isfinite(x); }))
        continue;
      ++asked;
      if (first.empty())
        first = fmt::format("the influence on particle {} of '{}' is not finite at the start", i, ensemble->name());
      for (auto const* scheme : schemes_)
        if (auto const why = scheme->explain(*ensemble, i); !why.empty()) throw Error(why);
    }
  if (!first.empty()) throw Error(first);
  for (auto* ensemble : ensembles_) {
    auto const influences = ensemble->influences();
    std::size_t const begin = ensemble->size() * ensemble->influence_size();
    for (std::size_t k = begin; k < influences.size(); ++k) {
      if (std::isfinite(influences[k])) continue;
      std::size_t const in_rates = (k - begin) / ensemble->rate_stride(), i = in_rates % ensemble->size();
      std::string name = "a field";
      for (auto const& field : ensemble->fields())
        if (ensemble->number_driven(field) == static_cast<int>(in_rates / ensemble->size())) name = field.name;
      throw Error(
          fmt::format("the rate of {} of particle {} of '{}' is not finite at the start", name, i, ensemble->name()));
    }
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
      bool const all = part->integrator->same_for_all() || dissipation->spares_resting();
      if (part->integrator->method() != Method::leap_frog || !all)
        throw Error("friction and noise act on ensemble '" + ensemble->name() +
                    "', which needs leap-frog for all its particles then, not " +
                    (all ? to_string(part->integrator->method()) : "some that are frozen"));
    }
    dissipation->check();
  }
}

std::array<bool, 3> Simulation::momentum_is_kept() const {
  if (momentum_is_kept_) return *momentum_is_kept_;
  std::array<bool, 3>& kept = momentum_is_kept_.emplace();
  if (!changes_.empty()) return kept;
  for (auto const* ensemble : ensembles_)
    if (!ensemble->mobility.all_move()) return kept;  // particles at rest absorb momentum
  if (!measure().reciprocal) return kept;
  if (!std::all_of(dissipations_.begin(), dissipations_.end(), [](auto const* one) { return one->keeps_momentum(); }))
    return kept;
  Box const& box = schemes_.front()->box();
  if (!box.regions().empty()) return kept;
  for (int a = 0; a < box.dimension(); ++a) kept[a] = !box.walled(a, Box::End::low) && !box.walled(a, Box::End::high);
  return kept;
}

/// Connects heat baths with the rest of the system, twice: the second pass depends on the momentum that they conserve.
void Simulation::settle_dissipations() {
  std::vector<Dissipation*> all = dissipations_;
  for (auto const& equilibration : equilibrations_) all.push_back(equilibration.dissipation.get());
  bool const asked = std::any_of(all.begin(), all.end(), [](auto const* one) { return one->asks_for_surroundings(); });
  if (!asked && barostats_.empty()) return;
  Surroundings around;
  around.equilibrates = equilibrates();
  for (auto const* ensemble : ensembles_)
    if (carries_momentum(*ensemble) && !ensemble->mobility.all_rest) around.massive.push_back(ensemble);
  for (auto* dissipation : all) dissipation->settle(around);
  around.momentum_is_kept = momentum_is_kept();
  for (auto* dissipation : all) dissipation->settle(around);
}

void Simulation::check_barostats() {
  if (substeps_) throw Error("barostat: steps that are divided into substeps don't go with it");
  if (!slow_.empty()) throw Error("barostat: forces that are calculated every few steps don't go with it");
  if (!changes_.empty()) throw Error("barostat: adaptations, which know their box, don't go with it");
  for (auto* ensemble : ensembles_) {
    Part const& part = *part_of(*ensemble);
    if (part.integrator->method() != Method::leap_frog || !part.integrator->same_for_all())
      throw Error(
          fmt::format("barostat: ensemble '{}' needs leap-frog for all its particles, not {}", ensemble->name(),
                      part.integrator->same_for_all() ? to_string(part.integrator->method()) : "some that are frozen"));
  }
  auto const known = [&](AnyEnsemble const* ensemble) {
    for (auto const* scheme : schemes_)
      if (auto const* molecules = dynamic_cast<MoleculeScheme const*>(scheme))
        for (auto const& rigid : molecules->rigid_bonds())
          if (&rigid->ensemble() == ensemble) return true;
    return false;
  };
  for (auto const* ensemble : ensembles_)
    if (!ensemble->mobility.taken.empty() && !known(ensemble))
      throw Error(
          "barostat: rigid bonds that no scheme holds would be stretched; MoleculeScheme::keeps() registers one");
  for (auto const& barostat : barostats_) barostat->check(stretched_system());
}

FixedPoint Simulation::choose_grid() const {
  double extent = 0, mass = std::numeric_limits<double>::infinity();
  bool open = false;  // open: particles may fly off; allow them 512 boxes, otherwise 4
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

}  // namespace boltzmann
