// Slabs: members are selected by position once, then followed by number.
#include <boltzmann/diagnoses/slab.hpp>

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

namespace boltzmann {
namespace {

bool chosen(SlabOptions const& options, AnyEnsemble const& ensemble) {
  auto const& names = options.ensembles;
  return carries_momentum(ensemble) &&
         (names.empty() || std::find(names.begin(), names.end(), ensemble.name()) != names.end());
}

/// "a slab along x from 1 to 2"
std::string described(SlabOptions const& options, double from, double to) {
  return fmt::format("a slab along {} from {:.6g} to {:.6g}", "xyz"[options.axis], from, to);
}

}  // namespace

SlabMembers slab_members(std::span<AnyEnsemble const* const> ensembles, Box const& box, SlabOptions const& options) {
  if (options.axis < 0 || options.axis >= box.dimension())
    throw Error(fmt::format("a slab along axis {}: the space has {}", "xyz"[std::clamp(options.axis, 0, 2)],
                            box.dimension() == 1   ? "x only"
                            : box.dimension() == 2 ? "x and y"
                                                   : "x, y and z"));
  if (options.count == 0) throw Error("a slab diagnosis needs at least one slab");
  double const from = std::isnan(options.from) ? box.low(options.axis) : options.from;
  double const to = std::isnan(options.to) ? box.high(options.axis) : options.to;
  if (!(from < to) || !std::isfinite(to - from))
    throw Error(fmt::format("{}: its begin must be below its end", described(options, from, to)));
  double const width = (to - from) / static_cast<double>(options.count);
  SlabMembers members(options.count, std::vector<std::vector<std::uint32_t>>(ensembles.size()));
  for (std::size_t e = 0; e < ensembles.size(); ++e) {
    if (!chosen(options, *ensembles[e])) continue;
    for (std::size_t i = 0; i < ensembles[e]->size(); ++i) {
      double const x = ensembles[e]->row(i)[options.axis];
      if (!(x >= from && x <= to)) continue;
      auto const slab = std::min(static_cast<std::size_t>((x - from) / width), options.count - 1);
      members[slab][e].push_back(static_cast<std::uint32_t>(i));
    }
  }
  for (std::size_t s = 0; s < members.size(); ++s)
    if (std::all_of(members[s].begin(), members[s].end(), [](auto const& some) { return some.empty(); })) {
      double const low = from + width * static_cast<double>(s);
      throw Error(fmt::format("{} has no particle at the start",
                              described(options, low, s + 1 < options.count ? low + width : to)));
    }
  return members;
}

Layer layer_of(std::span<double const> position, std::span<double const> mass, Box const& box, int axis) {
  if (position.empty()) return {};
  // On a periodic axis: the image of each particle that is nearest to their mean on the circle.
  double reference = 0, turns = 0;
  if (box.periodic(axis)) {
    turns = box.length(axis);
    ExactSum sine, cosine;
    for (double const x : position) {
      double const angle = 2 * std::numbers::pi * (x - box.low(axis)) / turns;
      sine += std::sin(angle);
      cosine += std::cos(angle);
    }
    reference = box.low(axis) + std::atan2(sine.value(), cosine.value()) / (2 * std::numbers::pi) * turns;
  }
  auto const place = [&](double x) {
    double const away = x - reference;
    return turns > 0 ? away - turns * std::round(away / turns) : away;
  };
  ExactSum moment, weight, sum;
  for (std::size_t i = 0; i < position.size(); ++i) {
    moment += mass[i] * place(position[i]);
    weight += mass[i];
    sum += place(position[i]);
  }
  double const mean = sum.value() / static_cast<double>(position.size());
  ExactSum squares;
  for (double const x : position) squares += (place(x) - mean) * (place(x) - mean);
  double const centre = reference + moment.value() / weight.value();
  return {turns > 0 ? box.wrapped(centre, axis) : centre,
          std::sqrt(12 * squares.value() / static_cast<double>(position.size()))};
}

Slab::Slab(std::vector<AnyEnsemble const*> const& ensembles, SlabOptions options)
    : options_(std::move(options)),
      dimension_(ensembles.empty() ? 0 : ensembles.front()->dimension()),
      ensembles_(ensembles.size()) {
  if (ensembles.empty()) throw Error("a slab needs particles; the simulation has none");
  if (options_.axis < 0 || options_.axis >= dimension_)
    throw Error(fmt::format("a slab along axis {}: the space has {} ax{}", "xyz"[std::clamp(options_.axis, 0, 2)],
                            dimension_, dimension_ == 1 ? "is" : "es"));
  if (options_.count == 0) throw Error("a slab diagnosis needs at least one slab");
  if (std::any_of(options_.label.begin(), options_.label.end(), [](unsigned char c) { return c < ' ' || c == 127; }))
    throw Error("a slab's label is a part of the names of columns: it has no line breaks or other control characters");
  if (!std::isnan(options_.from) && !std::isnan(options_.to) && !(options_.from < options_.to))
    throw Error(fmt::format("{}: its begin must be below its end", described(options_, options_.from, options_.to)));
  bool any = false;
  for (auto const* ensemble : ensembles) any = any || chosen(options_, *ensemble);
  if (!any) throw Error("a slab needs particles with a mass and a velocity; no ensemble that was chosen has both");
}

std::vector<Column> Slab::columns() const {
  std::vector<Column> columns;
  for (std::size_t s = 0; s < options_.count; ++s) {
    std::string const prefix =
        (options_.count == 1 ? options_.label : fmt::format("{} {}", options_.label, s + 1)) + " ";
    columns.push_back({prefix + "kinetic temperature", dimensions::temperature});
    for (int a = 0; a < dimension_; ++a)
      columns.push_back({prefix + "kinetic temperature " + "xyz"[a], dimensions::temperature});
    columns.push_back({prefix + "internal temperature", dimensions::temperature});
    columns.push_back({prefix + "density", dimensions::mass / pow(dimensions::length, dimension_)});
    for (int a = 0; a < dimension_; ++a) columns.push_back({prefix + "velocity " + "xyz"[a], dimensions::velocity});
    columns.push_back({prefix + "position " + "xyz"[options_.axis], dimensions::length});
  }
  return columns;
}

void Slab::measure(Sample const& sample, std::vector<double>& values) {
  if (members_.empty()) members_ = slab_members(sample.ensembles, sample.box, options_);
  if (sample.ensembles.size() != ensembles_)
    throw Error("a slab diagnosis was made for other ensembles than the simulation has");
  // By index in the simulation; ensembles without momentum have no members.
  MassiveParticles const bodies(sample, nullptr);
  std::vector<MomentSums::Body> found;
  std::vector<double> position, mass;
  for (auto const& slab : members_) {
    found.clear();
    position.clear();
    mass.clear();
    for (auto const& source : bodies.sources()) {
      auto const e = static_cast<std::size_t>(
          std::find(sample.ensembles.begin(), sample.ensembles.end(), source.ensemble) - sample.ensembles.begin());
      for (std::uint32_t const i : slab[e]) {
        if (i >= source.ensemble->size())
          throw Error(fmt::format("a slab has particle {} of '{}', which has {} now", i, source.ensemble->name(),
                                  source.ensemble->size()));
        found.push_back(MassiveParticles::body(source, i));
        position.push_back(source.ensemble->row(i)[options_.axis]);
        mass.push_back(found.back().mass);
      }
    }
    MomentSums sum;
    sum.add(found, dimension_, bodies.kept());
    Layer const layer = layer_of(position, mass, sample.box, options_.axis);
    sum.add_volume(layer.width * cross_section(sample.box, options_.axis));
    MatterState const matter = sum.matter(dimension_, sample.boltzmann_constant);
    values.push_back(matter.mean_kinetic_temperature);
    values.insert(values.end(), matter.kinetic_temperature.begin(), matter.kinetic_temperature.begin() + dimension_);
    values.push_back(matter.internal_temperature);
    values.push_back(matter.density);
    values.insert(values.end(), matter.velocity.begin(), matter.velocity.begin() + dimension_);
    values.push_back(layer.centre);
  }
}

std::vector<double> Slab::state() const {
  std::vector<double> state;
  for (auto const& slab : members_)
    for (auto const& some : slab) {
      state.push_back(static_cast<double>(some.size()));
      state.insert(state.end(), some.begin(), some.end());
    }
  return state;
}

void Slab::restore(std::span<double const> state) {
  members_.clear();
  if (state.empty()) return;
  SlabMembers members(options_.count, std::vector<std::vector<std::uint32_t>>(ensembles_));
  std::size_t at = 0;
  for (auto& slab : members)
    for (auto& some : slab) {
      auto const left = static_cast<double>(state.size() - at);
      double const count = at < state.size() ? state[at++] : -1;
      if (!(count >= 0 && count < left))
        throw Error("the checkpoint does not fit this diagnosis: its slabs are others");
      for (std::size_t k = 0; k < static_cast<std::size_t>(count); ++k)
        some.push_back(static_cast<std::uint32_t>(state[at++]));
    }
  if (at != state.size()) throw Error("the checkpoint does not fit this diagnosis: its slabs are others");
  members_ = std::move(members);
}

}  // namespace boltzmann
