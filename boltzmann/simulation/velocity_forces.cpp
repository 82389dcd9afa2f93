// Leap-frog with forces that depend on velocities: selection of ensembles, and the second half kick.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/simulation/velocity_forces_parts.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <mutex>
#include <typeinfo>

namespace boltzmann {
namespace {

constexpr double squared(double x) { return x * x; }
// Changes of velocities between two iterations, relative to the velocities, squared.
constexpr double converged = squared(1e-12);       // ends the iteration
constexpr double rounding_errors = squared(1e-8);  // below it, changes that no longer decrease
constexpr double least_speed = 1e-3;               // relative to the fastest particle: slower ones count as this fast
constexpr int most_turns = 60;

bool moves_by_newton(AnyEnsemble const& ensemble) {
  auto const& moves = ensemble.moves_as();
  return moves == typeid(Newton<1>) || moves == typeid(Newton<2>) || moves == typeid(Newton<3>);
}

double over_ranks(Division* division, double most) {
  if (!division) return most;
  return 1 / division->least(1 / std::max(most, std::numeric_limits<double>::min()));
}

}  // namespace

void VelocityForces::Kicked::keep_rows(int threads) {
  std::size_t const stride = ensemble->stride();
  rows.resize(ensemble->size() * stride);
  tried.resize(ensemble->size() * D);
  each(threads, [&](std::size_t i) { std::copy_n(ensemble->row(i), stride, rows.data() + i * stride); });
}

void VelocityForces::Kicked::restore_rows(int threads) {
  std::size_t const stride = ensemble->stride();
  each(threads, [&](std::size_t i) {
    std::copy_n(velocity(i), D, tried.data() + i * D);
    std::copy_n(rows.data() + i * stride, stride, ensemble->row(i));
  });
}

/// The maximum of f(i) over this rank's particles; infinite if one is not finite.
template <class F>
double VelocityForces::Kicked::most(int threads, F const& f) const {
  double all = 0;
  bool finite = true;
  std::mutex mutex;
  for_share(*ensemble, grain, threads_for(ensemble->size(), 1, threads), [&](std::size_t begin, std::size_t end) {
    double most = 0;
    bool well = true;
    for (std::size_t i = begin; i < end; ++i) {
      double const x = f(i);
      most = std::max(most, x);
      well = well && std::isfinite(x);
    }
    std::lock_guard const lock(mutex);
    all = std::max(all, most);
    finite = finite && well;
  });
  return finite ? all : std::numeric_limits<double>::infinity();
}

double VelocityForces::Kicked::change(int threads) const {
  double const least = squared(least_speed) * fastest + std::numeric_limits<double>::min();
  return most(threads, [&](std::size_t i) {
    double difference = 0, sum = 0;
    for (std::size_t a = 0; a < D; ++a) {
      double const v = velocity(i)[a], before = tried[i * D + a];
      difference += squared(v - before);
      sum += squared(v) + squared(before);
    }
    return difference / (sum + least);
  });
}

VelocityForces::VelocityForces() = default;
VelocityForces::~VelocityForces() = default;

void VelocityForces::find(std::vector<Scheme*> const& schemes, std::vector<Mover> const& movers) {
  sources_.clear();
  kicked_.clear();
  drifting_.clear();
  units_ = &schemes.front()->spoken_units();
  auto const kick = [this](Mover const& mover) {
    if (kicks(*mover.ensemble)) return;
    Field const& velocity = mover.ensemble->field("velocity");
    kicked_.push_back(
        {mover.ensemble, mover.integrator, velocity.offset, static_cast<std::size_t>(velocity.components), {}, {}, 0});
  };
  for (auto* scheme : schemes) {
    auto* const part = scheme->velocity_influences();
    auto source = std::make_unique<Source>();
    source->scheme = scheme;
    source->part = part;
    for (auto const& mover : movers) {
      AnyEnsemble& ensemble = *mover.ensemble;
      if (!part) {
        source->between =
            source->between || (!mover.integrator->predicts_velocities() && scheme->velocity_dependent(ensemble));
        if (source->between && scheme->velocity_dependent(ensemble)) kick(mover);
        continue;
      }
      if (part->act_between(ensemble)) {
        source->between = true;
        kick(mover);
      }
      if (!part->act_from_outside(ensemble)) continue;
      source->outside.push_back(&ensemble);
      if (!moves_by_newton(ensemble) || mover.integrator->has_groups())
        kick(mover);
      else if (!drifting(ensemble))
        drifting_.push_back(Drifting(ensemble, *mover.integrator));
    }
    if (part) part->separate({source->outside.begin(), source->outside.end()}, source->between);
    if (source->between || !source->outside.empty()) sources_.push_back(std::move(source));
  }
  // All external laws on an ensemble act together, even of different schemes.
  for (auto& source : sources_) {
    if (!source->part) continue;
    for (auto& one : drifting_)
      if (source->scheme->supervises(*one.ensemble) &&
          std::find(source->outside.begin(), source->outside.end(), one.ensemble) == source->outside.end())
        source->outside.push_back(one.ensemble);
    source->part->separate({source->outside.begin(), source->outside.end()}, source->between);
  }
}

bool VelocityForces::takes(Scheme const& scheme) const {
  return std::any_of(sources_.begin(), sources_.end(),
                     [&](auto const& source) { return source->scheme == &scheme && !source->part; });
}

bool VelocityForces::kicks(AnyEnsemble const& ensemble) const {
  return std::any_of(kicked_.begin(), kicked_.end(), [&](Kicked const& one) { return one.ensemble == &ensemble; });
}

VelocityForces::Drifting* VelocityForces::drifting(AnyEnsemble const& ensemble) {
  for (auto& one : drifting_)
    if (one.ensemble == &ensemble) return &one;
  return nullptr;
}

void VelocityForces::add_between(double time) {
  for (auto const& source : sources_) {
    if (!source->between) continue;
    if (source->part)
      source->part->add_between();
    else
      source->scheme->add_influences(time);
  }
}

void VelocityForces::add_outside(double time, bool of_drifting) {
  for (auto const& source : sources_)
    for (auto* ensemble : source->outside) {
      if (!of_drifting && drifting(*ensemble)) continue;
      for_share(*ensemble, Kicked::grain, threads_for(ensemble->size(), 1, source->scheme->threads()),
                [&](std::size_t begin, std::size_t end) {
                  source->part->add_from_outside(
                      *ensemble, {ensemble->row(begin), begin, end - begin, time, ensemble->influence(begin)});
                });
    }
}

void VelocityForces::complete(double time, bool before_second_kick) {
  // The first source of an ensemble keeps its influences.
  std::vector<AnyEnsemble*> kept;
  for (auto const& source : sources_) {
    source->targets = source->scheme->ensembles();
    source->others.resize(source->targets.size());
    for (std::size_t k = 0; k < source->targets.size(); ++k) {
      AnyEnsemble const& ensemble = *source->targets[k];
      source->others[k].clear();
      if (std::find(kept.begin(), kept.end(), &ensemble) != kept.end()) continue;
      kept.push_back(source->targets[k]);
      double const* const from = ensemble.influences().data();
      source->others[k].assign(from, from + ensemble.size() * ensemble.influence_size());
    }
  }
  add_between(time);
  add_outside(time, !before_second_kick);
}

void VelocityForces::restore_others() {
  for (auto const& source : sources_)
    for (std::size_t k = 0; k < source->targets.size(); ++k)
      std::copy(source->others[k].begin(), source->others[k].end(), source->targets[k]->influences().begin());
}

void VelocityForces::refresh(double time) {
  restore_others();
  add_between(time);
  add_outside(time, true);
}

/// The kick from the saved rows, with the current influences. Returns the largest relative change of a velocity,
/// squared; infinite if one is not finite.
double VelocityForces::kick(int stage, StepContext const& context, Division* division, int threads) {
  double most = 0;
  for (auto& one : kicked_) {
    one.restore_rows(threads);
    one.integrator->advance(stage, context);
    most = std::max(most, one.change(threads));
  }
  if (division) division->moved();
  return over_ranks(division, most);
}

void VelocityForces::second_kick(int stage, StepContext const& context, double time, Division* division, int threads) {
  if (!kicked_.empty()) {
    double fastest = 0;
    for (auto& one : kicked_) {
      one.keep_rows(threads);
      fastest = std::max(fastest, one.most(threads, [&](std::size_t i) {
        double sum = 0;
        for (std::size_t a = 0; a < one.D; ++a) sum += squared(one.velocity(i)[a]);
        return sum;
      }));
    }
    fastest = over_ranks(division, fastest);
    for (auto& one : kicked_) one.fastest = fastest;
    double before = kick(stage, context, division, threads);
    for (int turn = 1;; ++turn) {
      restore_others();
      add_between(time);
      add_outside(time, false);
      double const change = kick(stage, context, division, threads);
      if (!std::isfinite(change)) break;  // Simulation::check_moves() names the particle
      if (change <= converged || (turn > 2 && change < rounding_errors && change > before / 4)) break;
      if (turn == most_turns) refuse(context.dt, "", std::sqrt(change / before));
      before = change;
    }
  }
  refresh(time);
}

void VelocityForces::refuse(double dt, std::string const& who, double factor) const {
  throw PhysicsFailure(
      fmt::format("forces that depend on velocities change these so fast that the velocity {}in a step of {} can't be "
                  "found; take a step below {}, or rk4",
                  who, units_->text(std::abs(dt), dimensions::time),
                  units_->text(0.25 * std::abs(dt) / std::max(1.0, factor), dimensions::time, 2)));
}

}  // namespace boltzmann
