// Reads formulas of fields, and evaluates them.
#include <boltzmann/files/export.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {

FormulaNames::FormulaNames(int dimension) : dimension_(dimension) {
  for (int a = 0; a < dimension; ++a) {
    names_.emplace_back(1, "xyz"[a]);
    offsets_.push_back(a);
  }
  names_.emplace_back("r");
  offsets_.push_back(-1);
  fields_.resize(names_.size());
  values_.resize(names_.size());
}

FormulaNames::FormulaNames(std::vector<Field> const& fields, int dimension) : FormulaNames(dimension) {
  auto const add = [&](Field const& field, std::string const& name, int component) {
    if (std::find(names_.begin(), names_.end(), name) != names_.end()) return;
    names_.push_back(name);
    fields_.push_back(field.name);
    offsets_.push_back(field.offset + component);
  };
  for (auto const& field : fields) {
    if (field.components == 1) add(field, field.name, 0);
    if (field.components == 1 && field.name != "position" && field.name != "velocity") continue;
    auto const words = component_words(field.components, dimension);
    for (std::size_t c = 0; c < words.size(); ++c) add(field, field.name + "." + words[c], static_cast<int>(c));
  }
  values_.resize(names_.size());
}

double FormulaNames::evaluate(Formula const& formula, double const* row) {
  for (std::size_t const name : formula.used()) {
    if (offsets_[name] >= 0) {
      values_[name] = row[offsets_[name]];
      continue;
    }
    double r2 = 0;
    for (int a = 0; a < dimension_; ++a) r2 += row[a] * row[a];
    values_[name] = std::sqrt(r2);
  }
  return formula(values_);
}

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

std::optional<Formula> read_formula(Item const& item, std::string_view key, FormulaNames const& names,
                                    std::vector<std::string> const& unknown, Reading& reading) {
  if (reading.context.recorder) reading.context.recorder->plain(item, item.is_number() ? "number" : "text");
  if (item.is_number()) return Formula(fmt::format("({})", item.number), names.names());
  if (!item.is(Item::Kind::text)) {
    reading.mistake(item.place, fmt::format("{}: a formula in quotes is needed, e.g. \"sin(2*pi*x)\", not {}", key,
                                            describe(item)));
    return std::nullopt;
  }
  try {
    Formula formula(item.text, names.names());
    for (std::size_t const name : formula.used())
      if (std::find(unknown.begin(), unknown.end(), names.field(name)) != unknown.end())
        throw FormulaError(
            item.text.find(names.names()[name]),
            fmt::format("'{}' is not known when particles are loaded; only the fields that the file gives are",
                        names.names()[name]));
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
  FormulaNames const names(fields, std::max(reading.dimension, 1));
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
      for (std::size_t const name : formula.used())
        for (auto const& other : table->entries)
          if (other.key == names.field(name) && comes_after(other)) {
            reading.mistake(item.place, fmt::format("{}: '{}' is not known yet: only fields whose formulas stand "
                                                    "further left are, and those with values",
                                                    field->name, names.names()[name]));
            return;
          }
    };
    std::vector<Item const*> components;
    if (field->components == 1 && !item.is(Item::Kind::array))
      components.push_back(&item);
    else if (item.is(Item::Kind::array) && item.elements.size() == static_cast<std::size_t>(field->components))
      for (auto const& element : item.elements) components.push_back(&element);
    else
      reading.mistake(
          item.place,
          fmt::format("{}: {} formulas are needed, one for each component, not {}{}", field->name, field->components,
                      describe(item), item.is(Item::Kind::array) ? fmt::format(" of {}", item.elements.size()) : ""));
    for (Item const* component : components)
      if (auto formula = read_formula(*component, field->name, names, unknown, reading)) {
        check_known(*formula);
        result.components.push_back(std::move(*formula));
      }
    if (result.components.size() == static_cast<std::size_t>(field->components)) formulas.push_back(std::move(result));
  }
  return formulas;
}

bool apply(FieldFormula const& formula, AnyEnsemble& particles, std::vector<std::uint32_t> const& which,
           Reading& reading) {
  FormulaNames names(particles.fields(), particles.dimension());
  bool const must_be_positive =
      formula.field.name == "mass" || formula.field.name == "density" || formula.field.name == "range";
  std::vector<double> values(formula.components.size());
  for (auto const i : which) {
    double* row = particles.row(i);
    for (std::size_t c = 0; c < values.size(); ++c) {
      double const value = names.evaluate(formula.components[c], row);
      values[c] = value;
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
