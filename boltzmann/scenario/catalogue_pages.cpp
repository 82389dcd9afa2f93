// Catalogue pages, generated from the tables that the program itself uses.
#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/foreign_words.hpp>
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/dissipation/dissipation_options.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/formulas/formula_functions.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/neighbours/neighbour_list.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/scenario/catalogue_pages.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/load_options.hpp>
#include <boltzmann/scenario/materials.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/scenario/tables.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <functional>
#include <iterator>
#include <sstream>
#include <utility>

namespace boltzmann {
namespace {

/// A page of text under construction.
struct Page {
  std::string text;
  template <class... Values>
  void print(fmt::format_string<Values...> format, Values&&... values) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Values>(values)...);
  }
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
/// The names of a catalogue whose entries have a name and a doc.
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

/// Tables of a scenario that have one of several kinds, each with its own keys.
struct TableOfKinds {
  char const *name, *heading, *doc, *key;
  std::vector<Named> (*kinds)();
};
constexpr TableOfKinds tables_of_kinds[] = {
    {"dissipation", "[[dissipation]]", "friction and noise between the steps", "kind", of<dissipation_kinds>},
    {"diagnoses", "[[diagnoses]]", "measurements, as columns of diagnoses.csv", "kind", of<diagnosis_kinds>},
    {"output.pictures", "[[output.pictures]]", "a picture of the last state, as a file", "drawing", of<drawings>},
    {"views", "[[views]]", "a drawing that the window's page offers, by its `name`", "drawing", of<drawings>}};

std::vector<Named> table_list() {
  auto all = of<scenario_tables>();
  for (auto const& table : tables_of_kinds) all.push_back({table.name, table.doc});
  return all;
}

/// Allowed words of keys.
struct KeyWords {
  char const* what;
  std::vector<Named> (*words)();
};
constexpr KeyWords key_words[] = {{"integrator", of<method_words>},
                                  {"boundary", of<boundary_words>},
                                  {"convention of dpd", of<convention_words>},
                                  {"method of dpd", of<dissipation_method_words>},
                                  {"lattice", of<lattice_words>}};

struct ListedKind {
  char const* name;
  std::vector<Named> (*entries)();
};
constexpr ListedKind sections[] = {{"scenarios", scenarios},
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

void show_scenario(Page& page, std::string const& name) {
  std::string const path = find_scenario(name);
  auto const scenario = load_scenario(path);
  page.print("scenario {}{}{}\n", scenario->name, scenario->title.empty() ? "" : ": ", scenario->title);
  if (!scenario->description.empty()) page.print("\n{}\n", scenario->description);
  page.print("\n  file        {}\n", path);
  auto const shown = [&](double number, Dimension dimension) { return scenario->units.text(number, dimension, 6); };
  page.print("  steps       {} of {}\n", scenario->steps, shown(scenario->simulation->step_size(), dimensions::time));
  for (auto const& one : scenario->classes) {
    page.print("  class       {}: from {}{}{}\n", one.name, one.base, one.doc.empty() ? "" : "; ", one.doc);
    for (auto const& field : one.fields)
      page.print("                {}: {}{}{}{}\n", field.name, field.components > 1 ? "a vector, " : "",
                 name_of(field.dimension), field.doc.empty() ? "" : "; ", field.doc);
    for (auto const& [left, right] : one.rates) page.print("                {} = {}\n", left, right);
  }
  for (auto const& ensemble : scenario->ensembles)
    page.print("  ensemble    {}: {} of class {}, {}D\n", ensemble->name(), ensemble->size(), ensemble->class_name(),
               ensemble->dimension());
  Box const& box = scenario->box();
  for (int a = 0; a < box.dimension(); ++a)
    page.print("  {}           {} to {}, {}\n", "xyz"[a], shown(box.low(a), dimensions::length),
               shown(box.high(a), dimensions::length), to_string(box.boundary(a)));
  for (auto const& scheme : scenario->schemes)
    if (auto const summary = scheme->summary(); !summary.empty()) page.print("  scheme      {}\n", summary);
  for (auto const& dissipation : scenario->dissipations) {
    std::vector<std::string> names;
    for (auto const* ensemble : dissipation->ensembles()) names.push_back(ensemble->name());
    page.print("  dissipation {} on {}\n", dissipation->kind(), join(names));
  }
  for (auto const& barostat : scenario->simulation->barostats())
    page.print("  barostat    at {}\n",
               shown(barostat->options().pressure, dimensions::energy / pow(dimensions::length, box.dimension())));
  page.print("\nbzm run {}\n", name);
}

void show_class(Page& page, ParticleClass const& one) {
  page.print("class {}: {}\n", one.name, one.doc);
  page.print("\n  moved by    {}, usually with {}\n", one.classical ? "forces" : "a flow (its influence is a velocity)",
             to_string(one.variants.back().usual_method));
  for (auto const& variant : one.variants) {
    int numbers = 0;
    for (auto const& field : variant.fields) numbers = std::max(numbers, field.offset + field.components);
    std::size_t const row =
        (static_cast<std::size_t>(numbers) + row_block - 1) / row_block * row_block * sizeof(double);
    page.print("  in {}D       {} bytes of memory for a particle and its influence", variant.dimension,
               variant.row_bytes);
    if (one.matter == Matter::none)
      page.print(";\n              laws with a cut-off take {} more, and 4 for each neighbour in their lists\n",
                 bytes_with_lists(row));
    else
      page.print("\n");
  }
  auto const& largest = one.variants.back();
  page.print("\n  fields in {}D\n", largest.dimension);
  std::size_t width = 12;
  for (auto const& field : largest.fields) width = std::max(width, field.name.size());
  for (auto const& field : largest.fields)
    page.print("    {:<{}} {:<10} {:<22} {}\n", field.name, width,
               field.components == 1 ? "number" : fmt::format("{} numbers", field.components), name_of(field.dimension),
               field.doc);
  page.print("\n  quantities for pictures and diagnoses\n");
  for (auto const& quantity : quantities(*largest.make("particles", 0)))
    page.print("    {:<18} {}\n", quantity.name, name_of(quantity.dimension));
}

/// " in kg/m^3 or g/cm^3": the units in which a quantity may be written.
std::string in_units(Option const& option) {
  using enum OptionKind::Form;
  auto const& kind = option.kind;
  if ((kind.form != number && kind.form != numbers && kind.form != vector) || !kind.dimension || kind.counted_in != 1)
    return "";
  auto const units = example_units(*kind.dimension * pow(dimensions::length, 3 * kind.by_space));
  return units.empty() ? "" : ", in " + join(units, " or ");
}

void show_options(Page& page, OptionTable const& options, void* plain = nullptr) {
  std::size_t width = 0;
  for (auto const& option : options) width = std::max(width, option.key.size());
  for (auto const& option : options) {
    std::string const value = option.otherwise.empty() ? toml_value(option, plain) : option.otherwise;
    std::string const line = fmt::format("{}: {}{}{}", option.doc, allowed(option), in_units(option),
                                         !option.needed.empty() ? " (needed)"
                                         : value.empty()        ? ""
                                                                : " [" + value + "]");
    page.print("  {:<{}}  {}\n", option.key, width, plain_text(line));
  }
}

/// True if a name occurs in a text as a separate word, or with a component after it.
bool reads_name(std::string_view text, std::string_view name) {
  auto const letter = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (auto at = text.find(name); at != std::string_view::npos; at = text.find(name, at + 1)) {
    std::size_t const end = at + name.size();
    if ((at == 0 || !(letter(text[at - 1]) || text[at - 1] == '.')) && (end == text.size() || !letter(text[end])))
      return true;
  }
  return false;
}

/// "1 eV": its default, or one, in a suitable unit.
std::string example_of(Parameter const& parameter, int dimension) {
  auto const units = example_units(parameter.dimension.in(dimension));
  std::string value(parameter.default_text.empty() ? "1" : parameter.default_text);
  if (value.find(' ') == std::string::npos && !units.empty()) value += " " + units.front();
  return value;
}

/// The law as a table for a scenario, with example values of its parameters.
void show_typed(Page& page, LawInfo const& law, int dimension, std::string_view text) {
  page.print("    [[influences]]\n    {} = \"{}\"\n", law.has_energy ? "energy" : "influence", text);
  std::vector<std::string> parameters, vectors;
  for (auto const& parameter : law.parameters) {
    if (!reads_name(text, parameter.name)) continue;
    std::string const value = example_of(parameter, dimension);
    char const* const quote = value.find(' ') == std::string::npos ? "" : "\"";
    if (parameter.vector)
      vectors.push_back(fmt::format("{} = \"[{}]\"", parameter.name,
                                    join(std::vector<std::string>(static_cast<std::size_t>(dimension), value))));
    else
      parameters.push_back(fmt::format("{0} = {1}{2}{1}", parameter.name, quote, value));
  }
  if (!vectors.empty()) page.print("    where = {{ {} }}\n", join(vectors));
  if (!parameters.empty()) page.print("    parameters = {{ {} }}\n", join(parameters));
  if (law.kind == LawKind::external) page.print("    from_outside = true\n");
  page.print("    on = \"...\"\n");
}

/// Once if the text is the same in all dimensions, as it is in the last of them.
void show_typed(Page& page, LawInfo const& law) {
  auto const text = [&](int d) { return law.typed.in[d - 1]; };
  int const least = law.least_dimension, greatest = law.greatest_dimension;
  bool const vectors = std::any_of(law.parameters.begin(), law.parameters.end(),
                                   [](Parameter const& parameter) { return parameter.vector; });
  for (int d = least; d <= greatest; ++d) {
    if (text(d).empty() || (d < greatest && text(d) == text(d + 1))) continue;
    bool const all = text(least) == text(greatest);
    page.print("\n  the same as a formula law{}\n", all && vectors && least < greatest
                                                        ? fmt::format(", with its vectors in {}D", d)
                                                    : all ? ""
                                                          : fmt::format(", in {}D", d));
    show_typed(page, law, d, text(d));
  }
}

void show_law(Page& page, LawInfo const& law) {
  page.print("law {}: {}\n\n  {}     {}\n", law.name, law.doc, law.has_energy ? "energy   " : "influence", law.formula);
  if (law.kind == LawKind::pair)
    page.print("  between       {} (influenced) and {}, or classes derived from them\n", law.target, law.source);
  else
    page.print("  acts on       {} and classes derived from it, as an external law\n", law.target);
  page.print("  dimensions    {} to {}\n", law.least_dimension, law.greatest_dimension);
  if (law.kind == LawKind::pair)
    page.print("  symmetry      {}\n", law.symmetry == Symmetry::antisymmetric ? "Newton's third law"
                                       : law.symmetry == Symmetry::one_way     ? "one way"
                                                                               : "general");
  if (law.velocity_dependent) page.print("  depends on velocities: not for the reversible leap-frog\n");
  if (!law.has_energy) page.print("  has no energy: total energies are not defined with it\n");
  page.print("\n  parameters\n");
  show_options(page, options_of(law.parameters));
  show_typed(page, law);
  page.print("\n  in C++: #include <{}>, {}\n", law.header, law.type);
}

void show_material(Page& page, MaterialInfo const& material) {
  page.print("material {}: {}\n\n  equation of state   {}\n", material.name, material.doc, material.formula);
  if (material.barotropic) page.print("  has no temperature: pressure and energy follow from the density alone\n");
  page.print("\n  in an ensemble of class Smooth or Solid: material = {{ kind = \"{}\", ... }}\n", material.name);
  show_options(page, options_of(material.parameters));
  if (material.tabulated) page.print("    points or file      at least two, of rising density\n");
  if (material.typed)
    page.print(
        "    pressure            formula of density and specific_energy, \"0.4*density*specific_energy\"\n    "
        "temperature         likewise; default: none\n    sound_speed         likewise; default: that of this "
        "pressure\n");
  page.print("\n  with any material\n");
  show_options(page, options_of(flux_parameters()));
  page.print("\n  of class Solid, in elastic = {{ ... }} inside the material\n");
  show_options(page, options_of(elastic_parameters()));
  page.print("\n  units are those in 3D; in 2D and 1D volumes are areas and lengths\n");
  page.print("  in C++: #include <{}>, {}\n", material.header, material.type);
}

void show_dissipation(Page& page, DissipationKind const& kind) {
  page.print("dissipation {}: {}\n\n  {}\n\n", kind.name, kind.doc, kind.equation);
  DissipationOptions pairs;
  BathOptions bath;
  bool const of_pairs = &kind.options == &dissipation_options();
  show_options(page, kind.options, of_pairs ? static_cast<void*>(&pairs) : &bath);
  if (!of_pairs) return;
  page.print("\n  conventions\n");
  for (auto const& word : convention_words()) page.print("    {:<18} {}\n", word.name, word.doc);
  page.print("\n  methods\n");
  for (auto const& word : dissipation_method_words()) page.print("    {:<18} {}\n", word.name, word.doc);
}

void show_diagnosis(Page& page, DiagnosisKind const& kind) {
  page.print("diagnosis {}: {}\n", kind.name, kind.doc);
  DiagnosisParameters plain;
  if (!kind.options.empty()) page.print("\n");
  show_options(page, kind.options, &plain);
}

void show_loader(Page& page, LoadKind const& kind) {
  page.print("loader {}: {}\n", kind.name, kind.doc);
  if (kind.counted) page.print("\n  needs the number of particles in its ensemble: number = 1000\n");
  LoadOptions plain;
  if (!kind.options.empty()) page.print("\n");
  show_options(page, kind.options, &plain);
}

void show_table(Page& page, ScenarioTable const& table) {
  page.print("{}: {}\n\n", table.heading, table.doc);
  show_options(page, *table.options, table.plain);
}

void show_drawing(Page& page, Drawing const& drawing) {
  page.print("drawing {}: {}\n\n", drawing.name, drawing.doc);
  Picture plain;
  show_options(page, drawing.options, &plain);
  page.print(
      "\nin a scenario [[output.pictures]] with drawing = \"{0}\"; of a run bzm render DIR --drawing {0} -o "
      "picture.png\n",
      drawing.name);
}

/// Every table of options, and its heading in a scenario.
void for_each_table(std::function<void(std::string const&, OptionTable const&)> const& function) {
  for (auto const& table : scenario_tables()) function(table.heading, *table.options);
  for (auto const& kind : dissipation_kinds()) function("dissipation " + kind.name, kind.options);
  for (auto const& kind : load_kinds()) function("loader " + kind.name, kind.options);
  for (auto const& kind : diagnosis_kinds()) function("diagnosis " + kind.name, kind.options);
  for (auto const& drawing : drawings()) function("drawing " + drawing.name, drawing.options);
}

Field const* field_of(ParticleClass const& one, std::string const& name) {
  for (auto const& field : one.variants.back().fields)
    if (field.name == name) return &field;
  return nullptr;
}

void show_formulas(Page& page) {
  page.print("formulas: numbers, names, + - * / ^ and functions, as in \"0.1 eV*exp(-(r/sigma)^2)\"\n\n  functions\n");
  for (auto const& function : formula_function_table())
    page.print("    {:<8} {}{}\n", function.name, function.doc,
               function.error > 0 ? fmt::format(" (error below {:g} ulp)", function.error) : "");
  page.print("\n  ulp: units in the last place, the largest error over all doubles\n");
  for (auto const& rule : formula_rules) page.print("  {}\n", rule);
}

/// The tables that have a key, and the classes that have it as a field; false if there are none.
bool show_key(Page& page, std::string const& key) {
  std::vector<std::string> lines, places;
  auto const add = [&](std::string const& line, std::string const& place) {
    auto const known = static_cast<std::size_t>(std::find(lines.begin(), lines.end(), line) - lines.begin());
    if (known == lines.size()) lines.push_back(line), places.emplace_back();
    places[known] += (places[known].empty() ? "" : ", ") + place;
  };
  for_each_table([&](std::string const& place, OptionTable const& options) {
    if (Option const* option = options.find(key)) add(plain_text(option->doc + ": " + allowed(*option)), place);
  });
  for (auto const& one : particle_classes())
    if (Field const* field = field_of(one, key))
      add(fmt::format("field of particles{}{}: {}", field->doc.empty() ? "" : ", ", field->doc,
                      with_article(name_of(field->dimension))),
          "class " + one.name);
  if (lines.empty()) return false;
  page.print("key {}\n", key);
  for (std::size_t k = 0; k < lines.size(); ++k) page.print("  {}\n    of {}\n", lines[k], places[k]);
  return true;
}

bool show_unit(Page& page, std::string const& name) {
  for (auto const& unit : unit_table()) {
    std::istringstream names(std::string(unit.symbols) + " " + std::string(unit.words));
    for (std::string word; names >> word;)
      if (word == name) {
        page.print("unit {}: {}\n\n  names       {} {}\n  in SI       {:.12g} {}\n  prefixes    {}\n", name,
                   one(name_of(unit.dimension)), unit.symbols, unit.words, unit.si, join(example_units(unit.dimension)),
                   unit.prefixes ? "yes (k, M, m, ...; kilo, mega, milli, ... before words)" : "no");
        return true;
      }
  }
  auto const& all = unit_names();
  if (std::find(all.begin(), all.end(), name) == all.end()) return false;
  auto const quantity = parse_quantity("1 " + name);
  page.print("unit {}: {}\n\n  in SI       {:.12g}\n", name, one(name_of(quantity.dimension)), quantity.si);
  return true;
}

/// The only name that differs from this one only in case; else this one.
std::string as_listed(std::string const& given) {
  auto const small = [](std::string text) {
    std::transform(text.begin(), text.end(), text.begin(), [](unsigned char c) { return std::tolower(c); });
    return text;
  };
  std::string found = given;
  for (auto const& section : sections)
    for (auto const& entry : section.entries()) {
      if (std::string_view(section.name) == "units") continue;
      if (entry.name == given) return given;
      if (small(entry.name) == small(given)) found = entry.name;
    }
  return found;
}

/// The most similar of all names; keys and units only if no other name is similar.
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

std::vector<Named> listed(std::string const& kind) {
  for (auto const& section : sections)
    if (kind == section.name) return section.entries();
  auto const kinds = listed_kinds();
  throw Error("nothing is listed as '" + kind + "'" + choices(kind, kinds));
}

std::vector<std::string> places_of_key(std::string const& key) {
  std::vector<std::string> places;
  for_each_table([&](std::string const& place, OptionTable const& options) {
    if (options.find(key)) places.push_back(place);
  });
  for (auto const& one : particle_classes())
    if (field_of(one, key)) places.push_back("class " + one.name);
  return places;
}

std::string catalogue_page(std::string const& given) {
  Page page;
  std::string const name = as_listed(given);
  auto const shipped = shipped_scenarios();
  if (std::find(shipped.begin(), shipped.end(), name) != shipped.end() || name.ends_with(".toml")) {
    show_scenario(page, name);
    return page.text;
  }
  // Two entries may have one name: a law and a loader, or a diagnosis and the drawing of its record.
  bool shown = false;
  auto const next = [&] {
    if (shown) page.print("\n");
    shown = true;
  };
  if (auto const* one = find_class(name)) next(), show_class(page, *one);
  if (auto const* law = find_law(name)) next(), show_law(page, *law);
  if (auto const* material = find_material(name)) next(), show_material(page, *material);
  for (auto const& kind : dissipation_kinds())
    if (kind.name == name) next(), show_dissipation(page, kind);
  for (auto const& table : scenario_tables())
    if (table.name == name) next(), show_table(page, table);
  for (auto const& table : tables_of_kinds)
    if (table.name == name) {
      next(), page.print("{}: {}\n\n  {} = one of these; bzm show NAME explains its keys\n", table.heading,
                         plain_text(table.doc), table.key);
      for (auto const& kind : table.kinds()) page.print("    {:<22} {}\n", kind.name, kind.doc);
    }
  for (auto const& kind : load_kinds())
    if (kind.name == name) next(), show_loader(page, kind);
  for (auto const& kind : diagnosis_kinds())
    if (kind.name == name) next(), show_diagnosis(page, kind);
  for (auto const& drawing : drawings())
    if (drawing.name == name) next(), show_drawing(page, drawing);
  for (auto const& kind : key_words)
    for (auto const& word : kind.words())
      if (word.name == name) next(), page.print("{} {}: {}\n", kind.what, name, word.doc);
  if (name == "formula" || name == "formulas") next(), show_formulas(page);
  if (given != name) next(), shown = show_unit(page, given) || shown;
  if (shown || show_key(page, name) || show_unit(page, name)) return page.text;
  if (auto const term = foreign_term(given); !term.empty()) throw Error("nothing is called '" + given + "'; " + term);
  std::string const plain = without_foreign_kind(given);
  if (plain != given && plain != name) {
    try {
      return catalogue_page(plain);
    } catch (Error const&) {  // reported below, with the whole name
    }
    auto const near = near_name(plain);
    throw Error("nothing is called '" + given + "'" +
                (near.starts_with("; it is ") ? near : "; docs/how-to/from-lammps.md has a table of such words") +
                " (bzm list shows all names)");
  }
  throw Error("nothing is called '" + name + "'" + near_name(name) + " (bzm list shows all names)");
}

}  // namespace boltzmann
