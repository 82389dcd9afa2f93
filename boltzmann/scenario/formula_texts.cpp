// Reads what formulas of a table may use, its parameters and parts, and says where one is wrong.
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

std::vector<FormulaParameter> read_formula_parameters(Section& section, Reading& reading) {
  std::vector<FormulaParameter> parameters;
  Item const* table = section.find("parameters");
  if (!table) return parameters;
  if (!table->is(Item::Kind::table)) {
    reading.mistake(table->place,
                    fmt::format("parameters: a table is needed, {{ depth = \"0.1 eV\" }}, not {}", describe(*table)));
    return parameters;
  }
  for (auto const& [key, place, item] : table->entries) {
    FormulaParameter parameter{key, 0, {}};
    if (!is_formula_name(key)) {
      reading.mistake(place,
                      fmt::format("parameters: '{}' is no name for a formula; letters, digits and _ are", quoted(key)));
      continue;
    }
    if (item.is_number()) {
      parameter.value = item.number;
      if (reading.context.recorder) reading.context.recorder->plain(item, "number");
    } else if (item.is(Item::Kind::text)) {
      auto const& text = item.text;
      bool const good = catch_errors(reading, item.place, [&] {
        parameter.dimension = parse_quantity(text).dimension;
        parameter.value = in_units(text, parameter.dimension, reading.context.units);
      });
      if (!good) continue;
      if (reading.context.recorder) reading.context.recorder->plain(item, "text");
    } else {
      reading.mistake(item.place,
                      fmt::format("parameters.{}: a quantity is needed, \"0.1 eV\", not {}", key, describe(item)));
      continue;
    }
    parameters.push_back(std::move(parameter));
  }
  return parameters;
}

std::vector<FormulaPart> read_formula_parts(Section& section, Reading& reading) {
  std::vector<FormulaPart> parts;
  Item const* table = section.find("where");
  if (!table) return parts;
  if (!table->is(Item::Kind::table)) {
    reading.mistake(table->place, fmt::format("where: a table of formulas is needed, {{ s = \"(sigma/r)^6\" }}, not {}",
                                              describe(*table)));
    return parts;
  }
  for (auto const& [key, place, item] : table->entries) {
    if (!is_formula_name(key)) {
      reading.mistake(place,
                      fmt::format("where: '{}' is no name for a formula; letters, digits and _ are", quoted(key)));
      continue;
    }
    if (auto const text = read_text(item, fmt::format("where.{}", key), reading.context)) parts.push_back({key, *text});
  }
  return parts;
}

void refuse_formula(Section const& section, FormulaLawError const& error, Item const& item, std::string_view key,
                    Reading& reading) {
  for (char const* name : {"where", "parameters"}) {
    Item const* table = section.item(name);
    Entry const* entry = table && table->is(Item::Kind::table) ? table->find(error.part) : nullptr;
    if (!entry) continue;
    std::string const part = fmt::format("{}.{}", name, error.part);
    if (entry->item.is(Item::Kind::text)) return formula_mistake(entry->item, part, error, reading);
    return reading.mistake(entry->place, fmt::format("{}: {}", part, error.what()));
  }
  formula_mistake(item, key, error, reading);
}

}  // namespace boltzmann
