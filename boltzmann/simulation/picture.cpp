// Which drawing is meant, and whether it can be drawn.
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/simulation/picture_scene.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

using namespace pictures;

void check_drawing(Picture const& picture) {
  auto const& names = drawing_names();
  if (std::find(names.begin(), names.end(), picture.drawing) == names.end())
    throw Error("unknown drawing '" + picture.drawing + "'; there are " + join(names) +
                did_you_mean(picture.drawing, names));
  if (!std::isfinite(picture.projection.azimuth) || !std::isfinite(picture.projection.elevation))
    throw Error("azimuth and elevation of a projection are finite angles");
}

}  // namespace

std::vector<std::string> const& drawing_names() {
  static std::vector<std::string> const names{"cartesian",   "phase-space", "histogram", "spectrum",
                                              "time-series", "profile",     "mesh",      "wave-spectrum",
                                              "map",         "contours",    "bands"};
  return names;
}

std::vector<std::string> vector_names(std::vector<AnyEnsemble*> const& ensembles) {
  std::vector<std::string> names;
  auto const add = [&](std::string const& name) {
    if (std::find(names.begin(), names.end(), name) == names.end()) names.push_back(name);
  };
  for (auto const* ensemble : ensembles) {
    if (ensemble->dimension() == 1) continue;
    if (has_velocities(*ensemble)) add("velocity");
    if (ensemble->influence_size() >= static_cast<std::size_t>(ensemble->dimension())) add("influence");
    for (auto const& field : ensemble->fields())
      if (field.components == ensemble->dimension() && field.name != "position") add(field.name);
  }
  return names;
}

void check_tracks(Simulation const& simulation) {
  if (!simulation.adaptations().empty())
    throw Error("a picture with tracks needs particles that keep their numbers; here some come and go between steps");
}

Canvas draw(Picture const& picture, PictureContext const& context) {
  check_drawing(picture);
  if (picture.trace) check_tracks(context.simulation);
  Scene scene(picture, context);
  if (picture.drawing == "cartesian") return draw_particles(scene);
  if (picture.drawing == "phase-space") return draw_phase_space(scene, picture.x, picture.y);
  if (picture.drawing == "histogram") return draw_histogram(scene);
  if (picture.drawing == "spectrum")
    return picture.x == "time" ? draw_spectrum_in_time(scene) : draw_spectrum_in_space(scene);
  if (picture.drawing == "profile") return draw_profiles(scene);
  if (picture.drawing == "mesh") return draw_mesh(scene);
  if (picture.drawing == "wave-spectrum") return draw_wave_spectrum(scene);
  if (of_smooth_field(picture)) return draw_smooth_field(scene);
  return draw_time_series(scene);
}

void check(Picture const& picture, std::vector<AnyEnsemble*> const& ensembles, std::vector<std::string> const& columns,
           PictureSources const& sources) {
  check_drawing(picture);
  auto const dot = picture.file.rfind('.');
  std::string const extension = dot == std::string::npos ? "" : picture.file.substr(dot);
  if (extension != ".png" && extension != ".svg" && extension != ".pdf")
    throw Error("the picture '" + picture.file + "' ends in none of .png, .svg, .pdf");
  if (picture.file.find('/') != std::string::npos)
    throw Error("the picture '" + picture.file + "' is a name in the run's folder, without '/'");
  auto const known = [&](std::string const& name) {
    if (!name.empty()) meaning(ensembles, name);
  };
  known(picture.colour);
  known(picture.size);
  check_vectors(picture, ensembles);
  if (picture.drawing == "phase-space") known(picture.x), known(picture.y);
  if (picture.drawing == "histogram") {
    if (!ensembles.empty()) known(histogram_quantity(picture, ensembles));
    if (picture.cells < 1 || picture.cells > 100'000)
      throw Error(fmt::format("a histogram has 1 to 100000 bins, not {}", picture.cells));
  }
  if (picture.drawing == "profile" && !ensembles.empty()) check_profile(picture, ensembles.front()->dimension());
  if (picture.drawing == "spectrum" && picture.x != "time") {
    if (!picture.x.empty()) check_spectrum_axis(picture.x);
    known(picture.x), known(picture.y);
  }
  if (picture.drawing == "mesh") mesh_quantity(sources.mesh_fields, mesh_name(picture));
  if ((picture.drawing == "mesh" || of_smooth_field(picture)) && picture.slice != "x" && picture.slice != "y" &&
      picture.slice != "z")
    throw Error("a slice is normal to x, y or z, not '" + picture.slice + "'");
  if (of_smooth_field(picture)) check_smooth_field(picture, ensembles);
  if (picture.drawing == "wave-spectrum") check_waves(picture, sources.diagnoses);
  if (picture.drawing == "time-series" || (picture.drawing == "spectrum" && picture.x == "time")) {
    if (columns.empty()) throw Error("a picture over time needs diagnoses, and none are recorded");
    for (auto const& word : split(picture.y))
      if (std::find(columns.begin(), columns.end(), word) == columns.end())
        throw Error("no diagnosis gives a column '" + word + "'; there are " + some_of(columns) +
                    did_you_mean(word, columns));
  }
}

}  // namespace boltzmann
