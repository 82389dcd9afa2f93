// Reads [[diagnoses]] and [output]: what is measured, written and drawn.
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/heat_flux.hpp>
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/diagnoses/shock.hpp>
#include <boltzmann/diagnoses/slab.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/simulation/picture.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace boltzmann {
namespace {

std::vector<std::string> column_names(Reading const& reading) {
  std::vector<std::string> names;
  for (auto const& diagnosis : reading.result->diagnoses)
    for (auto const& column : diagnosis->columns()) names.push_back(column.name);
  return names;
}

/// The axes that the box has; all three if it is not known.
std::vector<std::string> axis_names(Reading const& reading) {
  std::vector<std::string> names{"x", "y", "z"};
  if (reading.dimension > 0) names.resize(static_cast<std::size_t>(reading.dimension));
  return names;
}

bool all_loaded(Reading const& reading) {
  return !reading.ensembles.empty() && std::all_of(reading.ensembles.begin(), reading.ensembles.end(),
                                                   [](ReadEnsemble const& e) { return e.particles != nullptr; });
}

/// How far the particles of a field are spread; 0: not told. A mistake if they have more images between walls than one.
double read_range_of_weight(Section& section, Reading& reading) {
  double const range = section.quantity("range", dimensions::length, positive).value_or(0);
  for (int a = 0; reading.box && a < reading.dimension; ++a)
    if (reading.box->boundary(a) == Boundary::mirror && range > reading.box->length(a)) {
      reading.mistake(section.place("range"), fmt::format("range: {:.6g} is longer than mirror axis {} of the box, "
                                                          "which allows at most {:.6g}",
                                                          range, "xyz"[a], reading.box->length(a)));
      return 0;
    }
  return range;
}

void read_diagnosis(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[diagnoses]]", reading.context);
  std::vector<std::string> names;
  for (auto const& kind : diagnosis_kinds()) names.push_back(kind.name);
  Item const* word = section.need("kind", "kind = \"energies\"");
  auto const name = word ? read_word(*word, "diagnosis", names, reading.context) : std::nullopt;
  if (!name) return;
  section.rename(fmt::format("[[diagnoses]] '{}'", *name));
  auto const& kind = *std::find_if(diagnosis_kinds().begin(), diagnosis_kinds().end(),
                                   [&](DiagnosisKind const& k) { return k.name == *name; });
  auto const has = [&](char const* option) {
    return std::find(kind.options.begin(), kind.options.end(), option) != kind.options.end();
  };
  DiagnosisParameters parameters;
  ReadEnsemble const* one = reading.ensembles.size() == 1 ? &reading.ensembles.front() : nullptr;
  if (has("ensembles"))
    if (Item const* item = section.find("ensembles")) {
      auto const texts = read_texts(*item, "ensembles", reading.context);
      if (texts.size() == (item->is(Item::Kind::array) ? item->elements.size() : 1))
        for (std::size_t k = 0; k < texts.size(); ++k) {
          auto const* named = reading.ensemble(item->is(Item::Kind::array) ? item->elements[k] : *item, "ensembles");
          if (!named) continue;
          one = texts.size() == 1 ? named : nullptr;
          parameters.ensembles.push_back(named->name);
        }
    }
  if (has("label")) parameters.label = section.text("label").value_or("");
  if (has("particles")) {
    auto const which = read_particles(section, one ? one->particles : nullptr, reading);
    if (which) parameters.particles = *which;
    if (which && !one)
      reading.mistake(section.place("particles"),
                      "particles: numbers are those of one ensemble; add ensembles = [\"...\"]");
  }
  if (has("similar_velocity") && reading.dimension > 0)
    if (auto const v = section.vector("similar_velocity", reading.dimension, dimensions::velocity)) {
      parameters.similar_velocity.emplace();
      std::copy(v->begin(), v->end(), parameters.similar_velocity->begin());
    }
  if (has("tolerance"))
    parameters.tolerance = section.quantity("tolerance", dimensions::velocity, not_negative).value_or(0);
  if (has("subtract_drift")) parameters.subtract_drift = section.boolean("subtract_drift");
  if (has("about_centre_of_mass")) parameters.about_centre_of_mass = section.boolean("about_centre_of_mass");
  if (has("mode")) {
    if (Item const* item = section.need("mode", "mode = [3]")) {
      std::vector<Item> const one{*item};
      for (Item const& element : item->is(Item::Kind::array) ? item->elements : one)
        if (auto const n = read_integer(element, "mode", -1'000'000'000, 1'000'000'000, reading.context))
          parameters.mode.push_back(static_cast<int>(*n));
    }
  }
  if (has("axis")) parameters.axis = section.word("axis", axis_names(reading)).value_or("");
  if (has("conductivity") && reading.dimension > 0) {
    Dimension const conductivity = dimensions::energy / (dimensions::time * dimensions::temperature) /
                                   pow(dimensions::length, reading.dimension - 2);
    if (Item const* item = section.need("conductivity", "conductivity = 0.1"))
      parameters.conductivity =
          read_quantity(*item, "conductivity", conductivity, reading.context, positive).value_or(0);
  }
  if (has("weight"))
    if (auto const weight = section.word("weight", weight_names())) parameters.weight = weight_named(*weight);
  if (has("range")) parameters.range = read_range_of_weight(section, reading);
  if (has("gamma"))
    parameters.gamma =
        section.quantity("gamma", dimensions::none, {1, std::numeric_limits<double>::infinity(), true}).value_or(0);
  if (has("since")) parameters.since = section.quantity("since", dimensions::time).value_or(0);
  if (has("from")) parameters.from = section.quantity("from", dimensions::length).value_or(parameters.from);
  if (has("to")) parameters.to = section.quantity("to", dimensions::length).value_or(parameters.to);
  if (has("count")) parameters.count = static_cast<std::size_t>(section.integer("count", 1, 100'000).value_or(0));
  if (has("end")) parameters.end = section.word("end", {"low", "high"}).value_or("");
  if (has("margin")) parameters.margin = section.quantity("margin", dimensions::length, positive).value_or(0);
  if (has("near")) parameters.near = section.quantity("near", dimensions::length, positive).value_or(0);
  if (has("far")) parameters.far = section.quantity("far", dimensions::length, positive).value_or(parameters.far);
  if (has("modes")) parameters.modes = static_cast<std::size_t>(section.integer("modes", 1).value_or(0));
  if (has("quantity") && kind.of_mesh) parameters.quantity = section.text("quantity").value_or("");
  if (*name == "shock") parameters.quantity = section.word("quantity", {"velocity", "density"}).value_or("");
  if (*name == "extremes") {
    Item const* item = section.need("quantity", "quantity = \"speed\"");
    parameters.quantity = item ? read_text(*item, "quantity", reading.context).value_or("") : "";
  }
  section.finish();
  if (reading.context.mistakes.count() != before || !all_loaded(reading)) return;
  for (auto const& ensemble : reading.ensembles) parameters.available.push_back(ensemble.particles);
  Place place = section.has("quantity") ? section.place("quantity") : word->place;
  if (kind.of_mesh) {
    if (!find_mesh_fields(reading, word->place, fmt::format("diagnosis '{}'", *name))) {
      reading.diagnoses_known = false;
      return;
    }
    parameters.mesh_fields = reading.mesh.fields;
    if (section.has("quantity") &&
        !guarded(reading, place, [&] { mesh_quantity(parameters.mesh_fields, parameters.quantity); }))
      return;
    place = section.has("mode") ? section.place("mode") : section.has("axis") ? section.place("axis") : word->place;
  }
  guarded(reading, place, [&] {
    auto diagnosis = make_diagnosis(*name, parameters);
    if (*name == "heat-flux" && reading.box)
      temperature_difference(*reading.box, parameters.axis.empty() ? reading.dimension - 1 : parameters.axis[0] - 'x');
    if (auto const* slab = dynamic_cast<Slab const*>(diagnosis.get()); slab && reading.box)
      slab_members(parameters.available, *reading.box, slab->options());
    if (auto const* shock = dynamic_cast<Shock const*>(diagnosis.get()); shock && reading.box)
      shock->check(parameters.available, *reading.box, reading.boltzmann_constant());
    auto const taken = column_names(reading);
    for (auto const& column : diagnosis->columns())
      if (std::find(taken.begin(), taken.end(), column.name) != taken.end())
        throw Error(fmt::format("diagnosis '{}': there is a column '{}' already; names must differ{}", *name,
                                column.name, has("label") ? " (give a label)" : ""));
    reading.result->diagnoses.push_back(std::move(diagnosis));
  });
}

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

/// The ends of the colours: quantities of that dimension.
void read_ends(Section& section, PicturePlan& plan, Dimension dimension) {
  if (auto const low = section.quantity("low", dimension)) plan.low = *low;
  if (auto const high = section.quantity("high", dimension)) plan.high = *high;
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

/// What a run records for pictures to show.
struct Recorded {
  bool trajectory, diagnoses;
};

/// What colours and sizes of particles show.
void read_particle_style(Section& section, PicturePlan& plan, Reading& reading, Recorded recorded) {
  plan.colour = section.text("colour").value_or("");
  plan.size = section.text("size").value_or("");
  plan.trace = section.boolean("trace");
  if (plan.trace && !recorded.trajectory)
    reading.mistake(section.place("trace"),
                    "trace: tracks are those of the trajectory; add e.g. trajectory = 10 to [output]");
  Dimension colour_dimension = dimensions::none;
  for (auto const& ensemble : reading.ensembles)
    if (ensemble.particles)
      for (auto const& quantity : quantities(*ensemble.particles))
        if (quantity.name == plan.colour) colour_dimension = quantity.dimension;
  for (char const* key : {"low", "high"})
    if (section.has(key) && plan.colour.empty())
      reading.mistake(section.place(key),
                      fmt::format("{}: an end of the colours, but the picture has no 'colour'", key));
  read_ends(section, plan, colour_dimension);
}

/// What a field of the particles is measured in: the density of Eq 4, or a quantity.
Dimension dimension_of(std::string const& name, Reading const& reading) {
  for (auto const& ensemble : reading.ensembles) {
    if (!ensemble.particles) continue;
    Dimension const volume = pow(dimensions::length, std::max(reading.dimension, 1));
    if (name.empty() || name == "density")
      return (ensemble.particles->find_field("mass") ? dimensions::mass : dimensions::none) / volume;
    for (auto const& quantity : quantities(*ensemble.particles))
      if (quantity.name == name) return quantity.dimension;
  }
  return dimensions::none;
}

/// How many levels there are, or which.
void read_levels(Section& section, PicturePlan& plan, Dimension dimension, Reading& reading) {
  Item const* item = section.find("levels");
  if (!item) return;
  if (!item->is(Item::Kind::array)) {
    plan.level_count = static_cast<int>(read_integer(*item, "levels", 1, 1000, reading.context).value_or(0));
    return;
  }
  if (item->elements.empty()) reading.mistake(item->place, "levels: an array without any; leave it out, or give some");
  for (auto const& element : item->elements)
    if (auto const level = read_quantity(element, "levels", dimension, reading.context)) {
      if (!plan.levels.empty() && *level <= plan.levels.back())
        reading.mistake(element.place,
                        fmt::format("levels: {} must be above {}, the one before", *level, plan.levels.back()));
      plan.levels.push_back(*level);
    }
}

/// A field of the particles: a map, contours or bands.
void read_smooth_field(Section& section, PicturePlan& plan, Reading& reading) {
  Dimension const dimension = dimension_of(plan.y, reading);
  read_slice(section, plan, reading);
  if (plan.drawing != "bands") read_ends(section, plan, dimension);
  if (plan.drawing != "map") read_levels(section, plan, dimension, reading);
  if (plan.drawing != "map" && reading.dimension == 1)
    reading.mistake(section.place("drawing"),
                    fmt::format("drawing: '{}' are drawn in 2D and 3D; in 1D 'map' draws a curve", plan.drawing));
  if (auto const weight = section.word("weight", weight_names())) plan.weight = weight_named(*weight);
  plan.range = read_range_of_weight(section, reading);
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

void read_picture(Item const& table, Reading& reading, Recorded recorded) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[output.pictures]]", reading.context);
  Picture picture;
  PicturePlan plan;
  plan.drawing = "cartesian";
  if (Item const* item = section.find("drawing")) {
    auto const drawing = read_word(*item, "drawing", drawing_names(), reading.context);
    if (!drawing) return;
    plan.drawing = *drawing;
    section.rename(fmt::format("[[output.pictures]] '{}'", plan.drawing));
  }
  bool const of_particles = plan.drawing == "map" || plan.drawing == "contours" || plan.drawing == "bands";
  bool const on_mesh = plan.drawing == "mesh" || plan.drawing == "wave-spectrum" || of_particles;
  if (!on_mesh) plan.x = section.text("x").value_or("");
  plan.y = section.text("y").value_or("");
  if (!on_mesh && plan.drawing != "time-series" && plan.drawing != "profile")
    read_particle_style(section, plan, reading, recorded);
  if (auto const file = section.text("file")) plan.file = *file;
  if (plan.drawing == "mesh") {
    read_slice(section, plan, reading);
    Dimension dimension = dimensions::none;
    if ((section.has("low") || section.has("high")) &&
        find_mesh_fields(reading, section.place("drawing"), "a picture of the mesh"))
      for (auto const* field : reading.mesh.fields)
        if ((plan.y.empty() ? "potential" : plan.y).starts_with(field->name)) dimension = field->dimension;
    read_ends(section, plan, dimension);
  }
  if (of_particles) read_smooth_field(section, plan, reading);
  if (plan.drawing == "wave-spectrum") read_curves(section, plan, reading);
  if (plan.drawing == "profile") read_profile(section, plan, reading);
  if (plan.drawing == "time-series") plan.logarithmic = section.boolean("logarithmic");
  bool const of_diagnoses = plan.drawing == "time-series" || plan.drawing == "wave-spectrum" ||
                            (plan.drawing == "spectrum" && plan.x == "time");
  if (of_diagnoses && !recorded.diagnoses)
    reading.mistake(section.place("drawing"), fmt::format("a picture '{}' shows what diagnoses have recorded, but "
                                                          "diagnoses = 0 in [output]: none",
                                                          plan.drawing));
  section.finish();
  for (auto const& other : reading.result->output.pictures)
    if (other.file == plan.file)
      reading.mistake(section.place("file"),
                      fmt::format("file: there is a picture '{}' already; names must differ", plan.file));
  if (reading.context.mistakes.count() == before && all_loaded(reading)) {
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
    plain.file = plan.file;
    check_as("file", plain);
    bool const known =
        (reading.diagnoses_known || !of_diagnoses) &&
        (plan.drawing != "mesh" || find_mesh_fields(reading, section.place("drawing"), "a picture of the mesh"));
    picture.drawing = plan.drawing;
    picture.x = plan.x;
    if (plan.drawing == "phase-space" || plan.drawing == "profile" || (plan.drawing == "spectrum" && plan.x != "time"))
      check_as("x", picture);
    if (reading.context.mistakes.count() == before && known) {
      picture.y = plan.y;
      guarded(reading, section.has("y") ? section.place("y") : table.place, [&] {
        PictureSources sources;
        if (plan.drawing == "mesh") sources.mesh_fields = reading.mesh.fields;
        for (auto const& diagnosis : reading.result->diagnoses) sources.diagnoses.push_back(diagnosis.get());
        check(picture, ensembles, column_names(reading), sources);
      });
    }
  }
  reading.result->output.pictures.push_back(plan);
}

}  // namespace

void read_diagnoses(Section& document, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  for (Item const* table : find_tables(document, "diagnoses")) read_diagnosis(*table, reading);
  if (reading.context.mistakes.count() != before) reading.diagnoses_known = false;
}

void read_output(Section& document, Item& resolved, Reading& reading) {
  Item const* table = find_table(document, "output");
  OutputPlan& plan = reading.result->output;
  if (table) {
    Section section(*table, "[output]", reading.context);
    auto const diagnoses = section.integer("diagnoses", 0);
    plan.diagnoses = diagnoses.value_or(0);
    auto const trajectory = section.integer("trajectory", 0);
    plan.trajectory = trajectory.value_or(0);
    plan.mesh = section.integer("mesh", 0).value_or(0);
    if (plan.mesh > 0) find_mesh_fields(reading, section.place("mesh"), "mesh: a series of frames");
    plan.checkpoint = section.integer("checkpoint", 0).value_or(0);
    // What could not be read has been told of.
    Recorded const recorded{plan.trajectory > 0 || (section.has("trajectory") && !trajectory), diagnoses != 0};
    for (Item const* picture : find_tables(section, "pictures")) read_picture(*picture, reading, recorded);
    section.finish();
  }
  bool const has_interval = table && table->find("diagnoses");
  if (!has_interval && document.has("diagnoses")) {
    plan.diagnoses = std::max<std::int64_t>(1, reading.run.steps / 200);
    set_default(resolved, "output", "diagnoses", Item::of_integer(plan.diagnoses));
  }
}

}  // namespace boltzmann
