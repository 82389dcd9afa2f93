// Evaluates quantities by name, for pictures, and restores the simulation afterwards.
#include <boltzmann/pictures/drawing_cartesian.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann::pictures {

Scene::Scene(Picture const& what, PictureContext const& where)
    : picture(what), context(where), ensembles(supervised_by(where.simulation.schemes())) {}

Scene::~Scene() {
  put_particles_back();
  for (std::size_t e = 0; e < influences_.size(); ++e)
    std::copy(influences_[e].begin(), influences_[e].end(), ensembles[e]->influences().begin());
  auto const& schemes = context.simulation.schemes();
  for (std::size_t s = 0; s < schemes_.size(); ++s) schemes[s]->restore(schemes_[s]);
}

Box const& Scene::box() const { return context.simulation.schemes().front()->box(); }

int Scene::threads() const {
  return context.threads > 0 ? context.threads : context.simulation.schemes().front()->threads();
}

UnitSystem::Display Scene::shown_in(Dimension dimension) const { return context.units.display(dimension); }

Axis Scene::axis(std::string label, Dimension dimension) const {
  auto const [unit, factor] = shown_in(dimension);
  Axis result{std::move(label), unit};
  result.factor = factor;
  return result;
}

std::string Scene::title(bool with_time) const {
  if (!with_time) return context.title;
  std::string text = context.title.empty() ? "" : context.title + ", ";
  auto const time = context.units.text(context.time, dimensions::time);
  return text + (time.find(' ') == std::string::npos ? fmt::format("step {}, time {}", context.step, time)
                                                     : fmt::format("step {} ({})", context.step, time));
}

Colour Scene::colour(std::size_t ensemble) const {
  auto const& name = ensembles[ensemble]->appearance.colour;
  if (!name.empty()) return colour_named(name);
  return ensemble < picture.palette.size() ? picture.palette[ensemble] : species_colour(static_cast<int>(ensemble));
}

Colour Scene::track_colour(std::size_t ensemble, std::size_t particle) const {
  bool const few = ensembles.size() == 1 && ensembles[0]->size() <= 8;
  return with_alpha(few ? species_colour(static_cast<int>(particle)) : colour(ensemble), 0.7);
}

ColourMap Scene::fitting_map(Values const& shown) const {
  bool const negative = std::isfinite(picture.low)
                            ? picture.low < 0
                            : std::any_of(shown.begin(), shown.end(), [](double v) { return v < 0; });
  bool const positive = std::isfinite(picture.high)
                            ? picture.high > 0
                            : std::any_of(shown.begin(), shown.end(), [](double v) { return v > 0; });
  return negative && positive ? ColourMap::diverging : ColourMap::viridis;
}

Canvas Scene::too_few(std::string const& why) const {
  Canvas canvas;
  canvas.title(title(false));
  canvas.note(why);
  return canvas;
}

EnergyAndVirial Scene::potential_energies() {
  EnergyAndVirial measures = context.simulation.measure();
  if (measures.per_particle.empty())
    throw Error("potential energies can't be shown: " + (measures.unknown.empty()
                                                             ? "a scheme does not know them of each particle"
                                                             : measures.unknown + " gives none"));
  return measures;
}

template <class Function>
void Scene::each_ensemble(std::string const& name, Function function) {
  meaning(ensembles, name, &context.units);
  need(name);
  bool const of_pairs = name == "potential-energy" || name.find("potential_energy") != std::string::npos;
  EnergyAndVirial const measures = of_pairs ? potential_energies() : EnergyAndVirial{};
  for (std::size_t e = 0; e < ensembles.size(); ++e)
    function(*ensembles[e], e < measures.per_particle.size() ? std::span<double const>(measures.per_particle[e])
                                                             : std::span<double const>());
}

std::vector<Values> Scene::values(std::string const& name) {
  std::vector<Values> all;
  each_ensemble(name, [&](AnyEnsemble const& one, std::span<double const> potential) {
    all.push_back(has_quantity(one, name, &context.units) ? quantity(one, name, potential, &context.units)
                                                          : Values(one.size(), no_value));
  });
  return all;
}

std::vector<ParticleColumn> Scene::columns(std::string const& name) {
  std::vector<ParticleColumn> all;
  each_ensemble(name, [&](AnyEnsemble const& one, std::span<double const> potential) {
    all.push_back(has_quantity(one, name, &context.units) ? column_of(one, name, potential, &context.units)
                                                          : ParticleColumn{});
  });
  return all;
}

// Classes without a velocity use their influence as such, and an integrator leaves that of an intermediate stage.
void Scene::need(std::string const& name) {
  auto const reads = [&](char const* what) { return name.find(what) != std::string::npos; };
  bool const motion = reads("speed") || reads("velocity") || reads("kinetic");
  bool const needed =
      reads("influence") || (motion && std::any_of(ensembles.begin(), ensembles.end(),
                                                   [](AnyEnsemble* e) { return !e->find_field("velocity"); }));
  if (!needed || fresh_) return;
  fresh_ = true;
  keep_influences();
  for (auto* ensemble : ensembles) ensemble->clear_influence();
  for (auto* scheme : context.simulation.schemes()) scheme->add_influences(context.time);
}

void Scene::keep_influences() {
  if (kept_) return;
  kept_ = true;
  for (auto const* ensemble : ensembles) {
    std::span<double const> const influences = ensemble->influences();
    influences_.emplace_back(influences.begin(), influences.end());
  }
}

void Scene::keep_particles() {
  keep_influences();
  for (auto const* scheme : context.simulation.schemes()) schemes_.push_back(scheme->state());
  for (auto const* ensemble : ensembles) rows_.push_back(copy_rows(*ensemble));
}

