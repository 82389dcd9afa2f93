// bzm list and bzm show: what there is, from the tables that the program itself works with.
#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/bzm/commands.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/dissipation/dissipation_options.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/neighbours/neighbour_list.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/load_options.hpp>
#include <boltzmann/scenario/materials.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/scenario/schema.hpp>
#include <boltzmann/scenario/tables.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <sstream>

namespace boltzmann::bzm {
namespace {

// One name of a list and its line.
struct Named {
  std::string name, doc;
};

std::string title_line(std::string const& scenario) {
  std::istringstream text(read_text(scenario_folder() + "/" + scenario + ".toml"));
  for (std::string line; std::getline(text, line);) {
    if (!line.starts_with("title")) continue;
    auto const from = line.find('"'), to = line.rfind('"');
    if (from < to && to != std::string::npos) return line.substr(from + 1, to - from - 1);
  }
  return "";
}

std::vector<Named> scenarios() {
  std::vector<Named> all;
  for (auto const& name : shipped_scenarios()) all.push_back({name, title_line(name)});
  return all;
}
/// Those of a catalogue whose entries have a name and a doc.
template <auto catalogue>
std::vector<Named> of() {
  std::vector<Named> all;
  for (auto const& one : catalogue()) all.push_back({std::string(one.name), std::string(one.doc)});
  return all;
}
/// "an energy", "a mass".
std::string one(std::string const& noun) {
  return (std::string_view("aeiou").find(noun.empty() ? 'x' : noun[0]) != std::string_view::npos ? "an " : "a ") + noun;
}
std::vector<Named> unit_list() {
  std::vector<Named> all;
  for (auto const& unit : unit_table()) {
    std::string const symbols(unit.symbols), words(unit.words);
    std::string const& names = symbols.empty() ? words : symbols;
    all.push_back({names.substr(0, names.find(' ')),
                   fmt::format("{} = {:.10g} SI, {}{}", words.empty() ? symbols : words, unit.si,
                               one(name_of(unit.dimension)), unit.prefixes ? "; takes metric prefixes" : "")});
  }
  return all;
}

/// Tables of a scenario of which each is of one of several kinds, which have the keys.
struct TableOfKinds {
  char const *name, *heading, *doc, *key;
  std::vector<Named> (*kinds)();
};
constexpr TableOfKinds tables_of_kinds[] = {
    {"dissipation", "[[dissipation]]", "friction and noise between the steps", "kind", of<dissipation_kinds>},
    {"diagnoses", "[[diagnoses]]", "what is measured, as columns of diagnoses.csv", "kind", of<diagnosis_kinds>},
    {"output.pictures", "[[output.pictures]]", "a picture of the last state, as a file", "drawing", of<drawings>},
    {"views", "[[views]]", "a drawing that the window's page offers, by its `name`", "drawing", of<drawings>}};

std::vector<Named> table_list() {
  auto all = of<scenario_tables>();
  for (auto const& table : tables_of_kinds) all.push_back({table.name, table.doc});
  return all;
}

/// Words that keys may be.
struct KeyWords {
  char const* what;
  std::vector<Named> (*words)();
};
constexpr KeyWords key_words[] = {{"integrator", of<method_words>},
                                  {"boundary", of<boundary_words>},
                                  {"convention of dpd", of<convention_words>},
                                  {"method of dpd", of<dissipation_method_words>},
                                  {"lattice", of<lattice_words>}};

struct Section {
  char const* name;
  std::vector<Named> (*entries)();
};
constexpr Section sections[] = {{"scenarios", scenarios},
                                {"classes", of<particle_classes>},
                                {"laws", of<scenario_laws>},
                                {"materials", of<material_catalogue>},
                                {"integrators", of<method_words>},
                                {"dissipations", of<dissipation_kinds>},
                                {"loaders", of<load_kinds>},
                                {"tables", table_list},
                                {"diagnoses", of<diagnosis_kinds>},
                                {"drawings", of<drawings>},
                                {"units", unit_list}};

void show_scenario(std::string const& name) {
  std::string const path = find_scenario(name);
  auto const scenario = load_scenario(path);
  fmt::print("scenario {}{}{}\n", scenario->name, scenario->title.empty() ? "" : ": ", scenario->title);
  if (!scenario->description.empty()) fmt::print("\n{}\n", scenario->description);
  fmt::print("\n  file        {}\n", path);
  auto const shown = [&](double number, Dimension dimension) { return scenario->units.text(number, dimension, 6); };
  fmt::print("  steps       {} of {}\n", scenario->steps, shown(scenario->simulation->step_size(), dimensions::time));
  for (auto const& one : scenario->classes) {
    fmt::print("  class       {}: from {}{}{}\n", one.name, one.base, one.doc.empty() ? "" : "; ", one.doc);
    for (auto const& field : one.fields)
      fmt::print("                {}: {}{}{}{}\n", field.name, field.components > 1 ? "a vector, " : "",
                 name_of(field.dimension), field.doc.empty() ? "" : "; ", field.doc);
    for (auto const& [left, right] : one.rates) fmt::print("                {} = {}\n", left, right);
  }
  for (auto const& ensemble : scenario->ensembles)
    fmt::print("  ensemble    {}: {} of class {}, {}D\n", ensemble->name(), ensemble->size(), ensemble->class_name(),
               ensemble->dimension());
  Box const& box = scenario->box();
  for (int a = 0; a < box.dimension(); ++a)
    fmt::print("  {}           {} to {}, {}\n", "xyz"[a], shown(box.low(a), dimensions::length),
               shown(box.high(a), dimensions::length), to_string(box.boundary(a)));
  for (auto const& scheme : scenario->schemes)
    if (auto const summary = scheme->summary(); !summary.empty()) fmt::print("  scheme      {}\n", summary);
  for (auto const& dissipation : scenario->dissipations) {
    std::vector<std::string> names;
    for (auto const* ensemble : dissipation->ensembles()) names.push_back(ensemble->name());
    fmt::print("  dissipation {} on {}\n", dissipation->kind(), join(names));
  }
  for (auto const& barostat : scenario->simulation->barostats())
    fmt::print("  barostat    at {}\n",
               shown(barostat->options().pressure, dimensions::energy / pow(dimensions::length, box.dimension())));
  fmt::print("\nbzm run {}\n", name);
}

void show_class(ParticleClass const& one) {
  fmt::print("class {}: {}\n", one.name, one.doc);
  fmt::print("\n  moved by    {}, usually with {}\n", one.classical ? "forces" : "a flow (its influence is a velocity)",
             to_string(one.variants.back().usual_method));
  for (auto const& variant : one.variants) {
    int numbers = 0;
    for (auto const& field : variant.fields) numbers = std::max(numbers, field.offset + field.components);
    std::size_t const row =
        (static_cast<std::size_t>(numbers) + row_block - 1) / row_block * row_block * sizeof(double);
    fmt::print("  in {}D       {} bytes of memory for a particle and its influence", variant.dimension,
               variant.row_bytes);
    if (one.matter == Matter::none)
      fmt::print(";\n              laws with a cut-off take {} more, and 4 for each neighbour in their lists\n",
                 bytes_with_lists(row));
    else
      fmt::print("\n");
  }
  auto const& largest = one.variants.back();
  fmt::print("\n  fields in {}D\n", largest.dimension);
  std::size_t width = 12;
  for (auto const& field : largest.fields) width = std::max(width, field.name.size());
  for (auto const& field : largest.fields)
    fmt::print("    {:<{}} {:<10} {:<22} {}\n", field.name, width,
               field.components == 1 ? "number" : fmt::format("{} numbers", field.components), name_of(field.dimension),
               field.doc);
  fmt::print("\n  quantities for pictures and diagnoses\n");
  for (auto const& quantity : quantities(*largest.make("particles", 0)))
    fmt::print("    {:<18} {}\n", quantity.name, name_of(quantity.dimension));
}

/// " in kg/m^3 or g/cm^3": in which units a quantity may be written.
std::string in_units(Option const& option) {
  using enum OptionKind::Form;
  auto const& kind = option.kind;
  if ((kind.form != number && kind.form != numbers && kind.form != vector) || !kind.dimension || kind.counted_in != 1)
    return "";
  auto const units = example_units(*kind.dimension * pow(dimensions::length, 3 * kind.by_space));
  return units.empty() ? "" : ", in " + join(units, " or ");
}

void show_options(OptionTable const& options, void* plain = nullptr) {
  std::size_t width = 0;
  for (auto const& option : options) width = std::max(width, option.key.size());
  for (auto const& option : options) {
    std::string const value = option.otherwise.empty() ? toml_value(option, plain) : option.otherwise;
    std::string const line = fmt::format("{}: {}{}{}", option.doc, allowed(option), in_units(option),
                                         !option.needed.empty() ? " (needed)"
                                         : value.empty()        ? ""
                                                                : " [" + value + "]");
    fmt::print("  {:<{}}  {}\n", option.key, width, plain_text(line));
  }
}

/// Names in a text that are a word of their own.
bool reads_name(std::string_view text, std::string_view name) {
  auto const part = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_' || c == '.'; };
  for (auto at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    std::size_t const end = at + name.size();
    if ((at == 0 || !part(text[at - 1])) && (end == text.size() || !part(text[end]))) return true;
  }
  return false;
}

/// The law as a table for a scenario, with examples of its parameters.
void show_typed(LawInfo const& law, int dimension, std::string_view text) {
  fmt::print("    [[influences]]\n    {} = \"{}\"\n", law.has_energy ? "energy" : "influence", text);
  std::vector<std::string> parameters;
  for (auto const& parameter : law.parameters) {
    if (!reads_name(text, parameter.name)) continue;
    auto const units = example_units(parameter.dimension.in(dimension));
    std::string value(parameter.default_text);
    if (value.empty()) value = "1";
    if (value.find(' ') == std::string::npos && !units.empty()) value += " " + units.front();
    bool const plain = value.find(' ') == std::string::npos;
    parameters.push_back(plain ? fmt::format("{} = {}", parameter.name, value)
                               : fmt::format("{} = \"{}\"", parameter.name, value));
  }
  if (!parameters.empty()) fmt::print("    parameters = {{ {} }}\n", join(parameters));
  if (law.kind == LawKind::external) fmt::print("    from_outside = true\n");
  fmt::print("    on = \"...\"\n");
}

void show_law(LawInfo const& law) {
  fmt::print("law {}: {}\n\n  {}     {}\n", law.name, law.doc, law.has_energy ? "energy   " : "influence", law.formula);
  if (law.kind == LawKind::pair)
    fmt::print("  between       {} (influenced) and {}, or classes derived from them\n", law.target, law.source);
  else
    fmt::print("  acts on       {} and classes derived from it, from outside\n", law.target);
  fmt::print("  dimensions    {} to {}\n", law.least_dimension, law.greatest_dimension);
  if (law.kind == LawKind::pair)
    fmt::print("  symmetry      {}\n", law.symmetry == Symmetry::antisymmetric ? "Newton's third law"
                                       : law.symmetry == Symmetry::one_way     ? "one way"
                                                                               : "general");
  if (law.velocity_dependent) fmt::print("  depends on velocities: not for the reversible leap-frog\n");
  if (!law.has_energy) fmt::print("  has no energy: total energies are not defined with it\n");
  fmt::print("\n  parameters\n");
  show_options(options_of(law.parameters));
  for (int d = 1; d <= 3; ++d) {
    std::string_view const text = law.typed.in[d - 1];
    bool const same = d > 1 && text == law.typed.in[d - 2];
    if (text.empty() || same || d < law.least_dimension) continue;
    bool const all = law.typed.in[0] == law.typed.in[2];
    fmt::print("\n  the same as a typed law{}\n", all ? "" : fmt::format(", in {}D", d));
    show_typed(law, d, text);
  }
  fmt::print("\n  in C++: #include <{}>, {}\n", law.header, law.type);
}

void show_material(MaterialInfo const& material) {
  fmt::print("material {}: {}\n\n  equation of state   {}\n", material.name, material.doc, material.formula);
  if (material.barotropic) fmt::print("  has no temperature: pressure and energy follow from the density alone\n");
  fmt::print("\n  in an ensemble of class Smooth or Solid: material = {{ kind = \"{}\", ... }}\n", material.name);
  show_options(options_of(material.parameters));
  if (material.tabulated) fmt::print("    points or file      at least two, of rising density\n");
  if (material.typed)
    fmt::print(
        "    pressure            formula of density and specific_energy, \"0.4*density*specific_energy\"\n"
        "    temperature         likewise; without it there is none\n"
        "    sound_speed         likewise; without it that of this pressure\n");
  fmt::print("\n  with any material\n");
  show_options(options_of(flux_parameters()));
  fmt::print("\n  of class Solid, in elastic = {{ ... }} inside the material\n");
  show_options(options_of(elastic_parameters()));
  fmt::print("\n  units are those in 3D; in 2D and 1D volumes are areas and lengths\n");
  fmt::print("  in C++: #include <{}>, {}\n", material.header, material.type);
}

void show_dissipation(DissipationKind const& kind) {
  fmt::print("dissipation {}: {}\n\n  {}\n\n", kind.name, kind.doc, kind.equation);
  DissipationOptions pairs;
  BathOptions bath;
  bool const of_pairs = &kind.options == &dissipation_options();
  show_options(kind.options, of_pairs ? static_cast<void*>(&pairs) : &bath);
  if (!of_pairs) return;
  fmt::print("\n  conventions\n");
  for (auto const& word : convention_words()) fmt::print("    {:<18} {}\n", word.name, word.doc);
  fmt::print("\n  methods\n");
  for (auto const& word : dissipation_method_words()) fmt::print("    {:<18} {}\n", word.name, word.doc);
}

void show_diagnosis(DiagnosisKind const& kind) {
  fmt::print("diagnosis {}: {}\n", kind.name, kind.doc);
  DiagnosisParameters plain;
  if (!kind.options.empty()) fmt::print("\n");
  show_options(kind.options, &plain);
}

void show_loader(LoadKind const& kind) {
  fmt::print("loader {}: {}\n", kind.name, kind.doc);
  if (kind.counted) fmt::print("\n  its ensemble says how many: number = 1000\n");
  LoadOptions plain;
  if (!kind.options.empty()) fmt::print("\n");
  show_options(kind.options, &plain);
}

void show_table(ScenarioTable const& table) {
  fmt::print("{}: {}\n\n", table.heading, table.doc);
  show_options(*table.options, table.plain);
}

void show_drawing(Drawing const& drawing) {
  fmt::print("drawing {}: {}\n\n", drawing.name, drawing.doc);
  Picture plain;
  show_options(drawing.options, &plain);
  fmt::print(
      "\nin a scenario [[output.pictures]] with drawing = \"{0}\"; of a run bzm render DIR --drawing {0} -o "
      "picture.png\n",
      drawing.name);
}

/// Every table of options, and where a user finds it.
void for_each_table(std::function<void(std::string const&, OptionTable const&)> const& function) {
  for (auto const& table : scenario_tables()) function(table.heading, *table.options);
  for (auto const& kind : dissipation_kinds()) function("dissipation " + kind.name, kind.options);
  for (auto const& kind : load_kinds()) function("loader " + kind.name, kind.options);
  for (auto const& kind : diagnosis_kinds()) function("diagnosis " + kind.name, kind.options);
  for (auto const& drawing : drawings()) function("drawing " + drawing.name, drawing.options);
}

/// The tables that have a key; false if none has it.
bool show_key(std::string const& key) {
  std::vector<std::string> lines, places;
  for_each_table([&](std::string const& place, OptionTable const& options) {
    Option const* option = options.find(key);
    if (!option) return;
    auto const line = plain_text(option->doc + ": " + allowed(*option));
    auto const known = static_cast<std::size_t>(std::find(lines.begin(), lines.end(), line) - lines.begin());
    if (known == lines.size()) lines.push_back(line), places.emplace_back();
    places[known] += (places[known].empty() ? "" : ", ") + place;
  });
  if (lines.empty()) return false;
  fmt::print("key {}\n", key);
  for (std::size_t k = 0; k < lines.size(); ++k) fmt::print("  {}\n    of {}\n", lines[k], places[k]);
  return true;
}

bool show_unit(std::string const& name) {
  for (auto const& unit : unit_table()) {
    std::istringstream names(std::string(unit.symbols) + " " + std::string(unit.words));
    for (std::string word; names >> word;)
      if (word == name) {
        fmt::print("unit {}: {}\n\n  names       {} {}\n  in SI       {:.12g} {}\n  prefixes    {}\n", name,
                   one(name_of(unit.dimension)), unit.symbols, unit.words, unit.si, join(example_units(unit.dimension)),
                   unit.prefixes ? "yes (k, M, m, ...; kilo, mega, milli, ... before words)" : "no");
        return true;
      }
  }
  auto const all = unit_names();
  if (std::find(all.begin(), all.end(), name) == all.end()) return false;
  auto const quantity = parse_quantity("1 " + name);
  fmt::print("unit {}: {}\n\n  in SI       {:.12g}\n", name, one(name_of(quantity.dimension)), quantity.si);
  return true;
}

/// The nearest of all names; of keys and units only where no name is near.
std::string near_name(std::string const& name) {
  std::vector<std::string> names, units, keys;
  for (auto const& section : sections)
    for (auto const& entry : section.entries())
      (std::string_view(section.name) == "units" ? units : names).push_back(entry.name);
  for (auto const& kind : key_words)
    for (auto const& word : kind.words()) names.push_back(word.name);
  for_each_table([&](std::string const&, OptionTable const& options) {
    for (auto const& key : options.keys()) keys.push_back(key);
  });
  std::string near;
  for (auto const* list : {&names, &keys, &units}) {
    std::string const said = did_you_mean(name, *list);
    if (said.starts_with("; it is ")) return said;  // another word for one of them, wherever it stands
    if (near.empty()) near = said;
  }
  return near;
}

}  // namespace

std::vector<std::string> listed_kinds() {
  std::vector<std::string> kinds;
  for (auto const& section : sections) kinds.emplace_back(section.name);
  return kinds;
}

int list(std::string const& kind, bool names_only) {
  auto const kinds = listed_kinds();
  if (!kind.empty() && std::find(kinds.begin(), kinds.end(), kind) == kinds.end())
    throw Error("nothing is listed as '" + kind + "'; there are " + join(kinds) + did_you_mean(kind, kinds));
  bool first = true;
  for (auto const& section : sections) {
    if (kind.empty() ? std::string(section.name) == "units" : kind != section.name) continue;
    auto const entries = section.entries();
    if (names_only) {
      for (auto const& entry : entries) fmt::print("{}\n", entry.name);
      continue;
    }
    fmt::print("{}{}\n", first ? "" : "\n", section.name);
    first = false;
    for (auto const& entry : entries) fmt::print("  {:<22} {}\n", entry.name, entry.doc);
  }
  if (!names_only && kind.empty()) fmt::print("\nbzm show NAME explains one; bzm list units lists the units.\n");
  return 0;
}

int show_schema(std::string const& name) {
  if (!name.empty()) throw Error("--schema is of all that a scenario may have; leave '" + name + "' out");
  std::fputs(scenario_schema().c_str(), stdout);
  return 0;
}

int show(std::string const& name) {
  if (name.empty()) throw Error("bzm show needs a name that bzm list shows, or --schema");
  auto const shipped = shipped_scenarios();
  if (std::find(shipped.begin(), shipped.end(), name) != shipped.end() || name.ends_with(".toml")) {
    show_scenario(name);
    return 0;
  }
  // Two things may have one name: a law and a loader, a diagnosis and the drawing of what it records.
  bool shown = false;
  auto const next = [&] {
    if (shown) fmt::print("\n");
    shown = true;
  };
  if (auto const* one = find_class(name)) next(), show_class(*one);
  if (auto const* law = find_law(name)) next(), show_law(*law);
  if (auto const* material = find_material(name)) next(), show_material(*material);
  for (auto const& kind : dissipation_kinds())
    if (kind.name == name) next(), show_dissipation(kind);
  for (auto const& table : scenario_tables())
    if (table.name == name) next(), show_table(table);
  for (auto const& table : tables_of_kinds)
    if (table.name == name) {
      next(), fmt::print("{}: {}\n\n  {} = one of these; bzm show NAME tells its keys\n", table.heading,
                         plain_text(table.doc), table.key);
      for (auto const& kind : table.kinds()) fmt::print("    {:<22} {}\n", kind.name, kind.doc);
    }
  for (auto const& kind : load_kinds())
    if (kind.name == name) next(), show_loader(kind);
  for (auto const& kind : diagnosis_kinds())
    if (kind.name == name) next(), show_diagnosis(kind);
  for (auto const& drawing : drawings())
    if (drawing.name == name) next(), show_drawing(drawing);
  for (auto const& kind : key_words)
    for (auto const& word : kind.words())
      if (word.name == name) next(), fmt::print("{} {}: {}\n", kind.what, name, word.doc);
  if (shown || show_key(name) || show_unit(name)) return 0;
  throw Error("nothing is called '" + name + "'" + near_name(name) + " (bzm list shows all names)");
}

}  // namespace boltzmann::bzm
