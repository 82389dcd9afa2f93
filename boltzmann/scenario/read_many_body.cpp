// Reads [embedded_atoms] and [stillinger_weber]: atoms with many-body forces.
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/many_body/embedded_atom_scheme.hpp>
#include <boltzmann/schemes/many_body/many_body_options.hpp>
#include <boltzmann/schemes/many_body/stillinger_weber_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <memory>

namespace boltzmann {
namespace {

/// True if these particles are moved only by forces.
bool moved_by_force(ReadEnsemble const& ensemble) {
  return !ensemble.smooth() && ensemble.particles->influence_size() == std::size_t(ensemble.particles->dimension()) &&
         ensemble.particles->find_field("mass") && ensemble.particles->find_field("velocity");
}

/// Calls add() for the ensembles that `on` names, or for all that forces move.
template <class Add>
void add_atoms(Item const& table, char const* heading, Reading& reading, Add const& add) {
  Section section(table, heading, reading.context);
  auto on = named_ensembles(section.find("on"), "on", reading);
  bool const all = !section.has("on");
  if (all)
    for (auto& ensemble : reading.ensembles) on.push_back({&ensemble, table.place});
  for (auto const& one : on)
    if (!one.ensemble->particles || !one.ensemble->kind) return;
  if (all) std::erase_if(on, [](NamedEnsemble const& one) { return !moved_by_force(*one.ensemble); });
  if (all && on.empty() && !reading.ensembles.empty())
    reading.mistake(table.place, fmt::format("{}: no ensemble is of particles that a force moves; class Newton and "
                                             "those derived from it are",
                                             heading));
  for (auto const& one : on) catch_errors(reading, section.place("on"), [&] { add(*one.ensemble->particles); });
}

/// The element of each ensemble in `elements`.
std::map<std::string, std::string> read_elements(Item const& table, Reading& reading) {
  std::map<std::string, std::string> elements;
  Section section(table, "[embedded_atoms]", reading.context);
  Item const* item = section.find("elements");
  if (!item) return elements;
  if (!item->is(Item::Kind::table)) {
    reading.mistake(item->place,
                    fmt::format("elements: a table is needed, {{ atoms = \"Cu\" }}, not {}", describe(*item)));
    return elements;
  }
  auto const names = reading.ensemble_names();
  for (auto const& entry : item->entries) {
    if (std::find(names.begin(), names.end(), entry.key) == names.end())
      reading.mistake(entry.place, fmt::format("elements: there is no ensemble '{}'{}", boltzmann::quoted(entry.key),
                                               did_you_mean(entry.key, names)));
    else if (auto const element = read_text(entry.item, "elements." + entry.key, reading.context))
      elements[entry.key] = *element;
  }
  return elements;
}

/// A formula of embedded atoms as a function of the variable `of`. Empty, and a mistake, if it is invalid.
std::function<double(double)> read_function(Section& section, char const* key, char const* of, Dimension argument,
                                            Dimension value, std::vector<FormulaParameter> const& parameters,
                                            Reading& reading) {
  Item const* item = section.item(key);
  auto const text = item ? read_text(*item, key, reading.context) : std::nullopt;
  if (!text) return {};
  try {
    FormulaInputs inputs(1, reading.context.units);
    inputs.check_dimensions(reading.base_known && !reading.context.units.is_reduced());
    inputs.add(of, argument);
    for (auto const& parameter : parameters) inputs.define(parameter.name, parameter.value, parameter.dimension);
    auto const formula = std::make_shared<Formula>(inputs.read(*text));
    if (!formula->fits(value) || formula->components() > 1)
      throw FormulaError(
          0, fmt::format("{} is needed; this is {}", dimension_text(value), dimension_text(formula->dimension())));
    return [formula](double x) { return (*formula)({&x, 1}); };
  } catch (FormulaError const& error) {
    formula_mistake(*item, key, error, reading);
    return {};
  }
}

void read_formulas(Section& section, EmbeddedAtomOptions& options, Reading& reading) {
  auto const parameters = read_formula_parameters(section, reading);
  auto const read = [&](char const* key, char const* of, Dimension argument, Dimension value) {
    return read_function(section, key, of, argument, value, parameters, reading);
  };
  options.pair = read("pair", "r", dimensions::length, dimensions::energy);
  options.density = read("density", "r", dimensions::length, dimensions::none);
  options.embedding = read("embedding", "rho", dimensions::none, dimensions::energy);
}

}  // namespace

void read_embedded_atoms(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[embedded_atoms]", reading.context);
  Item const* word = section.need("potential", "potential = \"sutton-chen\"");
  auto const potential = word ? read_word(*word, "potential", metal_potential_words(), reading.context) : std::nullopt;
  if (!potential) {
    for (auto const& key : embedded_atom_options().keys()) section.mark_used(key);
    return;
  }
  EmbeddedAtomOptions options;
  read_options(section, embedded_atom_options(*potential), &options, {.dimension = reading.dimension});
  if (*potential == MetalPotential::formulas) read_formulas(section, options, reading);
  section.finish();
  if (!reading.box || reading.context.mistakes.count() != before) return;
  Place const place = section.has("file") ? section.place("file") : table.place;
  catch_errors(reading, place, [&] {
    auto scheme = std::make_unique<EmbeddedAtomScheme>(*reading.box, embedded_atoms(options, reading.context.units));
    if (options.skin) scheme->skin(*options.skin);
    reading.result->schemes.push_back(std::move(scheme));
  });
}

void add_to_embedded_atoms(Item const& table, Reading& reading) {
  auto* const scheme = reading.result->scheme<EmbeddedAtomScheme>();
  if (!scheme) return;
  auto const& known = scheme->atoms().elements();
  std::size_t const before = reading.context.mistakes.count();
  auto const elements = read_elements(table, reading);
  if (reading.context.mistakes.count() != before) return;
  add_atoms(table, "[embedded_atoms]", reading, [&](AnyEnsemble& ensemble) {
    auto const told = elements.find(ensemble.name());
    bool const by_name =
        std::any_of(known.begin(), known.end(), [&](auto const& element) { return element.name == ensemble.name(); });
    std::string element;
    for (auto const& one : reading.ensembles)
      if (one.particles == &ensemble) element = one.element;
    bool const by_element =
        std::any_of(known.begin(), known.end(), [&](auto const& other) { return other.name == element; });
    scheme->add(ensemble, told != elements.end() ? told->second
                          : by_element           ? element
                          : by_name              ? ensemble.name()
                                                 : "");
  });
}

void read_stillinger_weber(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[stillinger_weber]", reading.context);
  StillingerWeberOptions options;
  read_options(section, stillinger_weber_options(), &options, {.dimension = reading.dimension});
  section.finish();
  if (!reading.box || reading.context.mistakes.count() != before) return;
  catch_errors(reading, table.place, [&] {
    auto scheme = std::make_unique<StillingerWeberScheme>(*reading.box, options.law);
    if (options.skin) scheme->skin(*options.skin);
    reading.result->schemes.push_back(std::move(scheme));
  });
}

void add_to_stillinger_weber(Item const& table, Reading& reading) {
  auto* const scheme = reading.result->scheme<StillingerWeberScheme>();
  if (!scheme) return;
  add_atoms(table, "[stillinger_weber]", reading, [&](AnyEnsemble& ensemble) { scheme->add(ensemble); });
}

}  // namespace boltzmann
