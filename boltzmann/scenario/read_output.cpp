// Reads [[diagnoses]] and [output]: what is measured and written.
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/heat_flux.hpp>
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/diagnoses/shock.hpp>
#include <boltzmann/diagnoses/slab.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/stop_condition.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <utility>

namespace boltzmann {

std::vector<std::string> column_names(Reading const& reading) {
  std::vector<std::string> names;
  for (auto const& diagnosis : reading.result->diagnoses)
    for (auto const& column : diagnosis->columns()) names.push_back(column.name);
  return names;
}

std::vector<std::string> axis_names(Reading const& reading) {
  std::vector<std::string> names{"x", "y", "z"};
  if (reading.dimension > 0) names.resize(static_cast<std::size_t>(reading.dimension));
  return names;
}

bool all_loaded(Reading const& reading) {
  return !reading.ensembles.empty() && std::all_of(reading.ensembles.begin(), reading.ensembles.end(),
                                                   [](ReadEnsemble const& e) { return e.particles != nullptr; });
}

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

namespace {

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
    reading.diagnosis_places.push_back(table.place);
  });
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
  Recorded& recorded = reading.recorded;
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
    recorded = {plan.trajectory > 0 || (section.has("trajectory") && !trajectory), diagnoses != 0};
    for (Item const* picture : find_tables(section, "pictures")) read_picture(*picture, reading);
    section.finish();
  }
  bool const has_interval = table && table->find("diagnoses");
  if (!has_interval && document.has("diagnoses")) {
    plan.diagnoses = std::max<std::int64_t>(1, reading.run.steps / 200);
    set_default(resolved, "output", "diagnoses", Item::of_integer(plan.diagnoses));
  }
}

void read_stop(Reading& reading) {
  if (!reading.run.stop) return;
  Item const& item = *reading.run.stop;
  if (reading.context.recorder) reading.context.recorder->plain(item, "text");
  if (!item.is(Item::Kind::text))
    return reading.mistake(
        item.place, fmt::format("stop: a condition in quotes is needed, e.g. \"time > 5\", not {}", found(item)));
  if (!reading.diagnoses_known || !all_loaded(reading) || !reading.base_known) return;
  std::vector<Column> columns;
  for (auto const& diagnosis : reading.result->diagnoses)
    for (auto& column : diagnosis->columns()) columns.push_back(std::move(column));
  if (columns.empty() || reading.result->output.diagnoses == 0)
    return reading.mistake(
        item.place, columns.empty() ? "stop: it looks at the columns of diagnoses, and there are no [[diagnoses]]"
                                    : "stop: it looks at each row of diagnoses.csv, and diagnoses = 0 in "
                                      "[output] asks for none");
  try {
    reading.result->stop_when = stop_condition(item.text, columns, reading.result->base);
    reading.result->stop = item.text;
  } catch (FormulaError const& error) {
    formula_mistake(item, "stop", error, reading);
  }
}

}  // namespace boltzmann
