// Fields on the nodes of a mesh.
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann::pictures {
namespace {

std::string mesh_name(Picture const& picture) { return picture.y.empty() ? "potential" : picture.y; }

// An axis of a mesh: its nodes are the centres of the cells of a picture.
Axis mesh_axis(Scene const& scene, MeshGrid const& grid, int a) {
  Axis result = scene.axis(std::string(1, "xyz"[a]), dimensions::length);
  result.low = grid.position(a, 0) - 0.5 * grid.spacing[a];
  result.high = grid.position(a, grid.nodes[a] - 1) + 0.5 * grid.spacing[a];
  return result;
}

}  // namespace

void check_mesh(Question const& question) {
  question.on("y", [&] { mesh_quantity(question.sources.mesh_fields, mesh_name(question.picture)); });
  question.need_slice();
}

std::optional<Dimension> dimension_on_mesh(Question const& question) {
  for (auto const* field : question.sources.mesh_fields)
    if (mesh_name(question.picture).starts_with(field->name)) return field->dimension;
  return std::nullopt;
}

Canvas draw_mesh(Scene& scene) {
  MeshQuantity const quantity =
      mesh_quantity(mesh_fields_of(scene.context.simulation.schemes()), mesh_name(scene.picture));
  MeshGrid const& grid = quantity.grid();
  auto const [unit, factor] = scene.shown_in(quantity.dimension());
  if (grid.dimension == 1) {
    Values x;
    for (std::size_t i = 0; i < grid.nodes[0]; ++i) x.push_back(grid.position(0, i));
    Series const curve{"", x, quantity.values()};
    Axis y = scene.axis(quantity.label, quantity.dimension());
    y.low = scene.picture.low, y.high = scene.picture.high;
    return boltzmann::draw_time_series({&curve, 1}, scene.axis("x", dimensions::length), y, scene.title());
  }
  int const normal = grid.dimension == 3 ? scene.picture.slice[0] - 'x' : 2;
  int const right = normal == 0 ? 1 : 0, up = normal == 2 ? 1 : 2;
  double const middle = grid.low[normal] + 0.5 * static_cast<double>(grid.cells(normal)) * grid.spacing[normal];
  double const at = std::isnan(scene.picture.at) ? middle : scene.picture.at;
  double const place = std::round((at - grid.low[normal]) / grid.spacing[normal]);
  auto const slice = grid.dimension == 3
                         ? static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(grid.nodes[normal] - 1)))
                         : 0;
  Values shown;
  for (std::size_t row = 0; row < grid.nodes[up]; ++row)
    for (std::size_t column = 0; column < grid.nodes[right]; ++column) {
      std::array<std::size_t, 3> node{};
      node[right] = column, node[up] = row, node[normal] = slice;
      shown.push_back(quantity.values()[grid.index(node[0], node[1], node[2])]);
    }
  Canvas canvas = draw_field(static_cast<int>(grid.nodes[right]), static_cast<int>(grid.nodes[up]), shown,
                             mesh_axis(scene, grid, right), mesh_axis(scene, grid, up), quantity.label, unit,
                             scene.fitting_map(shown), scene.title(), {scene.picture.low, scene.picture.high, factor});
  if (grid.dimension == 3)
    canvas.note(fmt::format("slice at {} = {}", "xyz"[normal],
                            scene.context.units.text(grid.position(normal, slice), dimensions::length, 4)));
  return canvas;
}

}  // namespace boltzmann::pictures
