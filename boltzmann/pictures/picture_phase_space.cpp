// Two quantities of every particle, one over the other, and their path through all frames.
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/picture_scene.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann::pictures {
namespace {

// The axis of space whose coordinate a quantity is; -1 for all others.
int axis_of(Scene const& scene, std::string const& name) {
  if (!name.starts_with("position")) return -1;
  int const axis = name == "position" ? 0 : name.back() - 'x';
  return axis >= 0 && axis < scene.box().dimension() ? axis : -1;
}

bool through_wall(Scene const& scene, std::string const& name, double way) {
  int const axis = axis_of(scene, name);
  return axis >= 0 && scene.box().periodic(axis) && std::abs(way) > scene.box().length(axis) / 2;
}

// Two quantities of every particle through all frames. The frames are loaded into the ensembles one after the other.
void draw_tracks(Canvas& canvas, Scene& scene, std::string const& x, std::string const& y) {
  TrajectoryReader const reader(scene.context.folder + "/trajectory.h5");
  scene.keep_particles();
  std::vector<std::vector<std::array<Values, 2>>> tracks(scene.ensembles.size());
  auto const extend = [&] {
    scene.forget();
    auto const vx = scene.values(x), vy = scene.values(y);
    for (std::size_t e = 0; e < scene.ensembles.size(); ++e) {
      tracks[e].resize(std::max(tracks[e].size(), vx[e].size()));
      for (std::size_t i = 0; i < vx[e].size(); ++i) {
        auto& [tx, ty] = tracks[e][i];
        bool const jump = !tx.empty() && (through_wall(scene, x, vx[e][i] - tx.back()) ||
                                          through_wall(scene, y, vy[e][i] - ty.back()));
        if (jump) tx.push_back(no_value), ty.push_back(no_value);
        tx.push_back(vx[e][i]);
        ty.push_back(vy[e][i]);
      }
    }
  };
  for (std::size_t f = 0; f < reader.frames() && reader.steps()[f] < scene.context.step; ++f) {
    for (auto* ensemble : scene.ensembles) reader.load(f, *ensemble);
    extend();
  }
  scene.put_particles_back();
  extend();
  for (std::size_t e = 0; e < tracks.size(); ++e)
    for (std::size_t i = 0; i < tracks[e].size(); ++i)
      canvas.curve(tracks[e][i][0], tracks[e][i][1], scene.track_colour(e, i), "", 1.4F);
}

// The origin of stored positions, chosen so that single precision suffices: the low end of the box, or the value of a
// particle.
double origin_of(Scene const& scene, std::string const& name, std::vector<CloudSource> const& sources,
                 std::size_t place) {
  if (int const axis = axis_of(scene, name); axis >= 0) return scene.box().low(axis);
  for (auto const& source : sources)
    if (source.ensemble->size() > 0)
      if (double const v = source.place[place][0]; std::isfinite(v)) return v;
  return 0;
}

// If sizes show a quantity, the diameter of the largest particle as a fraction of the axis.
constexpr double largest_part = 0.018;

double extent_of(std::vector<CloudSource> const& sources, Axis const& axis) {
  double low = axis.low, high = axis.high;
  if (std::isfinite(low) && std::isfinite(high)) return high - low;
  low = std::numeric_limits<double>::infinity(), high = -low;
  for (auto const& source : sources)
    for (std::size_t i = 0; i < source.ensemble->size(); ++i)
      if (double const v = source.place[0][i]; std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  return high > low ? high - low : 1;
}

/// Sets the ends of an axis to those of the region.
void zoom(Axis& axis, std::vector<std::array<double, 2>> const& region, std::size_t number) {
  if (number >= region.size()) return;
  if (std::isfinite(region[number][0])) axis.low = region[number][0];
  if (std::isfinite(region[number][1])) axis.high = region[number][1];
}

}  // namespace

void check_phase_space(Question const& question) {
  check_particles(question);
  question.known("x", question.picture.x);
  question.known("y", question.picture.y);
}

Canvas draw_phase_space(Scene& scene) { return draw_phase_space(scene, scene.picture.x, scene.picture.y); }

Canvas draw_phase_space(Scene& scene, std::string x, std::string y) {
  if (x.empty()) x = "position.x";
  if (y.empty()) y = "velocity.x";
  auto const mx = meaning(scene.ensembles, x), my = meaning(scene.ensembles, y);
  Axis x_axis = scene.axis(mx.label, mx.dimension);
  if (int const a = axis_of(scene, x); a >= 0 && scene.box().periodic(a)) {
    x_axis.low = scene.box().low(a);
    x_axis.high = scene.box().high(a);
  }
  Axis y_axis = scene.axis(my.label, my.dimension);
  zoom(x_axis, scene.picture.region, 0);
  zoom(y_axis, scene.picture.region, 1);
  auto vx = scene.columns(x), vy = scene.columns(y);
  // In one dimension, the colour of particles in space is their second axis.
  bool const in_space = scene.picture.drawing == "cartesian";
  std::string const colour = in_space ? "" : scene.picture.colour, size = in_space ? "" : scene.picture.size;
  std::vector<ParticleColumn> values, sizes;
  if (!colour.empty()) values = scene.columns(colour);
  if (!size.empty()) sizes = scene.columns(size);
  std::vector<CloudSource> sources;
  std::vector<std::string> missing;
  for (std::size_t e = 0; e < scene.ensembles.size(); ++e) {
    auto const* ensemble = scene.ensembles[e];
    if (!vx[e].first && ensemble->size() > 0)
      missing.push_back(ensemble->name() + " has no " + mx.label);
    else if (!vy[e].first && ensemble->size() > 0)
      missing.push_back(ensemble->name() + " has no " + my.label);
    else {
      sources.push_back({ensemble, scene.colour(e), 0, {}});
      sources.back().place.push_back(std::move(vx[e]));
      sources.back().place.push_back(std::move(vy[e]));
      if (!colour.empty()) sources.back().value = std::move(values[e]);
      if (!size.empty()) sources.back().size = std::move(sizes[e]);
    }
  }
  if (!size.empty())
    for (double const largest = largest_part * extent_of(sources, x_axis); auto& source : sources)
      source.diameter = largest;
  CloudOptions options = cloud_options(scene);
  options.origin[0] = origin_of(scene, x, sources, 0);
  options.origin[1] = origin_of(scene, y, sources, 1);
  ParticleClouds clouds = particle_clouds(sources, options);
  Canvas canvas = boltzmann::draw_phase_space(std::move(clouds.clouds), x_axis, y_axis, scene.title());
  canvas.equal_aspect(x.starts_with("position") && y.starts_with("position"));
  if (!colour.empty()) explain_values(canvas, scene, clouds);
  note_shown(canvas, clouds, !options.region.empty());
  for (auto const& line : missing) canvas.note(line);
  if (scene.picture.trace) draw_tracks(canvas, scene, x, y);
  return canvas;
}

}  // namespace boltzmann::pictures