std::array<double, 2> zoomed(std::array<double, 2> const& side, std::array<double, 2> const& region) {
  std::array<double, 2> const part{std::max(side[0], region[0]), std::min(side[1], region[1])};
  if (part[0] < part[1]) return part;
  return std::isfinite(region[0]) && std::isfinite(region[1]) && region[0] < region[1] ? region : side;
}

void Scene::put_particles_back() {
  for (std::size_t e = 0; e < rows_.size(); ++e) restore_rows(rows_[e], *ensembles[e]);
}

std::vector<std::array<double, 2>> Scene::shown_box(std::array<std::array<double, 2>, 3> const& reach) const {
  std::vector<std::array<double, 2>> sides;
  for (int a = 0; a < box().dimension(); ++a) {
    std::array<double, 2> side{box().low(a), box().high(a)};
    if (box().boundary(a) == Boundary::open) {
      double const room = box().length(a) / 2;
      auto const& [low, high] = reach[static_cast<std::size_t>(a)];
      side = {std::max(std::min(side[0], low), side[0] - room), std::min(std::max(side[1], high), side[1] + room)};
    }
    if (static_cast<std::size_t>(a) < picture.region.size()) side = zoomed(side, picture.region[a]);
    sides.push_back(side);
  }
  return sides;
}

std::array<std::array<double, 2>, 3> Scene::open_reach() const {
  constexpr double infinity = std::numeric_limits<double>::infinity();
  std::array<std::array<double, 2>, 3> reach;
  reach.fill({infinity, -infinity});
  auto const D = static_cast<std::size_t>(box().dimension());
  bool any = false;
  for (std::size_t a = 0; a < D; ++a) any = any || box().boundary(static_cast<int>(a)) == Boundary::open;
  if (!any) return reach;
  auto const take = [D, &reach](double const* row, bool finite_only) {
    for (std::size_t a = 0; a < D; ++a) {
      if (finite_only && !std::isfinite(row[a])) continue;
      auto& [low, high] = reach[a];
      low = row[a] < low ? row[a] : low;
      high = row[a] > high ? row[a] : high;
    }
  };
  for (bool const finite_only : {false, true}) {  // first the fast method; repeat if a position is infinite
    reach.fill({infinity, -infinity});
    for (auto const* ensemble : ensembles)
      for (std::size_t i = 0; i < ensemble->size(); ++i) take(ensemble->row(i), finite_only);
    if (std::none_of(reach.begin(), reach.end(), [](auto const& side) {
          return side[0] <= side[1] && (std::isinf(side[0]) || std::isinf(side[1]));
        }))
      break;
  }
  for (std::size_t a = 0; a < 3; ++a)
    if (a >= D || box().boundary(static_cast<int>(a)) != Boundary::open) reach[a] = {infinity, -infinity};
  return reach;
}

MeshGrid picture_grid(Scene const& scene, std::vector<std::array<double, 2>> const& shown,
                      std::array<int, 2> const& axes, bool corners, int usual_cells) {
  MeshGrid grid;
  grid.dimension = static_cast<int>(std::min<std::size_t>(shown.size(), 2));
  double longest = 0;
  for (int k = 0; k < grid.dimension; ++k) longest = std::max(longest, shown[axes[k]][1] - shown[axes[k]][0]);
  for (int k = 0; k < grid.dimension; ++k) {
    auto const [low, high] = shown[axes[k]];
    double const cells = std::max(2.0, std::round(scene.picture.cells.value_or(usual_cells) * (high - low) / longest));
    grid.spacing[k] = (high - low) / cells;
    grid.periodic[k] = scene.box().periodic(axes[k]);
    grid.low[k] = corners ? low : low + grid.spacing[k] / 2;
    grid.nodes[k] = static_cast<std::size_t>(cells) + (corners && !grid.periodic[k] ? 1 : 0);
  }
  return grid;
}

CloudOptions cloud_options(Scene const& scene) {
  CloudOptions options;
  options.low = scene.picture.low;
  options.high = scene.picture.high;
  options.most = scene.picture.most;
  options.region = scene.picture.region;
  options.threads = scene.threads();
  options.memory = scene.context.memory;
  return options;
}

void note_shown(Canvas& canvas, ParticleClouds const& clouds, bool region) {
  if (region)
    canvas.note(fmt::format("{} of {} particles {} in this region", clouds.inside, clouds.particles,
                            clouds.inside == 1 ? "is" : "are"));
  if (clouds.stride > 1) canvas.note(fmt::format("1 of {} particles shown", clouds.stride));
}

void explain_values(Canvas& canvas, Scene const& scene, ParticleClouds const& clouds) {
  auto const what = meaning(scene.ensembles, scene.picture.colour);
  auto const shown = scene.shown_in(what.dimension);
  canvas.colour_bar(what.label, shown.unit, clouds.low, clouds.high, clouds.map, shown.factor);
  note_without_value(canvas, clouds.without_value);
}

Heading heading(std::string const& text) {
  std::size_t const at = text.rfind(" (");
  if (at == std::string::npos || text.back() != ')') return {text, ""};
  return {text.substr(0, at), text.substr(at + 2, text.size() - at - 3)};
}

QuantityMeaning meaning(std::vector<AnyEnsemble*> const& ensembles, std::string const& name, UnitSystem const* units) {
  for (auto const* ensemble : ensembles)
    if (has_quantity(*ensemble, name, units)) return quantity_meaning(*ensemble, name, units);
  if (ensembles.empty()) throw Error("there are no particles to draw");
  return quantity_meaning(*ensembles.front(), name, units);  // throws, with the allowed names
}

Values joined(std::vector<Values> const& parts) {
  Values all;
  for (auto const& part : parts) all.insert(all.end(), part.begin(), part.end());
  return all;
}

}  // namespace boltzmann::pictures
