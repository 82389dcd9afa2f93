// Particles in space: clouds, connections, arrows and tracks.
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/pictures/drawing_cartesian.hpp>
#include <boltzmann/pictures/picture_scene.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann::pictures {
namespace {

using Sides = std::array<std::array<double, 2>, 3>;
constexpr std::size_t max_arrows = 2000;

std::string coordinate(int axis) { return std::string("position.") + "xyz"[axis]; }

// The diameter of each ensemble's particles: the given one, else the largest of the others, else one that fits between
// the particles.
std::vector<double> diameters(Scene const& scene) {
  double common = 0;
  std::size_t count = 0;
  for (auto const* ensemble : scene.ensembles) {
    common = std::max(common, ensemble->appearance.diameter);
    count += ensemble->size();
  }
  if (common == 0 && count > 0)
    common = 0.5 * std::pow(scene.box().volume() / static_cast<double>(count), 1.0 / scene.box().dimension());
  std::vector<double> all;
  for (auto const* ensemble : scene.ensembles)
    all.push_back(ensemble->appearance.diameter > 0 ? ensemble->appearance.diameter : common);
  return all;
}

ParticleClouds clouds_of(Scene& scene) {
  int const D = scene.box().dimension();
  bool const sized =
      !scene.picture.size.empty() || std::any_of(scene.ensembles.begin(), scene.ensembles.end(),
                                                 [](AnyEnsemble const* e) { return e->appearance.diameter > 0; });
  auto const diameter = diameters(scene);
  std::vector<CloudSource> sources;
  for (std::size_t e = 0; e < scene.ensembles.size(); ++e) {
    sources.push_back({scene.ensembles[e], scene.colour(e), sized ? diameter[e] : 0, {}});
    for (int a = 0; a < D; ++a) sources[e].place.push_back(column_of(*scene.ensembles[e], coordinate(a)));
  }
  auto const give = [&](std::string const& name, std::optional<ParticleColumn> CloudSource::*column) {
    if (name.empty()) return;
    auto all = scene.columns(name);
    for (std::size_t e = 0; e < all.size(); ++e) sources[e].*column = std::move(all[e]);
  };
  give(scene.picture.colour, &CloudSource::value);
  give(scene.picture.size, &CloudSource::size);
  CloudOptions options = cloud_options(scene);
  for (int a = 0; a < D; ++a) {
    options.origin[static_cast<std::size_t>(a)] = scene.box().low(a);
    options.scale[static_cast<std::size_t>(a)] = scene.box().length(a);
  }
  ParticleClouds clouds = particle_clouds(sources, options);
  for (auto& cloud : clouds.clouds) {
    cloud.shaded = D == 3;
    cloud.size = fitting_point(clouds.shown);
  }
  return clouds;
}

/// Removes the particles of a cloud: only lines are drawn.
void hide(Canvas::Cloud& cloud) {
  cloud.position.clear(), cloud.value.clear(), cloud.diameter.clear(), cloud.number.clear();
}

std::uint32_t number_of(Canvas::Cloud const& cloud, std::size_t k) {
  return cloud.number.empty() ? static_cast<std::uint32_t>(k) : cloud.number[k];
}

void draw_bonds(Canvas& canvas, Scene const& scene, CartesianStyle const& style) {
  int const D = scene.box().dimension();
  auto const& region = scene.picture.region;
  auto const is_inside = [&](double const* row) {
    for (std::size_t a = 0; a < region.size() && a < static_cast<std::size_t>(D); ++a)
      if (!(row[a] >= region[a][0] && row[a] <= region[a][1])) return false;
    return true;
  };
  for (auto const* scheme : scene.context.simulation.schemes())
    if (auto const* pairs = dynamic_cast<PairScheme const*>(scheme))
      for (auto const& bond : pairs->bonds()) {
        double const *i = bond.ensemble->row(bond.i), *j = bond.ensemble->row(bond.j);
        if (!is_inside(i) && !is_inside(j)) continue;
        Place3 from{}, to{};
        std::copy_n(i, D, from.begin());
        std::copy_n(j, D, to.begin());
        draw_connection(canvas, from, to, style);
      }
}

bool has_bonds(Scene const& scene) {
  auto const& schemes = scene.context.simulation.schemes();
  return std::any_of(schemes.begin(), schemes.end(), [](Scheme const* scheme) {
    auto const* pairs = dynamic_cast<PairScheme const*>(scheme);
    return pairs && !pairs->bonds().empty();
  });
}

// A vector of particles: an influence, or a field. Null if the class has none of that name.
struct VectorColumn {
  double const* first = nullptr;
  std::size_t stride = 0;
};
VectorColumn vector_of(AnyEnsemble const& ensemble, std::string const& name) {
  if (ensemble.size() == 0) return {};
  if (name == "velocity" && has_velocities(ensemble)) {
    auto const velocities = velocities_of(ensemble);
    return {velocities.first, velocities.stride};
  }
  if (name == "influence" && ensemble.influence_size() >= static_cast<std::size_t>(ensemble.dimension()))
    return {ensemble.influence(0), ensemble.influence_size()};
  Field const* field = ensemble.find_field(name);
  if (field && field->components == ensemble.dimension()) return {ensemble.row(0) + field->offset, ensemble.stride()};
  return {};
}

// Draws arrows at the drawn particles.
void draw_vectors(Canvas& canvas, Scene& scene, std::vector<std::array<double, 2>> const& shown) {
  std::string const& name = scene.picture.vectors;
  int const D = scene.box().dimension();
  scene.need(name);
  std::vector<VectorColumn> vectors;
  std::size_t candidates = 0;
  for (std::size_t e = 0; e < scene.ensembles.size(); ++e) {
    vectors.push_back(vector_of(*scene.ensembles[e], name));
    if (vectors[e].first) candidates += canvas.clouds()[e].count();
  }
  std::size_t const every = std::max<std::size_t>((candidates + max_arrows - 1) / max_arrows, 1);
  std::vector<PlacedVector> arrows;
  for (std::size_t e = 0; e < scene.ensembles.size(); ++e) {
    auto const& cloud = canvas.clouds()[e];
    for (std::size_t k = 0; k < cloud.count() && vectors[e].first; k += every) {
      std::size_t const i = number_of(cloud, k);
      PlacedVector arrow{};
      std::copy_n(scene.ensembles[e]->row(i), D, arrow.place.begin());
      std::copy_n(vectors[e].first + i * vectors[e].stride, D, arrow.vector.begin());
      arrows.push_back(arrow);
    }
  }
  if (arrows.empty()) return;
  double volume = 1;
  for (std::size_t a = 0; a < static_cast<std::size_t>(D); ++a) {
    auto side = shown[a];
    if (a < scene.picture.region.size())
      side = {std::max(side[0], scene.picture.region[a][0]), std::min(side[1], scene.picture.region[a][1])};
    volume *= std::max(side[1] - side[0], 0.0);
  }
  // Fewer arrows than particles are longer.
  double const distance = std::pow(volume / static_cast<double>(arrows.size()), 1.0 / D);
  auto const unit = scene.shown_in(meaning(scene.ensembles, name + ".x").dimension);
  draw_arrows(canvas, arrows, distance, unit.factor, unit.unit);
  if (every > 1) canvas.note(fmt::format("1 of {} particles has an arrow", every));
}

// The path of one particle through all frames.
struct Track {
  std::size_t ensemble, particle;
  std::array<Values, 3> position;
};

// A particle that crosses a periodic wall leaves a gap in its track.
void extend(Track& track, double const* place, Box const& box) {
  int const D = box.dimension();
  bool jump = false;
  for (int a = 0; a < D; ++a)
    if (box.periodic(a) && !track.position[a].empty())
      jump = jump || std::abs(place[a] - track.position[a].back()) > box.length(a) / 2;
  for (int a = 0; a < D; ++a) {
    if (jump) track.position[a].push_back(no_value);
    track.position[a].push_back(place[a]);
  }
}

// True if a particle is so fast that its wall crossings between frames are ambiguous.
bool is_lost(std::vector<double> const& velocities, double time, Box const& box) {
  auto const D = static_cast<std::size_t>(box.dimension());
  for (std::size_t k = 0; k < velocities.size(); ++k)
    if (auto const a = static_cast<int>(k % D); box.periodic(a) && std::abs(velocities[k] * time) > box.length(a) / 2)
      return true;
  return false;
}

std::vector<Track> read_tracks(Scene const& scene, bool& lost) {
  TrajectoryReader const reader(scene.context.folder + "/trajectory.h5");
  std::vector<Track> all;
  auto const D = static_cast<std::size_t>(scene.box().dimension());
  for (std::size_t e = 0; e < scene.ensembles.size(); ++e) {
    std::size_t const first = all.size();
    for (std::size_t f = 0; f < reader.frames(); ++f) {
      if (reader.steps()[f] > scene.context.step) break;
      auto const frame = reader.read(f, scene.ensembles[e]->name(), "position");
      bool const last = f + 1 == reader.frames() || reader.steps()[f + 1] > scene.context.step;
      double const until = last ? scene.context.time : reader.times()[f + 1];
      if (Field const* velocity = scene.ensembles[e]->find_field("velocity");
          !lost && velocity != nullptr && velocity->components == scene.box().dimension())
        lost = is_lost(reader.read(f, scene.ensembles[e]->name(), "velocity"), until - reader.times()[f], scene.box());
      std::size_t const count = frame.size() / D;
      while (all.size() < first + count) all.push_back({e, all.size() - first, {}});
      for (std::size_t i = 0; i < count; ++i) extend(all[first + i], &frame[i * D], scene.box());
    }
    for (std::size_t i = 0; i < scene.ensembles[e]->size() && first + i < all.size(); ++i)
      extend(all[first + i], scene.ensembles[e]->row(i), scene.box());
  }
  return all;
}

// The extent of particles and their tracks, on open axes.
Sides reach_of(Scene const& scene, std::vector<Track> const& tracks) {
  Sides reach = scene.open_reach();
  for (auto const& track : tracks)
    for (std::size_t a = 0; a < 3; ++a)
      for (double const x : track.position[a])
        if (std::isfinite(x)) reach[a] = {std::min(reach[a][0], x), std::max(reach[a][1], x)};
  return reach;
}

void note_far_ones(Canvas& canvas, Scene const& scene, Sides const& reach,
                   std::vector<std::array<double, 2>> const& shown) {
  std::size_t const D = shown.size();
  bool any = false;
  for (std::size_t a = 0; a < D; ++a) any = any || reach[a][0] < shown[a][0] || reach[a][1] > shown[a][1];
  if (!any) return;
  std::size_t outside = 0;
  for (auto const* ensemble : scene.ensembles)
    for (std::size_t i = 0; i < ensemble->size(); ++i) {
      double const* x = ensemble->row(i);
      bool far = false;
      for (std::size_t a = 0; a < D; ++a) far = far || x[a] < shown[a][0] || x[a] > shown[a][1];
      outside += far;
    }
  if (outside > 0)
    canvas.note(fmt::format("{} {} far outside the box", outside, outside == 1 ? "particle is" : "particles are"));
}

using ShownBox = std::vector<std::array<double, 2>>;

CartesianStyle style_of(Scene const& scene, ShownBox const& shown) {
  CartesianStyle style;
  style.title = scene.title();
  auto const length = scene.shown_in(dimensions::length);
  style.unit = length.unit;
  style.unit_factor = length.factor;
  int const D = scene.box().dimension();
  for (int a = 0; a < D; ++a) {
    if (D == 2)
      style.box.push_back({scene.box().low(a), scene.box().high(a)});
    else
      style.box.push_back(shown[static_cast<std::size_t>(a)]);
    style.periodic[static_cast<std::size_t>(a)] = scene.box().periodic(a);
  }
  for (std::size_t e = 0; e < scene.ensembles.size(); ++e) {
    if (scene.ensembles.size() > 1) style.species_names.push_back(scene.ensembles[e]->name());
    style.species_colours.push_back(scene.colour(e));
  }
  return style;
}

/// A plane shows a small margin around the particles.
Canvas start_canvas(CartesianStyle const& style, Scene const& scene, ShownBox const& shown) {
  if (scene.box().dimension() == 3) return start_cartesian(style, &scene.picture.projection);
  Canvas canvas = start_cartesian(style, nullptr);
  Axis axes[2] = {canvas.x_axis(), canvas.y_axis()};
  for (std::size_t a = 0; a < 2; ++a) {
    double const margin = 0.03 * (shown[a][1] - shown[a][0]);
    axes[a].low = shown[a][0] - margin;
    axes[a].high = shown[a][1] + margin;
  }
  canvas.axes(axes[0], axes[1]);
  return canvas;
}

}  // namespace

