// Properties of its laws that a pair scheme reports to integrators and users.
#include <boltzmann/particles/tracer.hpp>
#include <boltzmann/schemes/pair/pair_scheme_laws.hpp>
#include <boltzmann/schemes/vortices/vortex_source.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double most_left_at_cutoff = 0.05;

double with_two_digits_below(double x) {
  double const digit = std::pow(10.0, std::floor(std::log10(x)) - 1);
  return std::isfinite(x) ? std::floor(x / digit) * digit : x;
}

}  // namespace

std::vector<Rotation> PairScheme::rotations(AnyEnsemble const& ensemble, bool taken) {
  std::vector<Rotation> rotations;
  for (auto const& external : external_) {
    if (external->ensemble != &ensemble || !external->kernels.rotate) continue;
    external->taken = taken;
    rotations.push_back(
        {external->kernels.rotate, external->law.get(), external->everyone ? nullptr : &external->only});
  }
  return rotations;
}

bool PairScheme::acts_uniformly(AnyEnsemble const& ensemble) const {
  auto const pulls = [&](auto const& near) { return near->target == &ensemble && near->traits.moves(); };
  if (std::any_of(near_.begin(), near_.end(), pulls)) return false;
  for (auto const& connected : connected_)
    if (connected->ensemble == &ensemble && connected->traits.moves()) return false;
  return std::all_of(external_.begin(), external_.end(), [&](auto const& external) {
    if (external->ensemble != &ensemble || !external->traits.moves()) return true;
    bool const by_velocity = external->traits.velocity_dependent && !external->kernels.rotate;
    return external->everyone && external->traits.uniform && !by_velocity;
  });
}

void PairScheme::add_outside(AnyEnsemble const& ensemble, double const* row, double time, double* influence) const {
  for (auto const& external : external_) {
    if (external->ensemble != &ensemble || external->taken || !external->traits.moves()) continue;
    ExternalTask task;
    task.rows = row;
    task.time = time;
    task.influence = influence;
    external->kernels.influence(external->law.get(), task, 0, 1);
  }
}

bool PairScheme::velocity_dependent(AnyEnsemble const& ensemble) const {
  auto const depends = [](auto const& laws, auto const& on) {
    return std::any_of(laws.begin(), laws.end(),
                       [&](auto const& law) { return law->traits.velocity_dependent && on(*law); });
  };
  return depends(near_, [&](Near const& near) { return near.target == &ensemble; }) ||
         depends(connected_, [&](Connected const& connected) { return connected.ensemble == &ensemble; }) ||
         depends(external_,
                 [&](External const& external) { return external.ensemble == &ensemble && !external.taken; });
}

void PairScheme::box_changed() {
  for (auto const& near : near_)
    for (int a = 0; a < box().dimension(); ++a)
      if (box().periodic(a) && near->cutoff * (near->filtered ? 2 : 1) > box().length(a))
        throw PhysicsFailure(
            fmt::format("the box has shrunk to {} along {}, less than {}the cut-off {} of a law on '{}'",
                        spoken_units().text(box().length(a), dimensions::length), "xyz"[a],
                        near -> filtered ? "twice (for it leaves out bonded pairs) " : "",
                        spoken_units().text(near->cutoff, dimensions::length), near->target->name()));
  neighbourhood_.stale();
}

bool PairScheme::translation_invariant() const {
  return box().all_open() && box().regions().empty() && external_.empty() &&
         std::all_of(near_.begin(), near_.end(), [](auto const& near) { return near->all_pairs(); });
}

double PairScheme::length_scale(AnyEnsemble const& ensemble) const {
  double shortest = no_cutoff;
  for (auto const& near : near_)
    if (near->target == &ensemble) shortest = std::min({shortest, near->length_scale(box()), near->cutoff});
  for (auto const& connected : connected_)
    if (connected->ensemble == &ensemble) shortest = std::min(shortest, connected->traits.length_scale);
  for (auto const& external : external_)
    if (external->ensemble == &ensemble) shortest = std::min(shortest, external->traits.length_scale);
  return shortest;
}

void PairScheme::make_reversible(double quantum) {
  auto const refuse = [](bool velocity_dependent, std::string const& name) {
    if (velocity_dependent)
      throw Error("the reversible leap-frog can't run a law that depends on velocities (on '" + name +
                  "'); use leap-frog");
  };
  for (auto const& near : near_) {
    refuse(near->traits.velocity_dependent, near->target->name());
    if (near->factor != 1)
      throw Error("the reversible leap-frog can't run a law that is scaled between bonded pairs (of '" +
                  near->target->name() + "'), only one that leaves them out; use leap-frog");
  }
  for (auto const& connected : connected_) refuse(connected->traits.velocity_dependent, connected->ensemble->name());
  for (auto const& external : external_) refuse(external->traits.velocity_dependent, external->ensemble->name());
  quantum_ = quantum;
}

