// Profiles of matter along an axis.
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <algorithm>

namespace boltzmann::pictures {
namespace {

// The names of a profile's quantities, and its axis.
std::vector<std::string> profile_names(Picture const& picture) {
  auto const names = split_words(picture.y, ',');
  return names.empty() ? std::vector<std::string>{"density"} : names;
}
int profile_axis(Picture const& picture, int dimension) {
  if (picture.x.empty()) return 0;
  for (int a = 0; a < dimension; ++a)
    if (picture.x == std::string("position.") + "xyz"[a]) return a;
  throw Error("a profile in " + std::to_string(dimension) + "D is over position.x" +
              (dimension > 1 ? (dimension > 2 ? ", position.y or position.z" : " or position.y") : "") + ", not '" +
              picture.x + "'");
}

}  // namespace

void check_profiles(Question const& question) {
  if (question.ensembles.empty()) return;
  int const D = question.ensembles.front()->dimension();
  question.on("x", [&] { profile_axis(question.picture, D); });
  question.on("y", [&] {
    for (auto const& name : profile_names(question.picture)) profile_quantity(D, name);
  });
}

std::optional<Dimension> dimension_of_profile(Question const& question) {
  if (question.ensembles.empty()) return std::nullopt;
  auto const first = profile_names(question.picture).front();
  for (auto const& quantity : profile_quantities(question.ensembles.front()->dimension()))
    if (quantity.name == first) return quantity.dimension;
  return std::nullopt;
}

Canvas draw_profiles(Scene& scene) {
  int const D = scene.box().dimension(), a = profile_axis(scene.picture, D);
  EnergyAndVirial const measures = scene.context.simulation.measure();
  double const k = scene.context.units.is_reduced() ? 1 : scene.context.units(constants::boltzmann);
  Sample seen{scene.ensembles, scene.box(), &measures, k, scene.context.simulation.time(), 0};
  seen.momentum_is_kept = scene.context.simulation.momentum_is_kept();
  MassiveParticles const bodies(seen, &measures);
  std::size_t number = 0;
  for (auto const& source : bodies.sources()) number += source.ensemble->size();
  if (number == 0) return scene.too_few("a profile needs particles with a mass and a velocity");
  auto const bins = std::clamp<std::size_t>(number / 50, 1, static_cast<std::size_t>(scene.picture.bins.value_or(300)));
  auto const [low, high] = extent(bodies, scene.box(), a);
  Profile const found = profile(bodies, scene.box(), a, low, high, bins, k);

  std::vector<ProfileQuantity> meanings;
  for (auto const& name : profile_names(scene.picture)) meanings.push_back(profile_quantity(D, name));
  bool const one = meanings.size() == 1;
  bool const same = std::all_of(meanings.begin(), meanings.end(),
                                [&](auto const& m) { return m.dimension == meanings[0].dimension; });
  // Quantities of different dimensions have separate units.
  std::vector<Values> values;
  std::vector<Series> series;
  for (auto const& what : meanings) {
    values.push_back(found.values(what.name));
    auto const shown = scene.shown_in(what.dimension);
    if (!same)
      for (double& v : values.back()) v *= shown.factor;
    bool const with_unit = !same && !shown.unit.empty();
    series.push_back({one ? "" : with_unit ? what.label + " (" + shown.unit + ")" : what.label, {}, {}, {}});
  }
  for (std::size_t s = 0; s < series.size(); ++s) series[s].x = found.position, series[s].y = values[s];
  Axis x = scene.axis(std::string(1, "xyz"[a]), dimensions::length);
  x.low = low, x.high = high;
  Axis y = same ? scene.axis(one ? meanings[0].label : "", meanings[0].dimension) : Axis{};
  y.low = scene.picture.low, y.high = scene.picture.high, y.logarithmic = scene.picture.logarithmic;
  return draw_profile(series, x, y, scene.title());
}

}  // namespace boltzmann::pictures
