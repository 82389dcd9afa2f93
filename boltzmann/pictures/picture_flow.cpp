// The flow of vortices: vorticity, velocity and Q as colours, on slices in 3D; streamlines in 2D.
#include <boltzmann/diagnoses/smooth_field.hpp>
#include <boltzmann/diagnoses/vortex_measures.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/picture_scene.hpp>
#include <boltzmann/pictures/streamlines.hpp>
#include <boltzmann/schemes/vortices/vortex_flow.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann::pictures {
namespace {

std::string flow_name(Picture const& picture) { return picture.y.empty() ? "vorticity" : picture.y; }

std::vector<std::string> flow_names(int dimension) {
  if (dimension == 2) return {"vorticity", "speed", "velocity.x", "velocity.y"};
  return {"vorticity", "vorticity.x", "vorticity.y", "vorticity.z", "speed", "velocity.x", "velocity.y", "velocity.z",
          "Q"};
}

Dimension dimension_of_name(std::string const& name) {
  using namespace dimensions;
  if (name == "Q") return frequency * frequency;
  return name.starts_with("vorticity") ? frequency : velocity;
}

/// Extracts a quantity from VortexFlow's values at a place.
double value_of_flow(std::string const& name, int dimension, double const* flow) {
  if (name == "speed") return std::hypot(flow[0], flow[1], dimension == 3 ? flow[2] : 0);
  if (name.starts_with("velocity")) return flow[name.back() - 'x'];
  if (name == "Q") return q_of(flow);
  if (dimension == 2) return flow[2];
  Vector<3> const curl = curl_of(flow);
  return name == "vorticity" ? magnitude(curl) : curl[name.back() - 'x'];
}

void draw_streamlines(Canvas& canvas, MeshGrid const& grid, Values const& u, Values const& v, double separation,
                      bool alone) {
  for (auto const& line : streamlines(grid, u, v, separation)) {
    canvas.curve(line.x, line.y, with_alpha(ink, alone ? 1 : 0.6), "", 1.5F);
    // An arrow in the middle shows the direction.
    std::size_t const half = line.x.size() / 2;
    std::size_t ahead = half;
    while (ahead + 1 < line.x.size() &&
           std::hypot(line.x[ahead] - line.x[half], line.y[ahead] - line.y[half]) < 0.3 * separation)
      ++ahead;
    if (ahead > half) canvas.arrow(line.x[half], line.y[half], line.x[ahead], line.y[ahead], ink, 1.5F);
  }
}

}  // namespace

void check_flow(Question const& question) {
  if (question.ensembles.empty()) return;
  int const dimension = question.ensembles.front()->dimension();
  auto const& picture = question.picture;
  bool const lines = picture.drawing == "streamlines";
  question.on("drawing", [&] {
    if (std::none_of(question.ensembles.begin(), question.ensembles.end(),
                     [](auto const* one) { return has_vorticity(*one); }))
      throw Error("'" + picture.drawing +
                  "' is of vortices, and no ensemble has vorticity; classes Vortex, Inviscid and Viscous do");
    if (lines && dimension == 3) throw Error("'streamlines' are drawn in 2D; in 3D 'flow' draws a slice");
  });
  question.on("streamlines", [&] {
    if (picture.streamlines > 0 && dimension == 3) throw Error("streamlines are drawn in 2D");
  });
  if (!lines)
    question.on("y", [&] {
      auto const names = flow_names(dimension);
      auto const name = flow_name(picture);
      if (std::find(names.begin(), names.end(), name) == names.end())
        throw Error(fmt::format("a flow has no '{}'{}", name, choices(name, names, "it has")));
    });
  question.on("streaklines", [&] {
    check_streaklines(picture, question.ensembles);
    if (picture.streaklines && dimension == 3) throw Error("in 3D 'flow' is a slice; 'cartesian' draws streaklines");
  });
  question.need_slice();
}

std::optional<Dimension> dimension_of_flow(Question const& question) {
  return dimension_of_name(flow_name(question.picture));
}

Canvas draw_flow(Scene& scene) {
  auto const D = static_cast<std::size_t>(scene.box().dimension());
  auto const& schemes = scene.context.simulation.schemes();
  scene.need("influence");  // the effect of bodies is computed with the influences
  VortexFlow const flow(vortex_sources(schemes), scene.box(), scene.threads());
  std::string const name = flow_name(scene.picture);
  auto const shown = scene.shown_box(scene.open_reach());
  int const normal = D == 3 ? scene.picture.slice[0] - 'x' : 2;
  std::array<int, 2> const axes{normal == 0 ? 1 : 0, normal == 2 ? 1 : 2};
  double const at = D == 3 && std::isnan(scene.picture.at) ? 0.5 * (scene.box().low(normal) + scene.box().high(normal))
                                                           : scene.picture.at;
  MeshGrid const grid = picture_grid(scene, shown, axes, false, 200);
  auto const on_plane = points_on_grid(grid);
  Values places;
  for (std::size_t p = 0; p < grid.size(); ++p)
    for (int a = 0; a < static_cast<int>(D); ++a)
      places.push_back(a == normal ? at : on_plane[2 * p + (a == axes[0] ? 0 : 1)]);
  Values found = flow.at(places), stream(places.size(), 0.0);
  for (auto* scheme : schemes) scheme->add_stream(places, scene.context.time, stream);
  std::size_t const width = VortexFlow::width(scene.box().dimension());
  for (std::size_t p = 0; p < grid.size(); ++p)
    for (std::size_t a = 0; a < D; ++a) found[p * width + a] += stream[p * D + a];

  auto const side = [&](std::size_t k) { return shown[static_cast<std::size_t>(axes[k])]; };
  auto const along = [&](std::size_t k) {
    Axis result = scene.axis(std::string(1, "xyz"[axes[k]]), dimensions::length);
    result.low = side(k)[0], result.high = side(k)[1];
    return result;
  };
  bool const lines_only = scene.picture.drawing == "streamlines";
  Canvas canvas;
  if (lines_only) {
    canvas.axes(along(0), along(1));
    canvas.equal_aspect(true);
    canvas.title(scene.title());
  } else {
    Values values;
    for (std::size_t p = 0; p < grid.size(); ++p)
      values.push_back(value_of_flow(name, static_cast<int>(D), found.data() + p * width));
    auto const [unit, factor] = scene.shown_in(dimension_of_name(name));
    bool const both_signs = name != "speed" && (D == 2 || name != "vorticity");
    canvas = draw_field(static_cast<int>(grid.nodes[0]), static_cast<int>(grid.nodes[1]), values, along(0), along(1),
                        name, unit, both_signs ? ColourMap::diverging : ColourMap::viridis, scene.title(),
                        {scene.picture.low, scene.picture.high, factor});
  }
  int const count = scene.picture.streamlines > 0 ? scene.picture.streamlines : lines_only ? 25 : 0;
  if (count > 0 && D == 2) {
    Values u, v;
    for (std::size_t p = 0; p < grid.size(); ++p) u.push_back(found[p * width]), v.push_back(found[p * width + 1]);
    double const longest = std::max(side(0)[1] - side(0)[0], side(1)[1] - side(1)[0]);
    draw_streamlines(canvas, grid, u, v, longest / count, lines_only);
  }
  if (scene.picture.streaklines && D == 2) {
    check_streaklines(scene.picture, scene.ensembles);
    draw_streaklines(canvas, scene, shown);
  }
  if (D == 3)
    canvas.note(fmt::format("slice at {} = {}", "xyz"[normal], scene.context.units.text(at, dimensions::length, 4)));
  return canvas;
}

}  // namespace boltzmann::pictures
