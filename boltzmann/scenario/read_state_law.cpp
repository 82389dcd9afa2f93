// Reads the relation of internal energy and temperature: the heat capacity of mesoparticles.
#include <boltzmann/laws/two_columns.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/field_values.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

constexpr char const* capacity_key = "heat_capacity";
constexpr char const* energy_key = "internal_energy";

std::vector<std::string> classes_with_internal_energy() {
  std::vector<std::string> names;
  for (auto const& kind : particle_classes())
    if (has_internal_energy(kind)) names.push_back(kind.name);
  return names;
}

/// file, and the units of its two columns.
std::optional<StateLaw> read_file(Section& section, Item const& file, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  double const degree = section.quantity("temperature", dimensions::temperature, positive).value_or(1);
  double const unit = section.quantity(capacity_key, dimensions::heat_capacity, positive).value_or(1);
  auto const path = read_path(file, "file", reading.context);
  section.finish();
  if (!path || reading.context.mistakes.count() != before) return std::nullopt;
  std::optional<StateLaw> law;
  catch_errors(reading, file.place, [&] {
    std::vector<double> temperatures, capacities;
    for (auto const& [temperature, capacity] : read_two_columns(*path, "a temperature", "a heat capacity", true)) {
      temperatures.push_back(temperature * degree);
      capacities.push_back(capacity * unit);
    }
    law.emplace(std::move(temperatures), std::move(capacities));
  });
  return law;
}

/// formula, from, to.
std::optional<StateLaw> read_curve(Section& section, Item const& text, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  auto const from = section.need_quantity("from", dimensions::temperature, "from = \"50 K\"", positive);
  auto const to = section.need_quantity("to", dimensions::temperature, "to = \"3000 K\"", positive);
  section.finish();
  if (from && to && !(*from < *to))
    reading.mistake(section.place("to"), fmt::format("to: {} must be above from = {}", *to, *from));
  auto const formula = read_text(text, "formula", reading.context);
  if (!formula || reading.context.mistakes.count() != before || !from || !to) return std::nullopt;
  std::optional<StateLaw> law;
  try {
    FormulaInputs inputs(1, reading.context.units);
    inputs.check_dimensions(reading.base_known && !reading.context.units.is_reduced());
    inputs.add("T", dimensions::temperature);
    inputs.define("kB", reading.boltzmann_constant(), dimensions::heat_capacity);
    Formula capacity = inputs.read(*formula);
    if (!capacity.fits(dimensions::heat_capacity) || capacity.components() > 1)
      throw FormulaError(0, fmt::format("a heat capacity is needed; this is {}", dimension_text(capacity.dimension())));
    catch_errors(reading, text.place, [&] {
      law.emplace([&capacity](double temperature) { return capacity({&temperature, 1}); }, *from, *to);
    });
  } catch (FormulaError const& error) {
    formula_mistake(text, "formula", error, reading);
  }
  return law;
}

}  // namespace

bool has_internal_energy(ParticleClass const& kind) {
  auto const& fields = kind.variants.front().fields;
  return std::any_of(fields.begin(), fields.end(), [](Field const& field) { return field.name == energy_key; });
}

std::optional<StateLaw> read_state_law(Section& ensemble, ParticleClass const& kind, Reading& reading) {
  if (!has_internal_energy(kind)) {
    if (ensemble.has(capacity_key))
      reading.mistake(ensemble.place(capacity_key),
                      fmt::format("heat_capacity: particles of class {} have no internal energy; classes with one: {}",
                                  kind.name, join(classes_with_internal_energy())));
    ensemble.mark_used(capacity_key);
    return std::nullopt;
  }
  Item const* item = ensemble.find(capacity_key);
  if (!item) return std::nullopt;
  std::optional<StateLaw> law;
  if (!item->is(Item::Kind::table)) {
    if (auto const capacity = read_quantity(*item, capacity_key, dimensions::heat_capacity, reading.context, positive))
      catch_errors(reading, item->place, [&] { law.emplace(*capacity); });
    return law;
  }
  Section section(*item, capacity_key, reading.context);
  Item const *file = section.find("file"), *formula = section.find("formula");
  if ((file == nullptr) == (formula == nullptr)) {
    reading.mistake(formula ? formula->place : item->place,
                    "heat_capacity: a number, or a table with 'file' or 'formula' is needed, e.g. { formula = \"16*kB "
                    "+ 0.01*kB*T/(1 K)\", from = \"50 K\", to = \"3000 K\" }");
    return std::nullopt;
  }
  return file ? read_file(section, *file, reading) : read_curve(section, *formula, reading);
}

std::optional<double> read_internal_temperature(Section& ensemble, ParticleClass const& kind, Reading& reading) {
  Item const* item = ensemble.item(energy_key);
  if (!has_internal_energy(kind) || !item || !item->is(Item::Kind::table)) return std::nullopt;
  ensemble.allow(energy_key);
  Section section(*item, energy_key, reading.context);
  auto const temperature =
      section.need_quantity("temperature", dimensions::temperature, "temperature = \"300 K\"", positive);
  section.finish();
  if (!ensemble.has(capacity_key))
    reading.mistake(item->place,
                    fmt::format("internal_energy: which energy belongs to a temperature is known from 'heat_capacity'; "
                                "add e.g. heat_capacity = {}",
                                reading.context.units.is_reduced() ? "16" : "\"16 kB\""));
  return temperature;
}

void find_temperatures(AnyEnsemble& particles, StateLaw const& law) {
  int const energy = particles.field(energy_key).offset, temperature = particles.field("temperature").offset;
  for (std::size_t i = 0; i < particles.size(); ++i)
    particles.row(i)[temperature] = law.temperature(particles.row(i)[energy]);
}

}  // namespace boltzmann
