// Reads [[diagnoses]] and [output]: measurements and output files.
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>
#include <boltzmann/diagnoses/formula_diagnosis.hpp>
#include <boltzmann/diagnoses/heat_flux.hpp>
#include <boltzmann/diagnoses/profile.hpp>
#include <boltzmann/diagnoses/shock.hpp>
#include <boltzmann/diagnoses/slab.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/stop_condition.hpp>
#include <boltzmann/scenario/tables.hpp>

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

bool all_loaded(Reading const& reading) {
  return !reading.ensembles.empty() && std::all_of(reading.ensembles.begin(), reading.ensembles.end(),
                                                   [](ReadEnsemble const& e) { return e.particles != nullptr; });
}

void check_range_of_weight(Section& section, double range, Box const& box) {
  for (int a = 0; a < box.dimension(); ++a)
    if (box.boundary(a) == Boundary::mirror && range > box.length(a))
      return section.mistake(
          "range", fmt::format("{:.6g} is longer than mirror axis {} of the box, which allows at most {:.6g}", range,
                               "xyz"[a], box.length(a)));
}

namespace {

std::vector<Column> columns_of(ScenarioSimulation const& scenario) {
  std::vector<Column> columns;
  for (auto const& diagnosis : scenario.diagnoses)
    for (auto& column : diagnosis->columns()) columns.push_back(std::move(column));
  return columns;
}

/// The ensemble that is named, or the only one.
ReadEnsemble const* one_ensemble(DiagnosisParameters const& parameters, Reading const& reading) {
  for (auto const& ensemble : reading.ensembles)
    if (parameters.ensembles.empty() ? reading.ensembles.size() == 1
                                     : parameters.ensembles == std::vector<std::string>{ensemble.name})
      return &ensemble;
  return nullptr;
}

/// The selected particles in it.
void read_group(Section& section, DiagnosisParameters& parameters, Reading& reading) {
  ReadEnsemble const* one = one_ensemble(parameters, reading);
  bool const parts = section.has("where") && section.has("formula");
  auto const which = read_particles(section, one ? one->particles : nullptr, reading, parts);
  if (which) parameters.particles = *which;
  if (which && which->empty())
    reading.mistake(section.place(section.has("where") ? "where" : "particles"), "the group has no particle");
  if (which && !one)
    reading.mistake(section.place("particles"),
                    "particles: numbers are those of one ensemble; add ensembles = [\"...\"]");
}

/// The particles on the other side of pairs.
void read_partners(Section& section, DiagnosisParameters& parameters, Reading& reading) {
  Item const* item = section.find("partners");
  if (!item) return;
  ReadEnsemble const* one = one_ensemble(parameters, reading);
  if (!one) return reading.mistake(item->place, "partners: they are those of one ensemble; add ensembles = [\"...\"]");
  auto const which = read_chosen(*item, "partners", one->particles, reading);
  if (which) parameters.partners = *which;
  if (which && which->empty()) reading.mistake(item->place, "partners: there is no such particle");
}

/// Null, and a mistake, if the kind is unknown.
DiagnosisKind const* read_kind(Section& section, Reading& reading) {
  std::vector<std::string> names;
  for (auto const& kind : diagnosis_kinds()) names.push_back(kind.name);
  Item const* word = section.need("kind", "kind = \"energies\"");
  auto const name = word ? read_word(*word, "diagnosis", names, reading.context) : std::nullopt;
  if (!name) return nullptr;
  section.rename(fmt::format("[[diagnoses]] '{}'", *name));
  auto const& kind = *std::find_if(diagnosis_kinds().begin(), diagnosis_kinds().end(),
                                   [&](DiagnosisKind const& k) { return k.name == *name; });
  section.explain_word("kind", kind.doc);
  return &kind;
}

bool is_typed(DiagnosisKind const& kind) { return kind.options.find("formula") != nullptr; }

/// The parameters in its table.
DiagnosisParameters read_parameters_of(DiagnosisKind const& kind, Section& section, Reading& reading) {
  DiagnosisParameters parameters;
  parameters.units = reading.context.units;
  if (is_typed(kind)) {
    parameters.formula_parameters = read_formula_parameters(section, reading);
    parameters.formula_parts = read_formula_parts(section, reading);
  }
  // The dimension for a histogram, after everything else has been read.
  auto const shown = [&]() -> std::optional<Dimension> {
    if (!all_loaded(reading) || !is_typed(kind)) return std::nullopt;
    auto known = parameters;
    for (auto const& ensemble : reading.ensembles) known.available.push_back(ensemble.particles);
    try {
      return dimension_of_formula(known);
    } catch (FormulaError const&) {
      return std::nullopt;  // which the diagnosis reports
    }
  };
  read_options(section, kind.options, &parameters,
               {reading.dimension, shown, [&](Option const& option, OptionPlace const& place) {
                  if (option.kind.form == OptionKind::Form::ensembles)
                    for (auto const& one : named_ensembles(section.find(option.key), option.key, reading))
                      std::get<std::vector<std::string>*>(place)->push_back(one.ensemble->name);
                  else if (option.key == "partners")
                    read_partners(section, parameters, reading);
                  else
                    read_group(section, parameters, reading);
                }});
  if (section.has("range") && reading.box) check_range_of_weight(section, parameters.range, *reading.box);
  section.finish();
  return parameters;
}

/// Sets the mesh fields of a diagnosis. False, and a mistake, if there is no mesh.
bool take_mesh_fields(DiagnosisKind const& kind, DiagnosisParameters& parameters, Section& section, Reading& reading) {
  if (!find_mesh_fields(reading, section.place("kind"), fmt::format("diagnosis '{}'", kind.name))) {
    reading.diagnoses_known = false;
    return false;
  }
  parameters.mesh_fields = reading.mesh.fields;
  return !section.has("quantity") || catch_errors(reading, section.place("quantity"),
                                                  [&] { mesh_quantity(parameters.mesh_fields, parameters.quantity); });
}

/// Throws Error if it is not possible for these particles, in this box, with these diagnoses.
std::unique_ptr<Diagnosis> make_checked(DiagnosisKind const& kind, DiagnosisParameters& parameters,
                                        Reading const& reading) {
  std::vector<Scheme*> schemes;
  for (auto const& scheme : reading.result->schemes) schemes.push_back(scheme.get());
  if (kind.of_flow) find_vortices(parameters, schemes);
  parameters.columns_before = columns_of(*reading.result);
  auto diagnosis = make_diagnosis(kind.name, parameters);
  if (reading.box && reading.shear_is_right) diagnosis->check(*reading.box);
  if (kind.name == "heat-flux" && reading.box)
    temperature_difference(*reading.box, parameters.axis.empty() ? reading.dimension - 1 : parameters.axis[0] - 'x');
  if (auto const* slab = dynamic_cast<Slab const*>(diagnosis.get()); slab && reading.box)
    slab_members(parameters.available, *reading.box, slab->options());
  if (auto const* shock = dynamic_cast<Shock const*>(diagnosis.get()); shock && reading.box)
    shock->check(parameters.available, *reading.box, reading.boltzmann_constant());
  auto const taken = column_names(reading);
  for (auto const& column : diagnosis->columns())
    if (std::find(taken.begin(), taken.end(), column.name) != taken.end())
      throw Error(fmt::format("diagnosis '{}': there is a column '{}' already; names must differ{}", kind.name,
                              column.name, kind.options.find("label") ? " (give a label)" : ""));
  return diagnosis;
}

/// The place of the key that an error names.
Place place_of_error(DiagnosisKind const& kind, Section& section) {
  if (kind.of_mesh)
    for (char const* key : {"mode", "axis"})
      if (section.has(key)) return section.place(key);
  return section.place(!kind.of_mesh && section.has("quantity") ? "quantity" : "kind");
}

void read_diagnosis(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[diagnoses]]", reading.context);
  DiagnosisKind const* const kind = read_kind(section, reading);
  if (!kind) return;
  DiagnosisParameters parameters = read_parameters_of(*kind, section, reading);
  bool const units_known = !is_typed(*kind) || reading.base_known;
  if (reading.context.mistakes.count() != before || !all_loaded(reading) || !units_known) return;
  for (auto const& ensemble : reading.ensembles) parameters.available.push_back(ensemble.particles);
  if (kind->of_mesh && !take_mesh_fields(*kind, parameters, section, reading)) return;
  catch_errors(reading, place_of_error(*kind, section), [&] {
    try {
      reading.result->diagnoses.push_back(make_checked(*kind, parameters, reading));
      reading.diagnosis_places.push_back(table.place);
    } catch (FormulaError const& error) {
      reading.diagnoses_known = false;
      auto const* of_part = dynamic_cast<FormulaPartError const*>(&error);
      if (!of_part || !part_mistake(section, *of_part, reading))
        formula_mistake(*section.item("formula"), "formula", error, reading);
    }
  });
}

