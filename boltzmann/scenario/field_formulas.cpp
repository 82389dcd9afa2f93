// Reads formulas of fields, and evaluates them.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

ParticleNames formula_names(std::vector<Field> const& fields, int dimension, Reading const& reading) {
  ParticleNames names(fields, dimension, reading.context.units);
  if (!reading.base_known) names.inputs.check_dimensions(false);
  return names;
}
ParticleNames formula_names(int dimension, Reading const& reading) { return formula_names({}, dimension, reading); }

void formula_mistake(Item const& item, std::string_view key, FormulaError const& error, Reading& reading) {
  Place place = item.place;
  bool const in_file = place.override_number < 0;
  if (in_file) {  // columns are characters, not bytes
    place.column += 1;
    for (std::size_t i = 0; i < error.offset; ++i)
      if ((static_cast<unsigned char>(item.text[i]) & 0xC0) != 0x80) ++place.column;
  }
  reading.mistake(place, fmt::format("{}: {}{}", key, error.what(),
                                     in_file ? "" : fmt::format(" (at '{}')", item.text.substr(error.offset))));
}

bool part_mistake(Section& section, FormulaLawError const& error, Reading& reading) {
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

namespace {

bool is_formula_name(std::string_view key) {
  auto const letter = [](char c) { return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || c == '_'; };
  return !key.empty() && letter(key[0]) &&
         std::all_of(key.begin(), key.end(), [&](char c) { return letter(c) || (c >= '0' && c <= '9'); });
}

/// The entries of a table, those whose keys can stand in formulas.
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
      if (reading.context.recorder) reading.context.recorder->plain(item, "number");
    } else if (item.is(Item::Kind::text)) {
      bool const good = catch_errors(reading, item.place, [&] {
        parameter.dimension = parse_quantity(item.text).dimension;
        parameter.value = in_units(item.text, parameter.dimension, reading.context.units);
      });
      if (!good) continue;
      if (reading.context.recorder) reading.context.recorder->plain(item, "text");
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

std::optional<ParticleFormula> read_formula(Item const& item, std::string_view key, ParticleNames const& names,
                                            std::vector<std::string> const& unknown, Reading& reading) {
  if (reading.context.recorder) reading.context.recorder->plain(item, item.is_number() ? "number" : "text");
  if (item.is_number()) return ParticleFormula(fmt::format("({})", item.number), names);
  if (!item.is(Item::Kind::text)) {
    reading.mistake(item.place, fmt::format("{}: a formula in quotes is needed, e.g. \"sin(2*pi*x)\", not {}", key,
                                            describe(item)));
    return std::nullopt;
  }
  try {
    ParticleFormula formula(item.text, names);
    for (auto const input : formula.formula().inputs())
      if (std::find(unknown.begin(), unknown.end(), names.field(input)) != unknown.end())
        throw FormulaError(
            item.text.find(names.field(input)),
            fmt::format("'{}' is not known when particles are loaded; only the fields that the file gives are",
                        names.name(input)));
    return formula;
  } catch (FormulaError const& error) {
    formula_mistake(item, key, error, reading);
    return std::nullopt;
  }
}

std::vector<FieldFormula> read_formulas(Section& section, std::vector<Field> const& fields, bool with_position,
                                        std::vector<std::string> const& unknown, Reading& reading) {
  std::vector<FieldFormula> formulas;
  Item const* table = section.find("formulas");
  if (!table) return formulas;
  if (!table->is(Item::Kind::table)) {
    reading.mistake(
        table->place,
        fmt::format("formulas: a table is needed, {{ velocity = [\"...\", \"...\"] }}, not {}", describe(*table)));
    return formulas;
  }
  Section inner(*table, "formulas", reading.context);
  ParticleNames const names = formula_names(fields, std::max(reading.dimension, 1), reading);
  // In the order of the file: a formula may use what those before it have set.
  for (auto const& field : fields)
    if (field.name != "position" || with_position) inner.allow(field.name);
  inner.finish();
  for (auto const& entry : table->entries) {
    auto const field = std::find_if(fields.begin(), fields.end(), [&](Field const& f) { return f.name == entry.key; });
    if (field == fields.end() || (field->name == "position" && !with_position) || reading.dimension == 0) continue;
    if (section.has(field->name))
      reading.mistake(entry.place, fmt::format("formulas: '{}' stands beside them, too; leave one out", field->name));
    Item const& item = entry.item;
    FieldFormula result{*field, {}, item.place};
    // Where nothing stands yet, a formula can't use what it gives itself, or what comes after it. Densities come first.
    auto const comes_after = [&](Entry const& other) {
      return &other == &entry || (other.key != "density" && (entry.key == "density" || &other > &entry));
    };
    auto const check_known = [&](Formula const& formula) {
      if (with_position) return;
      for (auto const input : formula.inputs())
        for (auto const& other : table->entries)
          if (other.key == names.field(input) && comes_after(other)) {
            reading.mistake(item.place, fmt::format("{}: '{}' is not known yet: only fields whose formulas stand "
                                                    "further left are, and those with values",
                                                    field->name, names.name(input)));
            return;
          }
    };
    auto const count = static_cast<std::size_t>(field->components);
    auto const too_few = [&] {
      reading.mistake(
          item.place,
          fmt::format("{}: {} formulas are needed, one for each component{}, not {}{}", field->name, field->components,
                      field->components == reading.dimension ? ", or one that is a vector" : "", describe(item),
                      item.is(Item::Kind::array) ? fmt::format(" of {}", item.elements.size()) : ""));
    };
    std::vector<Item const*> components;
    if (!item.is(Item::Kind::array))
      components.push_back(&item);
    else if (item.elements.size() == count)
      for (auto const& element : item.elements) components.push_back(&element);
    else
      too_few();
    std::size_t values = 0;
    for (Item const* component : components)
      if (auto formula = read_formula(*component, field->name, names, unknown, reading)) {
        if (!formula->formula().fits(field->dimension)) {
          reading.mistake(component->place, fmt::format("{}: {} is needed, and the formula gives {}", field->name,
                                                        dimension_text(field->dimension),
                                                        dimension_text(formula->formula().dimension())));
          continue;
        }
        if (components.size() > 1 && formula->components() > 1) {
          reading.mistake(component->place,
                          fmt::format("{}: a number is needed for each component, not a vector", field->name));
          continue;
        }
        check_known(formula->formula());
        values += formula->components();
        result.components.push_back(std::move(*formula));
      }
    if (values == count)
      formulas.push_back(std::move(result));
    else if (values > 0 && result.components.size() == components.size())
      too_few();
  }
  return formulas;
}

bool apply(FieldFormula const& formula, AnyEnsemble& particles, std::vector<std::uint32_t> const& which,
           Reading& reading) {
  auto components = formula.components;
  bool const must_be_positive =
      formula.field.name == "mass" || formula.field.name == "density" || formula.field.name == "range";
  std::vector<double> values;
  for (auto const i : which) {
    double* row = particles.row(i);
    values.clear();
    for (auto& component : components) {
      component(row);
      for (std::size_t c = 0; c < component.components(); ++c) values.push_back(component.component(c));
    }
    for (double const value : values) {
      if (std::isfinite(value) && (!must_be_positive || value > 0)) continue;
      std::vector<std::string> at;
      at.reserve(3);
      for (int a = 0; a < particles.dimension(); ++a) at.push_back(fmt::format("{:.6g}", row[a]));
      reading.mistake(formula.place,
                      fmt::format("{}: the formula gives {:.6g} for particle {} at ({}); it must be {}",
                                  formula.field.name, value, i, join(at), must_be_positive ? "positive" : "finite"));
      return false;
    }
    std::copy(values.begin(), values.end(), row + formula.field.offset);
  }
  return true;
}

}  // namespace boltzmann
