// Writes JSON directly: texts, lists and objects of a schema.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/options.hpp>
#include <boltzmann/diagnoses/diagnosis_catalogue.hpp>
#include <boltzmann/dissipation/dissipation_options.hpp>
#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/laws.hpp>
#include <boltzmann/scenario/load_options.hpp>
#include <boltzmann/scenario/schema.hpp>
#include <boltzmann/scenario/schemes.hpp>
#include <boltzmann/scenario/tables.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

namespace boltzmann {
namespace {

std::string quoted_text(std::string_view plain) {
  std::string quoted = "\"";
  for (char const c : plain) {
    if (c == '"' || c == '\\') quoted += '\\';
    quoted += c;
  }
  return quoted + "\"";
}
std::string described(std::string_view doc) { return quoted_text(plain_text(doc)); }
std::string list(std::vector<std::string> const& texts) {
  std::string all;
  for (auto const& one : texts) all += (all.empty() ? "" : ", ") + quoted_text(one);
  return "[" + all + "]";
}

/// Members in their order; values are already JSON.
using Members = std::vector<std::pair<std::string, std::string>>;
std::string object(Members const& members) {
  std::string all;
  for (auto const& [key, value] : members)
    all += fmt::format("{}{}: {}", all.empty() ? "" : ", ", quoted_text(key), value);
  return "{" + all + "}";
}

/// A table: with these keys only, or open for others.
std::string table(Members const& properties, bool closed, std::string_view doc = "") {
  Members members{{"type", quoted_text("object")}, {"properties", object(properties)}};
  if (closed) members.push_back({"additionalProperties", "false"});
  if (!doc.empty()) members.push_back({"description", described(doc)});
  return object(members);
}
std::string tables(std::string const& one) { return object({{"type", quoted_text("array")}, {"items", one}}); }
std::string one_or_tables(std::string const& one) { return fmt::format("{{\"anyOf\": [{}, {}]}}", one, tables(one)); }

std::string words(std::vector<std::string> const& all, std::string_view doc) {
  return object({{"enum", list(all)}, {"description", described(doc)}});
}

Members properties_of(OptionTable const& options, void* plain = nullptr);

/// The allowed values, without documentation. `plain`: an object with these options, for the keys of a group; null:
/// there is none.
Members shape(Option const& option, void* plain = nullptr) {
  using enum OptionKind::Form;
  auto const& kind = option.kind;
  auto const limits = [&](Members members) {
    if (std::isfinite(kind.range.low))
      members.push_back({kind.range.low_excluded ? "exclusiveMinimum" : "minimum", fmt::format("{}", kind.range.low)});
    if (std::isfinite(kind.range.high)) members.push_back({"maximum", fmt::format("{}", kind.range.high)});
    return members;
  };
  switch (kind.form) {
    case flag:
      return {{"type", quoted_text("boolean")}};
    case whole:  // 1e6 is an integer
      return limits({{"type", quoted_text("number")}, {"multipleOf", "1"}});
    case number:
      return limits({{"type", list({"number", "string"})}});
    case wholes:
    case wholes_by_axis:
      return {{"type", list({"integer", "array"})}};
    case numbers:
    case vector:
      return {{"type", quoted_text("array")}};
    case count_or_numbers:
      return {{"type", list({"integer", "array"})}};
    case text:
    case path:
    case name:
      return {{"type", quoted_text("string")}};
    case word:
      return {{"enum", list(kind.words)}};
    case axis:
      return {{"enum", list({"x", "y", "z"})}};
    case ensembles:
      return {{"type", list({"string", "array"})}};
    case particles:
      return {{"type", list({"string", "array"})}};
    case OptionKind::Form::tables:
      return {{"type", list({"object", "array"})}};
    case group: {
      Members members{{"type", quoted_text("object")}};
      if (!plain) return members;
      auto const place = option.place(plain);
      if (auto const* inner = std::get_if<OptionGroup>(&place))
        members.push_back({"properties", object(properties_of(*inner->options))});
      return members;
    }
    case said:
      return {};
  }
  return {};
}

std::string documented(Option const& option) {
  std::string doc = option.doc + ": " + allowed(option);
  if (!option.otherwise.empty()) doc += " [" + option.otherwise + "]";
  return doc;
}

Members properties_of(OptionTable const& options, void* plain) {
  Members all;
  for (auto const& option : options) {
    auto members = shape(option, plain);
    members.push_back({"description", described(documented(option))});
    all.push_back({option.key, object(members)});
  }
  return all;
}

void replace(Members& members, std::string const& key, std::string value) {
  auto const found = std::find_if(members.begin(), members.end(), [&](auto const& one) { return one.first == key; });
  if (found == members.end())
    members.push_back({key, std::move(value)});
  else
    found->second = std::move(value);
}

/// One of several kinds in one place: its word and its keys.
struct KindOf {
  std::string name, doc;
  OptionTable const* options;
};

/// A table with a key that selects the kind. It has the keys of all kinds, each documented for those that have it. The
/// shape of a key is what all its kinds have in common.
std::string kinds(std::string const& key, std::vector<KindOf> const& all, Members more, bool closed = true) {
  std::vector<std::string> names;
  std::string doc;
  for (auto const& kind : all) {
    names.push_back(kind.name);
    doc += fmt::format("{}{}: {}", doc.empty() ? "" : "; ", kind.name, kind.doc);
  }
  std::vector<std::string> order;
  std::map<std::string, std::pair<Members, std::string>> keys;  // shape and documentation
  for (auto const& kind : all)
    for (auto const& option : *kind.options) {
      auto const known = keys.find(option.key);
      std::string const said = kind.name + ": " + documented(option);
      if (known == keys.end()) {
        order.push_back(option.key);
        keys[option.key] = {shape(option), said};
        continue;
      }
      if (known->second.first != shape(option)) known->second.first.clear();
      known->second.second += "; " + said;
    }
  Members properties{{key, words(names, doc)}};
  for (auto const& one : order) {
    auto [members, said] = keys[one];
    members.push_back({"description", described(said)});
    properties.push_back({one, object(members)});
  }
  for (auto& [name, schema] : more) replace(properties, name, schema);
  return table(properties, closed);
}

std::string something(std::string_view doc) { return object({{"description", described(doc)}}); }

std::string of_pictures(Members more) {
  std::vector<KindOf> all;
  for (auto const& drawing : drawings()) all.push_back({drawing.name, drawing.doc, &drawing.options});
  return tables(kinds("drawing", all, std::move(more)));
}

ScenarioTable const& table_named(std::string_view name) {
  for (auto const& one : scenario_tables())
    if (one.name == name) return one;
  throw Error("there is no table '" + std::string(name) + "'");
}

/// Keys of [[ensembles]] and [[ensembles.set]], with the fields of all classes.
std::pair<Members, Members> members_of_ensembles() {
  auto properties = properties_of(ensemble_options()), set = properties_of(set_options());
  for (auto const& one : particle_classes())
    for (auto const& field : one.variants.back().fields) {
      auto const said = something(fmt::format("a field, {}: {}", name_of(field.dimension), field.doc));
      if (field.name != "position" && !ensemble_options().find(field.name)) replace(properties, field.name, said);
      replace(set, field.name, said);
    }
  return {properties, set};
}

/// With derived classes, their fields are further keys.
Members open_members_of_ensembles() {
  auto [properties, set] = members_of_ensembles();
  replace(properties, "set", tables(table(set, false)));
  std::vector<KindOf> loads;
  for (auto const& kind : load_kinds()) loads.push_back({kind.name, kind.doc, &kind.options});
  replace(properties, "load", kinds("kind", loads, {}));
  return properties;
}

/// With `derived`, the schema of ensembles with [[classes]]; otherwise only the restriction to the known keys, in a
/// short form.
std::string ensembles(bool derived) {
  std::vector<std::string> classes;
  std::string class_docs;
  for (auto const& one : particle_classes()) {
    classes.push_back(one.name);
    class_docs += (class_docs.empty() ? "" : "; ") + one.name + ": " + one.doc;
  }
  if (!derived) {
    auto const names_of = [](Members const& members) {
      std::vector<std::string> names;
      for (auto const& one : members) names.push_back(one.first);
      return object({{"enum", list(names)}});
    };
    auto const [properties, set] = members_of_ensembles();
    std::string const some = object({{"items", object({{"propertyNames", names_of(set)}})}});
    return object(
        {{"items", object({{"propertyNames", names_of(properties)},
                           {"properties", object({{"class", object({{"enum", list(classes)}})}, {"set", some}})}})}});
  }
  auto properties = open_members_of_ensembles();
  std::string const any = object({{"type", quoted_text("string")}, {"description", quoted_text("of [[classes]]")}});
  replace(properties, "class", fmt::format("{{\"anyOf\": [{}, {}]}}", words(classes, class_docs), any));
  return tables(table(properties, false));
}

/// Particles that an event adds to an ensemble.
std::string addition() {
  auto properties = open_members_of_ensembles();
  std::erase_if(properties, [](auto const& one) {
    return one.first == "name" || one.first == "class" || one.first == "integrator" || one.first == "colour" ||
           one.first == "diameter" || one.first == "molecule" || one.first == "bonds" || one.first == "material" ||
           one.first == "heat_capacity";
  });
  return table(properties, false);
}

/// Classes derived by a scenario have additional fields, so other keys are allowed.
std::string classes() {
  auto properties = properties_of(class_options());
  std::vector<std::string> bases;
  std::string docs;
  for (auto const& one : particle_classes()) {
    bases.push_back(one.name);
    docs += (docs.empty() ? "" : "; ") + one.name + ": " + one.doc;
  }
  replace(properties, "base", words(bases, docs));
  replace(properties, "fields", tables(table(properties_of(class_field_options()), true)));
  return tables(table(properties, true));
}

std::string influences() {
  auto properties = properties_of(influence_options());
  std::vector<std::string> names;
  std::string docs;
  std::map<std::string, std::string> parameters;
  for (auto const& law : scenario_laws()) {
    names.emplace_back(law.name);
    docs += fmt::format("{}{}: {}", docs.empty() ? "" : "; ", law.name, law.doc);
    for (auto const& parameter : law.parameters) {
      auto& doc = parameters[std::string(parameter.name)];
      doc += fmt::format("{}{}: {}", doc.empty() ? "" : "; ", law.name, parameter.doc);
      if (!parameter.also.empty())
        parameters[std::string(parameter.also)] = fmt::format("{}: instead of {}", law.name, parameter.name);
    }
  }
  replace(properties, "law", words(names, docs));
  for (char const* key : {"cutoff", "switch_from"})  // with `among` tables by names, too
    parameters[key] = documented(*influence_options().find(key));
  for (auto const& [name, doc] : parameters) replace(properties, name, something(doc));
  return tables(table(properties, true));
}

}  // namespace

std::string scenario_schema() {
  std::vector<KindOf> diagnoses, dissipations;
  for (auto const& kind : diagnosis_kinds()) diagnoses.push_back({kind.name, kind.doc, &kind.options});
  for (auto const& kind : dissipation_kinds()) dissipations.push_back({kind.name, kind.doc, &kind.options});
  auto const closed = [](std::string_view name, Members more = {}) {
    auto const& of = table_named(name);
    auto properties = properties_of(*of.options, of.plain);
    for (auto& [key, schema] : more) replace(properties, key, schema);
    return table(properties, true);
  };
  std::string const title =
      object({{"type", quoted_text("string")}, {"description", described("one line; printed above pictures")}});
  std::string const description =
      object({{"type", quoted_text("string")}, {"description", described("purpose, and source of the numbers")}});
  Members properties{
      {"title", title},
      {"description", description},
      {"units",
       closed("units", {{"base", words({"si", "cgs", "reduced", "lennard-jones", "gravitational", "plasma", "custom"},
                                       "the units in which the simulation counts")}})},
      {"box", closed("box", {{"walls", tables(closed("box.walls"))}, {"regions", tables(closed("box.regions"))}})},
      {"run", closed("run")},
      {"classes", classes()},
      {"ensembles", ensembles(true)},
      {"bodies", tables(closed("bodies"))},
      {"dye", tables(closed("dye"))},
      {"influences", influences()},
      {"interactions", object({{"$ref", quoted_text("#/properties/influences")}})},
      {"rigid_bonds", tables(closed("rigid_bonds"))},
      {"dissipation", tables(kinds("kind", dissipations, properties_of(dissipation_pair_options())))},
      {"equilibrate", closed("equilibrate")},
      {"barostat", one_or_tables(closed("barostat"))},
      {"events", tables(closed("events", {{"add", addition()}}))},
      {"minimise", closed("minimise")},
      {"relaxation", closed("relaxation")},
      {"diagnoses", tables(kinds("kind", diagnoses, {}))},
      {"measurements", object({{"$ref", quoted_text("#/properties/diagnoses")}})},
      {"remesh", one_or_tables(closed("remesh"))},
      {"split_cores", one_or_tables(closed("split_cores"))},
      {"outflow", one_or_tables(closed("outflow"))},
      {"output", closed("output", {{"pictures", of_pictures(properties_of(picture_options().only({{"file"}})))}})},
      {"views", of_pictures({{"name", object({{"type", quoted_text("string")}})}})},
      {"sweep", closed("sweep", {{"pictures", tables(closed("sweep.pictures"))}})}};
  for (auto const& scheme : scheme_entries()) {
    Members inner;
    for (auto const& table : scheme.inner)
      inner.push_back({table.name.substr(scheme.told.name.size() + 1), one_or_tables(closed(table.name))});
    properties.push_back({scheme.told.name, closed(scheme.told.name, inner)});
  }
  return object({{"$schema", quoted_text("http://json-schema.org/draft-07/schema#")},
                 {"title", quoted_text("A scenario of Boltzmann")},
                 {"type", quoted_text("object")},
                 {"properties", object(properties)},
                 {"additionalProperties", "false"},
                 {"if", object({{"required", list({"classes"})}})},
                 {"else", object({{"properties", object({{"ensembles", ensembles(false)}})}})}}) +
         "\n";
}

}  // namespace boltzmann