/// The units of results.
void read_output_units(Item const& item, Reading& reading) {
  if (!item.is(Item::Kind::table))
    return reading.mistake(item.place,
                           fmt::format("units: a table is needed, {{ energy = \"eV\" }}, not {}", describe(item)));
  Section section(item, "units", reading.context);
  for (auto const& one : shown_dimensions()) {
    Item const* unit = section.find(one.first);
    auto const text = unit ? read_text(*unit, one.first, reading.context) : std::nullopt;
    if (!text) continue;
    try {
      reading.result->units.show_in(one.second, *text);
    } catch (Error const& error) {
      reading.mistake(unit->place, fmt::format("{}: {}", one.first, error.what()));
    }
  }
  section.finish();
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
    constexpr std::int64_t not_read = -1;
    OutputOptions options{.diagnoses = not_read, .trajectory = section.has("trajectory") ? not_read : 0};
    read_options(section, output_options(), &options, {.dimension = reading.dimension});
    plan.diagnoses = std::max<std::int64_t>(0, options.diagnoses);
    plan.trajectory = std::max<std::int64_t>(0, options.trajectory);
    plan.checkpoint = options.checkpoint;
    plan.mesh = options.mesh;
    if (plan.mesh > 0) find_mesh_fields(reading, section.place("mesh"), "mesh: a series of frames");
    recorded = {options.trajectory != 0, options.diagnoses != 0};  // reading errors have already been reported
    if (Item const* units = section.find("units")) read_output_units(*units, reading);
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
  if (reading.context.notes) reading.context.notes->plain(item, "text");
  if (!item.is(Item::Kind::text))
    return reading.mistake(
        item.place, fmt::format("stop: a condition in quotes is needed, e.g. \"time > 5\", not {}", describe(item)));
  if (!reading.diagnoses_known || !all_loaded(reading) || !reading.base_known) return;
  std::vector<Column> const columns = columns_of(*reading.result);
  if (columns.empty() || reading.result->output.diagnoses == 0)
    return reading.mistake(item.place,
                           columns.empty()
                               ? "stop: it reads the columns of diagnoses, and there are no [[diagnoses]]"
                               : "stop: it reads each row of diagnoses.csv, but diagnoses = 0 in [output] writes none");
  try {
    reading.result->stop_when = stop_condition(item.text, columns, reading.result->units);
    reading.result->stop = item.text;
  } catch (FormulaError const& error) {
    formula_mistake(item, "stop", error, reading);
  }
}

}  // namespace boltzmann