void check_vectors(std::string const& vectors, std::vector<AnyEnsemble*> const& ensembles) {
  if (vectors.empty()) return;
  auto const names = vector_names(ensembles);
  if (std::find(names.begin(), names.end(), vectors) == names.end())
    throw Error("there is no vector '" + vectors + "' to draw arrows of" +
                (names.empty() ? "; these particles have none" : choices(vectors, names)));
}

void check_particles(Question const& question) {
  question.known("colour", question.picture.colour);
  question.known("size", question.picture.size);
  question.on("streaklines", [&] { check_streaklines(question.picture, question.ensembles); });
  question.on("vectors", [&] { check_vectors(question.picture.vectors, question.ensembles); });
}

std::optional<Dimension> dimension_of_colour(Question const& question) {
  if (question.picture.colour.empty()) return dimensions::none;
  return question.dimension(question.picture.colour);
}

Canvas draw_particles(Scene& scene) {
  int const D = scene.box().dimension();
  if (D == 1) return draw_phase_space(scene, "position.x", scene.picture.colour);
  check_vectors(scene.picture.vectors, scene.ensembles);
  check_streaklines(scene.picture, scene.ensembles);
  ParticleClouds clouds = clouds_of(scene);
  std::vector<Track> tracks;
  bool lost = false;
  if (scene.picture.trace) tracks = read_tracks(scene, lost);
  Sides const reach = reach_of(scene, tracks);
  auto const shown = scene.shown_box(reach);

  CartesianStyle const style = style_of(scene, shown);
  Canvas canvas = start_canvas(style, scene, shown);
  bool const with_bonds = clouds.stride == 1;  // otherwise most connected particles would not be drawn
  if (with_bonds) draw_bonds(canvas, scene, style);
  if (scene.picture.colour.empty())
    explain_colours(canvas, style, 0, 0, false);
  else
    explain_values(canvas, scene, clouds);
  if (scene.picture.streaklines) {
    draw_streaklines(canvas, scene, shown);
    for (std::size_t e = 0; e < clouds.clouds.size(); ++e)
      if (is_dye(*scene.ensembles[e]) && scene.picture.colour.empty()) hide(clouds.clouds[e]);
  }
  for (auto& cloud : clouds.clouds) canvas.cloud(std::move(cloud), 0);
  canvas.not_finite(canvas.not_finite() + clouds.not_finite);
  if (!scene.picture.vectors.empty()) draw_vectors(canvas, scene, shown);
  for (auto const& track : tracks) {
    Canvas::Curve curve{track.position[0], track.position[1], 1.4F, scene.track_colour(track.ensemble, track.particle)};
    if (D == 3) curve.z = track.position[2];
    canvas.curve(std::move(curve));
  }
  if (lost) canvas.note("tracks: some go further than half the box from frame to frame; store more of them");
  note_shown(canvas, clouds, !scene.picture.region.empty());
  if (!with_bonds && has_bonds(scene)) canvas.note("connections are not shown");
  note_far_ones(canvas, scene, reach, shown);
  return canvas;
}

}  // namespace boltzmann::pictures
