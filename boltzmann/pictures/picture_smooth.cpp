// Smooth fields of particles as maps, contours and bands.
#include <boltzmann/pictures/contours.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann::pictures {

void check_smooth_field(Question const& question) {
  auto const& picture = question.picture;
  if (picture.y != "density") question.known("y", picture.y);
  question.on("drawing", [&] {
    if (picture.drawing != "map" && !question.ensembles.empty() && question.ensembles.front()->dimension() == 1)
      throw Error("'" + picture.drawing + "' are drawn in 2D and 3D; in 1D 'map' draws a curve");
  });
  question.on("levels", [&] {
    if (!std::all_of(picture.levels.begin(), picture.levels.end(), [](double v) { return std::isfinite(v); }) ||
        !std::is_sorted(picture.levels.begin(), picture.levels.end()))
      throw Error("the levels of contours and bands must be finite and ascend");
  });
  question.need_slice();
}

std::optional<Dimension> dimension_of_smooth_field(Question const& question) {
  if (question.ensembles.empty()) return std::nullopt;
  auto const& name = question.picture.y;
  if (!name.empty() && name != "density") return question.dimension(name);
  auto const& first = *question.ensembles.front();
  return (first.find_field("mass") ? dimensions::mass : dimensions::none) / pow(dimensions::length, first.dimension());
}

namespace {

// The ensembles that have the quantity of a smooth field; all have a density.
std::vector<AnyEnsemble*> ensembles_with(Scene const& scene, std::string const& name) {
  std::vector<AnyEnsemble*> all;
  if (name != "density") meaning(scene.ensembles, name);
  for (auto* ensemble : scene.ensembles)
    if (name == "density" || has_quantity(*ensemble, name)) all.push_back(ensemble);
  return all;
}

SmoothColumn smooth_column(Scene& scene, SmoothField const& field, std::string const& name) {
  if (name == "potential-energy") return {joined(scene.values(name))};
  scene.need(name);
  return field.column(name);
}

/// The smoothing of the picture; its range is a suitable one, unless it is given or the particles have their own.
Smoothing smoothing_of(Scene const& scene, std::vector<AnyEnsemble*> const& of) {
  Smoothing smoothing = scene.picture.smoothing;
  bool const own = std::all_of(of.begin(), of.end(), [](auto* e) { return e->find_field("range") != nullptr; });
  if (smoothing.range == 0 && !own) smoothing.range = fitting_range(of, scene.box());
  return smoothing;
}

}  // namespace

Canvas draw_smooth_field(Scene& scene) {
  std::string const name = scene.picture.y.empty() ? "density" : scene.picture.y;
  auto const of = ensembles_with(scene, name);
  if (std::all_of(of.begin(), of.end(), [](auto* e) { return e->size() == 0; }))
    return scene.too_few("a smooth field needs particles, and there are none");
  SmoothField const field(of, scene.box(), smoothing_of(scene, of));
  auto const what = field.meaning(name);
  auto const [unit, factor] = scene.shown_in(what.dimension);

  int const D = scene.box().dimension();
  auto const shown = scene.shown_box(scene.open_reach());
  int const normal = D == 3 ? scene.picture.slice[0] - 'x' : 2;
  std::array<int, 2> const axes{normal == 0 ? 1 : 0, normal == 2 ? 1 : 2};
  double const at = D == 3 && std::isnan(scene.picture.at) ? 0.5 * (scene.box().low(normal) + scene.box().high(normal))
                                                           : scene.picture.at;
  MeshGrid const grid = picture_grid(scene, shown, axes, D == 1 || scene.picture.drawing == "contours", 300);
  Values points;
  auto const on_plane = points_on_grid(grid);
  for (std::size_t p = 0; p < grid.size(); ++p)
    for (int a = 0; a < D; ++a)
      points.push_back(a == normal ? at
                                   : on_plane[p * static_cast<std::size_t>(grid.dimension) + (a == axes[0] ? 0 : 1)]);
  Values const found =
      (name == "density" ? field.density(points) : field.value(points, smooth_column(scene, field, name))).value;

  auto const along = [&](int k) {
    Axis result = scene.axis(std::string(1, "xyz"[axes[k]]), dimensions::length);
    result.low = shown[axes[k]][0];
    result.high = shown[axes[k]][1];
    return result;
  };
  if (D == 1) {
    Series const curve{"", on_plane, found};
    Axis y = scene.axis(what.label, what.dimension);
    y.low = scene.picture.low, y.high = scene.picture.high;
    return boltzmann::draw_time_series({&curve, 1}, along(0), y, scene.title());
  }
  bool const given = std::isfinite(scene.picture.low) && std::isfinite(scene.picture.high);
  auto levels = scene.picture.levels;
  if (levels.empty() && scene.picture.level_count == 0 && scene.picture.drawing == "bands")
    levels = {mean_value(found)};
  if (levels.empty())
    levels = even_levels(given ? Values{scene.picture.low, scene.picture.high} : found,
                         scene.picture.level_count == 0 ? 8 : static_cast<std::size_t>(scene.picture.level_count));
  auto const columns = static_cast<int>(grid.nodes[0]), rows = static_cast<int>(grid.nodes[1]);
  ColourEnds const ends{scene.picture.low, scene.picture.high, factor};
  Canvas canvas = [&, unit = unit, factor = factor] {
    if (scene.picture.drawing == "contours")
      return draw_contours(grid, found, levels, along(0), along(1), what.label, unit, scene.title(), ends);
    if (scene.picture.drawing == "bands")
      return draw_bands(columns, rows, found, levels, along(0), along(1), what.label, unit, scene.title(), factor);
    return draw_field(columns, rows, found, along(0), along(1), what.label, unit, scene.fitting_map(found),
                      scene.title(), ends);
  }();
  if (D == 3)
    canvas.note(fmt::format("slice at {} = {}", "xyz"[normal], scene.context.units.text(at, dimensions::length, 4)));
  return canvas;
}

}  // namespace boltzmann::pictures
