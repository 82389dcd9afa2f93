// Reads [[output.pictures]] and [[views]]: the drawings.
#include <boltzmann/core/toml_text.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <optional>

namespace boltzmann {
namespace {

std::vector<AnyEnsemble*> particles_of(Reading const& reading) {
  std::vector<AnyEnsemble*> all;
  for (auto const& ensemble : reading.ensembles)
    if (ensemble.particles) all.push_back(ensemble.particles);
  return all;
}

/// An invalid mesh has already left a mistake.
bool mesh_known(Section const& section, PicturePlan const& plan, Reading& reading) {
  return plan.drawing != "mesh" || find_mesh_fields(reading, section.place("drawing"), "a picture of the mesh");
}

PictureSources sources_of(PicturePlan const& plan, Reading const& reading) {
  PictureSources sources;
  if (reading.base_known) sources.units = &reading.context.units;
  if (plan.drawing == "mesh") sources.mesh_fields = reading.mesh.fields;
  for (auto const& diagnosis : reading.result->diagnoses) sources.diagnoses.push_back(diagnosis.get());
  return sources;
}

bool of_diagnoses(PicturePlan const& plan) {
  return plan.drawing == "time-series" || plan.drawing == "wave-spectrum" || plan.drawing == "curves" ||
         (plan.drawing == "spectrum" && plan.x == "time");
}

/// Further checks of the keys of a scenario's picture.
void check_keys(Section& section, PicturePlan const& plan, Reading& reading) {
  auto const mistake = [&](char const* key, std::string const& what) { section.mistake(key, what); };
  check_picture_keys(section, plan, reading.dimension, reading.box ? &*reading.box : nullptr);
  if (plan.trace && !reading.recorded.trajectory)
    mistake("trace", "tracks are those of the trajectory; add e.g. trajectory = 10 to [output]");
  if ((plan.drawing == "contours" || plan.drawing == "bands") && reading.dimension == 1)
    mistake("drawing", fmt::format("'{}' are drawn in 2D and 3D; in 1D 'map' draws a curve", plan.drawing));
  if (of_diagnoses(plan) && !reading.recorded.diagnoses)
    mistake("drawing", fmt::format("a picture '{}' shows what diagnoses have recorded, but diagnoses = 0 in [output]: "
                                   "none",
                                   plan.drawing));
}

/// The drawing: all keys that pictures and views share. False, and a mistake, if the drawing is unknown.
bool read_plan(Section& section, PicturePlan& plan, std::string const& title, Reading& reading) {
  plan.drawing = section.has("x") || section.has("y") ? "phase-space" : "cartesian";
  if (Item const* item = section.find("drawing")) {
    auto const drawing = read_word(*item, "drawing", drawing_names(), reading.context);
    if (!drawing) return false;
    plan.drawing = *drawing;
  }
  if (section.has("drawing") || !title.empty())
    section.rename(title.empty() ? fmt::format("[[output.pictures]] '{}'", plan.drawing) : title);
  Drawing const& drawing = drawing_named(plan.drawing);
  section.explain_word("drawing", drawing.doc, drawing_names(), toml_text(plan.drawing));
  bool const of_ends = section.has("low") || section.has("high") || section.has("levels");
  bool const known = all_loaded(reading) && (!of_ends || mesh_known(section, plan, reading));
  read_options(section, drawing.options, static_cast<Picture*>(&plan),
               {reading.dimension, [&]() -> std::optional<Dimension> {
                  if (!known) return std::nullopt;
                  return shown_dimension(plan, particles_of(reading), sources_of(plan, reading));
                }});
  check_keys(section, plan, reading);
  return true;
}

/// Checks that it can be drawn of these ensembles and diagnoses.
void check_plan(Section const& section, PicturePlan const& plan, Reading& reading) {
  bool const known = (reading.diagnoses_known || !of_diagnoses(plan)) && mesh_known(section, plan, reading);
  check(plan, particles_of(reading), column_names(reading), sources_of(plan, reading),
        [&](std::string const& key, std::string const& what) {
          if (key == "y" && !known) return;
          reading.mistake(section.place(key), what);
        });
}

void read_view(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[views]]", reading.context);
  PicturePlan plan;
  if (Item const* item = section.need("name", "name = \"Kinetic\""))
    if (auto const name = read_text(*item, "name", reading.context)) {
      plan.name = *name;
      if (name->empty()) reading.mistake(item->place, "name: a view needs a name, not an empty text");
      for (auto const& other : reading.result->views)
        if (other.name == *name && !name->empty())
          reading.mistake(item->place, fmt::format("name: there is a view '{}' already; names must differ", *name));
    }
  if (!read_plan(section, plan, plan.name.empty() ? "[[views]]" : fmt::format("[[views]] '{}'", plan.name), reading))
    return;
  section.finish();
  if (reading.context.mistakes.count() == before && all_loaded(reading)) check_plan(section, plan, reading);
  reading.result->views.push_back(plan);
}

}  // namespace

void check_picture_keys(Section& section, Picture const& picture, int dimension, Box const* box) {
  bool const of_particles = picture.drawing == "cartesian" || picture.drawing == "phase-space";
  for (char const* key : {"low", "high"})
    if (of_particles && picture.colour.empty())
      section.refuse(key, "an end of the colours, but the picture has no 'colour'");
  if (dimension == 1 || dimension == 2)
    for (char const* key : {"slice", "at"})
      section.refuse(key, fmt::format("slices are of fields in 3D; in {}D the whole is shown", dimension));
  if (!box) return;
  int const axis = picture.slice[0] - 'x';
  if (section.has("at") && dimension == 3 && (picture.at < box->low(axis) || picture.at > box->high(axis)))
    section.mistake("at", fmt::format("{} is outside the box, which goes from {} to {} along {}", picture.at,
                                      box->low(axis), box->high(axis), picture.slice));
  if (section.has("range")) check_range_of_weight(section, picture.smoothing.range, *box);
}

void read_picture(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[output.pictures]]", reading.context);
  PicturePlan plan;
  if (!read_plan(section, plan, "", reading)) return;
  read_options(section, picture_options().only({{"file"}}), static_cast<Picture*>(&plan), {});
  section.finish();
  for (auto const& other : reading.result->output.pictures)
    if (other.file == plan.file)
      reading.mistake(section.place("file"),
                      fmt::format("file: there is a picture '{}' already; names must differ", plan.file));
  if (reading.context.mistakes.count() == before && all_loaded(reading)) check_plan(section, plan, reading);
  if (plan.trace) reading.track_places.push_back(section.place("trace"));
  reading.result->output.pictures.push_back(plan);
}

void read_views(Section& document, Reading& reading) {
  for (Item const* table : find_tables(document, "views")) read_view(*table, reading);
}

}  // namespace boltzmann