std::string PairScheme::explain(AnyEnsemble const& ensemble, std::size_t i) const { return at_one_place(ensemble, i); }

double PairScheme::collision_step() const {
  double shortest = no_cutoff;
  for (auto const& near : near_) shortest = std::min(shortest, near->collision_step(box()));
  return with_two_digits_below(shortest);
}

std::vector<std::string> PairScheme::warnings(double step_size) {
  auto const told = [&](double number, Dimension unit) { return spoken_units().text(number, unit, 3); };
  double const dt = std::abs(step_size);
  std::vector<std::string> lines;
  for (auto const& near : near_) {
    bool const said = std::any_of(near_.begin(), near_.end(), [&](std::unique_ptr<Near> const& other) {
      return &other < &near && other->target == near->source && other->source == near->target;
    });
    if (near->traits.typed && !said) warn_of_typed(*near, lines);
    double const longest = said ? no_cutoff : near->collision_step(box());  // said: for the other order
    if (!(dt > longest)) continue;
    double const length = near->length_scale(box()), speed = pairs::collision_part * length / longest;
    lines.push_back(fmt::format(
        "warning: particles of '{}'{} meet at speeds up to {} and come {} closer in a step of {}, but the "
        "law between them changes over {}: collisions are not followed; take a step of at most {}",
        near->target->name(), near->target == near->source ? "" : fmt::format(" and '{}'", near->source->name()),
        told(speed, dimensions::velocity), told(speed * dt, dimensions::length), told(dt, dimensions::time),
        told(length, dimensions::length), told(with_two_digits_below(longest), dimensions::time)));
  }
  return lines;
}

/// Warns of a typed law that is not finite at some distance, or has a nonzero force at the cut-off.
void PairScheme::warn_of_typed(Near const& near, std::vector<std::string>& lines) const {
  auto const length = [&](double number) { return spoken_units().text(number, dimensions::length, 3); };
  auto const sample = near.sample(box());
  std::string const whose = near.target == near.source
                                ? fmt::format("within '{}'", near.target->name())
                                : fmt::format("of '{}' on '{}'", near.source->name(), near.target->name());
  if (sample.not_finite_at > 0)
    lines.push_back(fmt::format("warning: the formula law {} is not finite at a distance of {}{}", whose,
                                length(sample.not_finite_at),
                                near.all_pairs() ? "" : fmt::format(", within its cut-off {}", length(near.cutoff))));
  else if (!near.all_pairs() && sample.left_at_reach > most_left_at_cutoff)
    lines.push_back(
        fmt::format("warning: the formula law {} jumps at its cut-off {}: {:.0f} % of its greatest influence between "
                    "neighbours is left there; take a longer one, or at_cutoff = \"shift\" or \"switch\"",
                    whose, length(near.cutoff), 100 * sample.left_at_reach));
}

std::vector<VortexSource> PairScheme::vortices() const {
  std::vector<VortexSource> all;
  for (auto const& near : near_)
    if (near->traits.vortices && std::none_of(all.begin(), all.end(), [&](VortexSource const& one) {
          return one.ensemble == near->source && one.law.core == near->traits.vortices->core;
        }))
      all.push_back({near->source, *near->traits.vortices});
  return all;
}

void PairScheme::add_stream(std::span<double const> places, double time, std::span<double> velocities) {
  auto const D = static_cast<std::size_t>(box().dimension());
  auto const carried = [&](AnyEnsemble const& one) {
    return one.size() > 0 &&
           (one.moves_as() == typeid(Tracer<2>) || one.moves_as() == typeid(Tracer<3>) || one.find_field("vorticity"));
  };
  auto const first = std::find_if(external_.begin(), external_.end(), [&](auto const& external) {
    return external->traits.moves() && carried(*external->ensemble);
  });
  if (first == external_.end()) return;
  AnyEnsemble const& ensemble = *(*first)->ensemble;
  std::vector<double> row(ensemble.row(0), ensemble.row(0) + ensemble.stride()), influence(ensemble.influence_size());
  for (std::size_t k = 0; k < places.size() / D; ++k) {
    std::copy_n(places.begin() + static_cast<std::ptrdiff_t>(k * D), D, row.begin());
    std::fill(influence.begin(), influence.end(), 0.0);
    add_outside(ensemble, row.data(), time, influence.data());
    for (std::size_t a = 0; a < D; ++a) velocities[k * D + a] += influence[a];
  }
}

std::vector<PairScheme::Bond> PairScheme::bonds() const {
  std::vector<Bond> bonds;
  for (auto const& connected : connected_)
    for (std::uint32_t i = 0; i < connected->ensemble->size(); ++i)
      for (std::size_t k = connected->list.start[i]; k < connected->list.start[i + 1]; ++k)
        if (connected->list.index[k] > i) bonds.push_back({connected->ensemble, i, connected->list.index[k]});
  return bonds;
}

}  // namespace boltzmann
