// Parses and evaluates formulas of fields.
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

std::optional<ParticleFormula> read_formula(Item const& item, std::string_view key, ParticleNames const& names,
                                            std::vector<std::string> const& unknown, Reading& reading) {
  if (reading.context.notes) reading.context.notes->plain(item, item.is_number() ? "number" : "text");
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

namespace {

/// The formulas of one field: all in its item.
class FormulasOfField {
 public:
  FormulasOfField(Item const& table, Entry const& entry, Field const& field, ParticleNames const& names,
                  Reading& reading)
      : table_(table), entry_(entry), field_(field), names_(names), reading_(reading) {}

  /// Returns nothing, and adds mistakes, if one is invalid. While some fields are unknown, formulas may only use
  /// earlier ones.
  std::optional<FieldFormula> read(std::vector<std::string> const& unknown, bool fields_known) {
    FieldFormula result{field_, {}, item().place};
    auto const count = static_cast<std::size_t>(field_.components);
    auto const components = items(count);
    std::size_t values = 0;
    for (Item const* component : components)
      if (auto formula = read_formula(*component, field_.name, names_, unknown, reading_)) {
        if (!fits(*formula, *component, components.size())) continue;
        if (!fields_known) check_known(formula->formula());
        values += formula->components();
        result.components.push_back(std::move(*formula));
      }
    if (values == count) return result;
    if (values > 0 && result.components.size() == components.size()) too_few();
    return std::nullopt;
  }

 private:
  Item const& item() const { return entry_.item; }

  std::vector<Item const*> items(std::size_t count) {
    std::vector<Item const*> all;
    if (!item().is(Item::Kind::array))
      all.push_back(&item());
    else if (item().elements.size() == count)
      for (auto const& element : item().elements) all.push_back(&element);
    else
      too_few();
    return all;
  }

  bool fits(ParticleFormula const& formula, Item const& item, std::size_t of) {
    if (!formula.formula().fits(field_.dimension)) {
      reading_.mistake(item.place,
                       fmt::format("{}: {} is needed, and the formula gives {}", field_.name,
                                   dimension_text(field_.dimension), dimension_text(formula.formula().dimension())));
      return false;
    }
    if (of > 1 && formula.components() > 1) {
      reading_.mistake(item.place, fmt::format("{}: a number is needed for each component, not a vector", field_.name));
      return false;
    }
    return true;
  }

  /// Before the field has values, a formula can't use its own results, or those of later formulas. Densities come
  /// first.
  bool comes_after(Entry const& other) const {
    return &other == &entry_ || (other.key != "density" && (entry_.key == "density" || &other > &entry_));
  }
  void check_known(Formula const& formula) {
    for (auto const input : formula.inputs())
      for (auto const& other : table_.entries)
        if (other.key == names_.field(input) && comes_after(other)) {
          reading_.mistake(item().place, fmt::format("{}: '{}' is not known yet: a formula may use only fields with "
                                                     "values, and those whose formulas are further left",
                                                     field_.name, names_.name(input)));
          return;
        }
  }
  void too_few() {
    reading_.mistake(
        item().place,
        fmt::format("{}: {} formulas are needed, one for each component{}, not {}{}", field_.name, field_.components,
                    field_.components == reading_.dimension ? ", or one that is a vector" : "", describe(item()),
                    item().is(Item::Kind::array) ? fmt::format(" of {}", item().elements.size()) : ""));
  }

  Item const& table_;
  Entry const& entry_;
  Field const& field_;
  ParticleNames const& names_;
  Reading& reading_;
};

}  // namespace

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
  // In the order of the file, because a formula may use fields set by earlier ones.
  for (auto const& field : fields)
    if (field.name != "position" || with_position) inner.allow(field.name);
  inner.finish();
  for (auto const& entry : table->entries) {
    auto const field = std::find_if(fields.begin(), fields.end(), [&](Field const& f) { return f.name == entry.key; });
    if (field == fields.end() || (field->name == "position" && !with_position) || reading.dimension == 0) continue;
    if (section.has(field->name))
      reading.mistake(entry.place, fmt::format("formulas: '{}' also has a value; leave one out", field->name));
    if (auto all = FormulasOfField(*table, entry, *field, names, reading).read(unknown, with_position))
      formulas.push_back(std::move(*all));
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
