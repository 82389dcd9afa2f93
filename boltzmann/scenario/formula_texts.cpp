// Reads the parameters and parts that formulas of a table may use, and reports errors at their places.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {

bool is_formula_name(std::string_view name) {
  auto const letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !name.empty() && letter(name[0]) &&
         std::all_of(name.begin(), name.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

namespace {

/// The entries of a table whose keys are valid names in formulas.
std::vector<Entry const*> named_entries(Section& section, char const* key, char const* example, Reading& reading) {
  std::vector<Entry const*> entries;
  Item const* table = section.find(key);
  if (!table) return entries;
  if (!table->is(Item::Kind::table)) {
    reading.mistake(table->place, fmt::format("{}: {}, not {}", key, example, describe(*table)));
    return entries;
  }
  for (auto const& entry : table->entries) {
    if (is_formula_name(entry.key))
      entries.push_back(&entry);
    else
      reading.mistake(entry.place, fmt::format("{}: '{}' is no name for a formula; letters, digits and _ are", key,
                                               quoted(entry.key)));
  }
  return entries;
}

}  // namespace

std::vector<FormulaParameter> read_formula_parameters(Section& section, Reading& reading) {
  std::vector<FormulaParameter> parameters;
  for (Entry const* entry :
       named_entries(section, "parameters", "a table is needed, { depth = \"0.1 eV\" }", reading)) {
    Item const& item = entry->item;
    FormulaParameter parameter{entry->key, 0, {}};
    if (item.is_number()) {
      parameter.value = item.number;
      if (reading.context.notes) reading.context.notes->plain(item, "number");
    } else if (item.is(Item::Kind::text)) {
      bool const good = catch_errors(reading, item.place, [&] {
        parameter.dimension = parse_quantity(item.text).dimension;
        parameter.value = in_units(item.text, parameter.dimension, reading.context.units);
      });
      if (!good) continue;
      if (reading.context.notes) reading.context.notes->plain(item, "text");
    } else {
      reading.mistake(item.place, fmt::format("parameters.{}: a quantity is needed, \"0.1 eV\", not {}", entry->key,
                                              describe(item)));
      continue;
    }
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

std::vector<FormulaPart> read_formula_parts(Section& section, Reading& reading) {
  std::vector<FormulaPart> parts;
  for (Entry const* entry :
       named_entries(section, "where", "a table of formulas is needed, { s = \"(sigma/r)^6\" }", reading))
    if (auto const text = read_text(entry->item, fmt::format("where.{}", entry->key), reading.context))
      parts.push_back({entry->key, *text});
  return parts;
}

bool part_mistake(Section const& section, FormulaPartError const& error, Reading& reading) {
  for (char const* key : {"where", "parameters"}) {
    Item const* table = section.item(key);
    Entry const* entry = table && !error.part.empty() ? table->find(error.part) : nullptr;
    if (!entry) continue;
    if (entry->item.is(Item::Kind::text))
      formula_mistake(entry->item, fmt::format("{}.{}", key, error.part), error, reading);
    else
      reading.mistake(entry->place, fmt::format("{}.{}: {}", key, error.part, error.what()));
    return true;
  }
  return false;
}

void refuse_formula(Section const& section, FormulaPartError const& error, Item const& item, std::string_view key,
                    Reading& reading) {
  if (!part_mistake(section, error, reading)) formula_mistake(item, key, error, reading);
}

}  // namespace boltzmann
