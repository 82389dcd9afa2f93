// Reads fields of particles.
#include <boltzmann/scenario/field_values.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

/// A field of `count` particles (0: unknown), or of the `molecule` particles of each molecule.
std::optional<FieldValue> read_field(Item const& item, Field const& field, std::size_t count, std::size_t molecule,
                                     Reading& reading) {
  ReadContext& context = reading.context;
  bool const is_vector = field.components > 1;
  auto const wrong_count = [&](std::size_t n) {
    context.mistakes.add(
        item.place, fmt::format("{}: {} value{} for {} particle{}; give one for all, or one for each{}", field.name, n,
                                n == 1 ? "" : "s", count, count == 1 ? "" : "s",
                                molecule > 0 ? fmt::format(", or {} for the particles of a molecule", molecule) : ""));
    return std::nullopt;
  };
  if (!item.is(Item::Kind::array)) {
    if (is_vector) {
      read_vector(item, field.name, field.components, field.dimension, context);  // reports what is wrong
      return std::nullopt;
    }
    auto const value = read_quantity(item, field.name, field.dimension, context);
    return value ? std::optional(FieldValue{field, false, {*value}}) : std::nullopt;
  }
  bool const nested = !item.elements.empty() && item.elements.front().is(Item::Kind::array);
  if (nested || (!is_vector && item.elements.size() != 1)) {
    bool const of_molecule = molecule > 0 && item.elements.size() == molecule;
    if (count > 0 && item.elements.size() != count && !of_molecule) return wrong_count(item.elements.size());
    FieldValue result{field, true, {}};
    for (auto const& element : item.elements) {
      if (nested) {
        auto const values = read_vector(element, field.name, field.components, field.dimension, context);
        if (!values) return std::nullopt;
        result.values.insert(result.values.end(), values->begin(), values->end());
      } else {
        auto const value = read_quantity(element, field.name, field.dimension, context);
        if (!value) return std::nullopt;
        result.values.push_back(*value);
      }
    }
    return result;
  }
  auto const values = read_vector(item, field.name, field.components, field.dimension, context);
  return values ? std::optional(FieldValue{field, false, *values}) : std::nullopt;
}

}  // namespace

std::vector<Field> fields_of(ParticleClass const& kind, int dimension) {
  ClassVariant const* variant = kind.in(dimension);
  return variant ? variant->fields : kind.variants.front().fields;
}

bool is_found(ParticleClass const& kind, std::string_view field) {
  if (field == "temperature" && has_internal_energy(kind)) return true;
  return kind.matter != Matter::none && (field == "pressure" || field == "temperature" || field == "sound_speed");
}

std::vector<Field> given_fields(ParticleClass const& kind, int dimension) {
  auto fields = fields_of(kind, dimension);
  std::erase_if(fields, [&](Field const& field) { return is_found(kind, field.name); });
  return fields;
}

std::vector<FieldValue> read_fields(Section& section, std::vector<Field> const& fields, bool with_position,
                                    std::size_t count, Reading& reading, std::size_t molecule) {
  std::vector<FieldValue> values;
  for (auto const& field : fields) {
    if (field.name == "position" && !with_position) continue;
    Item const* item = section.find(field.name);
    section.explain({field.name,
                     field.components > 1 ? option::vector(field.dimension) : option::number(field.dimension),
                     field.doc,
                     "",
                     "",
                     {}},
                    "", field.dimension);
    if (item && reading.dimension > 0)
      if (auto value = read_field(*item, field, count, molecule, reading)) values.push_back(std::move(*value));
  }
  return values;
}

void check_positive(Section const& section, std::vector<FieldValue> const& values, ParticleClass const& kind,
                    Reading& reading) {
  for (auto const& value : values)
    for (char const* key : {"mass", "density", "range"})
      if (value.field.name == key && (value.field.name == "mass" || kind.matter != Matter::none)) {
        if (Item const* item = section.item(key); item && reading.context.notes)
          reading.context.notes->narrow(*item, positive);
        for (double const number : value.values)
          if (!(number > 0)) {
            reading.mistake(section.place(key),
                            fmt::format("{}: {} is out of range; it must be positive", key, number));
            break;
          }
      }
}

bool gives(Section const& section, std::string_view field) {
  if (section.has(field)) return true;
  Item const* formulas = section.item("formulas");
  return formulas && formulas->find(field);
}

void apply(FieldValue const& value, AnyEnsemble& particles, std::vector<std::uint32_t> const& which) {
  auto const components = static_cast<std::size_t>(value.field.components);
  std::size_t const count = value.values.size() / components;
  for (std::size_t k = 0; k < which.size(); ++k)
    std::copy_n(value.values.data() + (value.each ? k % count * components : 0), components,
                particles.row(which[k]) + value.field.offset);
}

}  // namespace boltzmann
