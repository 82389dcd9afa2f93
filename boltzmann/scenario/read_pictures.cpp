// Reads [[output.pictures]] and [[views]]: what is drawn.
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/simulation/picture.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>

namespace boltzmann {
namespace {

/// curve = { frequency = ..., speed = ... }, or an array of such.
void read_curves(Section& section, PicturePlan& plan, Reading& reading) {
  Item const* item = section.find("curve");
  if (!item) return;
  std::vector<Item> const one{*item};
  for (Item const& element : item->is(Item::Kind::array) ? item->elements : one) {
    if (!element.is(Item::Kind::table)) {
      reading.mistake(element.place,
                      fmt::format("curve: a table is needed, {{ frequency = 1, speed = 0 }}, not {}", found(element)));
      continue;
    }
    Section curve(element, "curve", reading.context);
    auto const frequency = curve.quantity("frequency", dimensions::frequency, not_negative);
    auto const speed = curve.quantity("speed", dimensions::velocity, not_negative);
    if (element.entries.empty())
      reading.mistake(element.place,
                      "curve: it has neither 'frequency' nor 'speed'; omega^2 = frequency^2 + speed^2 k^2");
    curve.finish();
    plan.curves.push_back({frequency.value_or(0), speed.value_or(0)});
  }
}

/// The ends of the colours: quantities of that dimension. Nothing: it is not known, since particles could not be
/// loaded.
void read_ends(Section& section, PicturePlan& plan, std::optional<Dimension> dimension) {
  for (auto const& [key, end] : {std::pair("low", &plan.low), std::pair("high", &plan.high)}) {
    if (!dimension)
      section.allow(key);
    else if (auto const value = section.quantity(key, *dimension))
      *end = *value;
  }
}

/// The part of a field in 3D that is shown.
void read_slice(Section& section, PicturePlan& plan, Reading& reading) {
  if (reading.dimension == 1 || reading.dimension == 2) {
    for (char const* key : {"slice", "at"})
      if (section.find(key))
        reading.mistake(section.place(key), fmt::format("{}: slices are of fields in 3D; in {}D the whole is shown",
                                                        key, reading.dimension));
    return;
  }
  plan.slice = section.word("slice", axis_names(reading)).value_or("z");
  auto const at = section.quantity("at", dimensions::length);
  if (!at) return;
  plan.at = *at;
  int const axis = plan.slice[0] - 'x';
  if (reading.box && reading.dimension == 3 && (*at < reading.box->low(axis) || *at > reading.box->high(axis)))
    reading.mistake(section.place("at"), fmt::format("at: {} is outside the box, which goes from {} to {} along {}",
                                                     *at, reading.box->low(axis), reading.box->high(axis), plan.slice));
}

/// What colours and sizes of particles show.
void read_particle_style(Section& section, PicturePlan& plan, Reading& reading) {
  plan.colour = section.text("colour").value_or("");
  plan.size = section.text("size").value_or("");
  if (plan.drawing == "cartesian") plan.vectors = section.text("vectors").value_or("");
  plan.trace = section.boolean("trace");
  if (plan.trace && !reading.recorded.trajectory)
    reading.mistake(section.place("trace"),
                    "trace: tracks are those of the trajectory; add e.g. trajectory = 10 to [output]");
  std::optional<Dimension> colour_dimension;
  if (plan.colour.empty()) colour_dimension = dimensions::none;
  for (auto const& ensemble : reading.ensembles)
    if (ensemble.particles)
      for (auto const& quantity : quantities(*ensemble.particles))
        if (quantity.name == plan.colour) colour_dimension = quantity.dimension;
  for (char const* key : {"low", "high"})
    if (section.has(key) && plan.colour.empty())
      reading.mistake(section.place(key),
                      fmt::format("{}: an end of the colours, but the picture has no 'colour'", key));
  read_ends(section, plan, all_loaded(reading) ? colour_dimension : std::nullopt);
}

/// What a field of the particles is measured in: the density of Eq 4, or a quantity. Nothing if there is no such
/// quantity, or particles could not be loaded.
std::optional<Dimension> dimension_of(std::string const& name, Reading const& reading) {
  if (!all_loaded(reading)) return std::nullopt;
  for (auto const& ensemble : reading.ensembles) {
    if (!ensemble.particles) continue;
    Dimension const volume = pow(dimensions::length, std::max(reading.dimension, 1));
    if (name.empty() || name == "density")
      return (ensemble.particles->find_field("mass") ? dimensions::mass : dimensions::none) / volume;
    for (auto const& quantity : quantities(*ensemble.particles))
      if (quantity.name == name) return quantity.dimension;
  }
  return std::nullopt;
}

/// How many levels there are, or which.
void read_levels(Section& section, PicturePlan& plan, std::optional<Dimension> dimension, Reading& reading) {
  Item const* item = section.find("levels");
  if (!item) return;
  if (!item->is(Item::Kind::array)) {
    plan.level_count = static_cast<int>(read_integer(*item, "levels", 1, 1000, reading.context).value_or(0));
    return;
  }
  if (item->elements.empty()) reading.mistake(item->place, "levels: an array without any; leave it out, or give some");
  for (auto const& element : item->elements)
    if (!dimension)
      break;
    else if (auto const level = read_quantity(element, "levels", *dimension, reading.context)) {
      if (!plan.levels.empty() && *level <= plan.levels.back())
        reading.mistake(element.place,
                        fmt::format("levels: {} must be above {}, the one before", *level, plan.levels.back()));
      plan.levels.push_back(*level);
    }
}

/// A field of the particles: a map, contours or bands.
void read_smooth_field(Section& section, PicturePlan& plan, Reading& reading) {
  auto const dimension = dimension_of(plan.y, reading);
  read_slice(section, plan, reading);
  if (plan.drawing != "bands") read_ends(section, plan, dimension);
  if (plan.drawing != "map") read_levels(section, plan, dimension, reading);
  if (plan.drawing != "map" && reading.dimension == 1)
    reading.mistake(section.place("drawing"),
                    fmt::format("drawing: '{}' are drawn in 2D and 3D; in 1D 'map' draws a curve", plan.drawing));
  if (auto const weight = section.word("weight", weight_names())) plan.smoothing.shape = weight_named(*weight);
  plan.smoothing.range = read_range_of_weight(section, reading);
  if (auto const cells = section.integer("cells", 2, 4000)) plan.cells = static_cast<int>(*cells);
}

/// Bins along an axis.
void read_profile(Section& section, PicturePlan& plan, Reading& reading) {
  plan.logarithmic = section.boolean("logarithmic");
  if (auto const cells = section.integer("cells", 1, 100'000)) plan.cells = static_cast<int>(*cells);
  Dimension dimension = dimensions::none;
  auto const first = plan.y.substr(0, plan.y.find(','));
  for (auto const& quantity : profile_quantities(std::max(reading.dimension, 1)))
    if (quantity.name == (first.empty() ? "density" : first)) dimension = quantity.dimension;
  read_ends(section, plan, dimension);
}

/// A histogram: x, cells.
void read_histogram(Section& section, PicturePlan& plan) {
  plan.logarithmic = section.boolean("logarithmic");
  if (auto const cells = section.integer("cells", 1, 100'000)) plan.cells = static_cast<int>(*cells);
}

bool of_diagnoses(PicturePlan const& plan) {
  return plan.drawing == "time-series" || plan.drawing == "wave-spectrum" ||
         (plan.drawing == "spectrum" && plan.x == "time");
}

/// What is drawn: all keys that pictures and views share. plan.drawing is what is drawn without the key. False, and a
/// mistake, if nobody knows which drawing is meant.
bool read_plan(Section& section, PicturePlan& plan, std::string const& title, Reading& reading) {
  if (Item const* item = section.find("drawing")) {
    auto const drawing = read_word(*item, "drawing", drawing_names(), reading.context);
    if (!drawing) return false;
    plan.drawing = *drawing;
  }
  if (section.has("drawing") || !title.empty())
    section.rename(title.empty() ? fmt::format("[[output.pictures]] '{}'", plan.drawing) : title);
  bool const of_particles = plan.drawing == "map" || plan.drawing == "contours" || plan.drawing == "bands";
  bool const on_mesh = plan.drawing == "mesh" || plan.drawing == "wave-spectrum" || of_particles;
  bool const histogram = plan.drawing == "histogram";
  if (!on_mesh) plan.x = section.text("x").value_or("");
  if (!histogram) plan.y = section.text("y").value_or("");
  if (!on_mesh && !histogram && plan.drawing != "time-series" && plan.drawing != "profile")
    read_particle_style(section, plan, reading);
  if (plan.drawing == "mesh") {
    read_slice(section, plan, reading);
    std::optional<Dimension> dimension;
    if ((section.has("low") || section.has("high")) &&
        find_mesh_fields(reading, section.place("drawing"), "a picture of the mesh"))
      for (auto const* field : reading.mesh.fields)
        if ((plan.y.empty() ? "potential" : plan.y).starts_with(field->name)) dimension = field->dimension;
    read_ends(section, plan, dimension);
  }
  if (of_particles) read_smooth_field(section, plan, reading);
  if (plan.drawing == "wave-spectrum") read_curves(section, plan, reading);
  if (plan.drawing == "profile") read_profile(section, plan, reading);
  if (histogram) read_histogram(section, plan);
  if (plan.drawing == "time-series") plan.logarithmic = section.boolean("logarithmic");
  if (of_diagnoses(plan) && !reading.recorded.diagnoses)
    reading.mistake(section.place("drawing"), fmt::format("a picture '{}' shows what diagnoses have recorded, but "
                                                          "diagnoses = 0 in [output]: none",
                                                          plan.drawing));
  return true;
}

/// Whether that can be drawn of these ensembles and diagnoses.
void check_plan(Section const& section, PicturePlan const& plan, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  std::vector<AnyEnsemble*> ensembles;
  for (auto const& ensemble : reading.ensembles) ensembles.push_back(ensemble.particles);
  auto const check_as = [&](std::string_view key, Picture const& partial) {
    if (!section.has(key)) return;
    guarded(reading, section.place(key), [&] { check(partial, ensembles, column_names(reading), {}); });
  };
  Picture plain;
  plain.colour = plan.colour;
  check_as("colour", plain);
  plain.colour.clear();
  plain.size = plan.size;
  check_as("size", plain);
  plain.size.clear();
  plain.vectors = plan.vectors;
  check_as("vectors", plain);
  plain.vectors.clear();
  plain.file = plan.file;
  check_as("file", plain);
  bool const known =
      (reading.diagnoses_known || !of_diagnoses(plan)) &&
      (plan.drawing != "mesh" || find_mesh_fields(reading, section.place("drawing"), "a picture of the mesh"));
  Picture picture;
  picture.drawing = plan.drawing;
  picture.x = plan.x;
  if (plan.drawing == "phase-space" || plan.drawing == "profile" || plan.drawing == "histogram" ||
      (plan.drawing == "spectrum" && plan.x != "time"))
    check_as("x", picture);
  if (reading.context.mistakes.count() != before || !known) return;
  picture.y = plan.y;
  guarded(reading, section.place(section.has("y") || plan.drawing != "histogram" ? "y" : "x"), [&] {
    PictureSources sources;
    if (plan.drawing == "mesh") sources.mesh_fields = reading.mesh.fields;
    for (auto const& diagnosis : reading.result->diagnoses) sources.diagnoses.push_back(diagnosis.get());
    check(picture, ensembles, column_names(reading), sources);
  });
}

void read_view(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[views]]", reading.context);
  PicturePlan plan;
  plan.drawing = section.has("x") || section.has("y") ? "phase-space" : "cartesian";
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

void read_picture(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[output.pictures]]", reading.context);
  PicturePlan plan;
  plan.drawing = "cartesian";
  if (!read_plan(section, plan, "", reading)) return;
  if (auto const file = section.text("file")) plan.file = *file;
  section.finish();
  for (auto const& other : reading.result->output.pictures)
    if (other.file == plan.file)
      reading.mistake(section.place("file"),
                      fmt::format("file: there is a picture '{}' already; names must differ", plan.file));
  if (reading.context.mistakes.count() == before && all_loaded(reading)) check_plan(section, plan, reading);
  reading.result->output.pictures.push_back(plan);
}

void read_views(Section& document, Reading& reading) {
  for (Item const* table : find_tables(document, "views")) read_view(*table, reading);
}

}  // namespace boltzmann
