// Reads [smooth] and the materials of ensembles: continuum mechanics with smooth particles.
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/materials.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/smooth/smooth_options.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace boltzmann {
namespace {

/// An inline table under a key; a mistake with the example if it is something else.
Item const* inner_table(Section& section, std::string_view key, std::string_view example, Reading& reading) {
  Item const* item = section.find(key);
  if (!item || item->is(Item::Kind::table)) return item;
  reading.mistake(item->place,
                  fmt::format("{}: a table is needed, {} = {}, not {}", key, key, example, describe(*item)));
  return nullptr;
}

// ---- Materials ----

std::vector<PressurePoint> read_points(Item const& item, Reading& reading) {
  auto const wrong = [&](Item const& where) {
    reading.mistake(where.place, fmt::format("points: pairs of a density and a pressure are needed, [[1, 0], [2, 3]], "
                                             "not {}",
                                             describe(where)));
    return std::vector<PressurePoint>{};
  };
  if (!item.is(Item::Kind::array) || item.elements.empty()) return wrong(item);
  std::vector<PressurePoint> points;
  for (auto const& pair : item.elements) {
    if (!pair.is(Item::Kind::array) || pair.elements.size() != 2) return wrong(pair);
    if (reading.dimension == 0) continue;
    Dimension const volume = pow(dimensions::length, reading.dimension);
    auto const density =
        read_quantity(pair.elements[0], "density", dimensions::mass / volume, reading.context, positive);
    auto const pressure = read_quantity(pair.elements[1], "pressure", dimensions::energy / volume, reading.context);
    if (!density || !pressure) return {};
    points.push_back({*density, *pressure});
  }
  return points;
}

/// For a tabulated material.
std::optional<PressureTable> read_table(Section& section, Reading& reading) {
  Item const *points = section.find("points"), *file = section.find("file");
  if ((points == nullptr) == (file == nullptr)) {
    reading.mistake(points ? points->place : section.place(),
                    "material 'table' needs 'points' or 'file', one of them; e.g. points = [[1, 0], [2, 3]]");
    return std::nullopt;
  }
  std::size_t const before = reading.context.mistakes.count();
  auto const path = file ? read_path(*file, "file", reading.context) : std::nullopt;
  auto const read = points ? read_points(*points, reading) : std::vector<PressurePoint>{};
  if (reading.context.mistakes.count() != before || (points && read.empty())) return std::nullopt;
  std::optional<PressureTable> table;
  catch_errors(reading, (file ? file : points)->place,
               [&] { table = file ? PressureTable::from_file(*path) : PressureTable(read); });
  return table;
}

/// For a typed material.
std::optional<FormulaMaterial> read_state_formulas(Section& section, Reading& reading) {
  StateFormulas formulas;
  formulas.units = reading.context.units;
  formulas.dimension = reading.dimension;
  std::size_t const before = reading.context.mistakes.count();
  Item const* items[] = {section.need("pressure", "pressure = \"0.4*density*specific_energy\""),
                         section.find("temperature"), section.find("sound_speed")};
  std::string* const texts[] = {&formulas.pressure, &formulas.temperature, &formulas.sound_speed};
  constexpr char const* keys[] = {"pressure", "temperature", "sound_speed"};
  for (std::size_t k = 0; k < 3; ++k) {
    if (!items[k]) continue;
    if (auto const text = read_text(*items[k], keys[k], reading.context)) *texts[k] = *text;
  }
  if (reading.context.mistakes.count() != before || reading.dimension == 0) return std::nullopt;
  try {
    return FormulaMaterial(formulas);
  } catch (FormulaPartError const& error) {
    for (std::size_t k = 0; k < 3; ++k)
      if (error.part == keys[k]) formula_mistake(*items[k], keys[k], error, reading);
    return std::nullopt;
  }
}

}  // namespace

std::optional<BoundMaterial> read_material(Section& ensemble, ParticleClass const& kind, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  if (!ensemble.has("material")) {
    ensemble.need("material", "material = { kind = \"ideal-gas\", gamma = 1.4 }");
    return std::nullopt;
  }
  Item const* table = inner_table(ensemble, "material", "{ kind = \"ideal-gas\", gamma = 1.4 }", reading);
  if (!table) return std::nullopt;
  Section section(*table, "material", reading.context);
  Item const* word = section.need("kind", "kind = \"ideal-gas\"");
  std::vector<std::string> names;
  for (auto const& material : material_catalogue()) names.emplace_back(material.name);
  auto const name = word ? read_word(*word, "material", names, reading.context) : std::nullopt;
  if (!name) return std::nullopt;
  section.rename(fmt::format("material '{}'", *name));
  MaterialChoice choice;
  choice.info = find_material(*name);
  section.explain_word("kind", choice.info->doc);
  auto const parameters =
      read_parameters(section, fmt::format("material '{}'", *name), choice.info->parameters, reading);
  if (parameters) choice.parameters = *parameters;
  if (choice.info->tabulated) choice.table = read_table(section, reading);
  if (choice.info->typed) choice.formulas = read_state_formulas(section, reading);
  if (auto const fluxes = read_parameters(section, "a material", flux_parameters(), reading)) choice.fluxes = *fluxes;
  if (choice.info->barotropic && !choice.fluxes.empty() && value_of(choice.fluxes, "conductivity").front() > 0)
    reading.mistake(section.place("conductivity"),
                    fmt::format("conductivity: material '{}' has no temperature, so that no heat flows", *name));
  if (Item const* elastic = inner_table(section, "elastic", "{ shear_modulus = 1 }", reading)) {
    if (kind.matter != Matter::solid) {
      reading.mistake(
          section.place("elastic"),
          fmt::format("elastic: particles of class {} have no strength; those of class Solid have", kind.name));
    } else {
      Section inner(*elastic, "elastic", reading.context);
      if (auto const strength = read_parameters(inner, "elastic", elastic_parameters(), reading))
        choice.elastic = *strength;
      inner.finish();
    }
  } else if (kind.matter == Matter::solid && !section.has("elastic")) {
    reading.mistake(table->place,
                    "the material of a solid needs 'elastic', its strength; add e.g. elastic = { "
                    "shear_modulus = 1 }");
  }
  section.finish();
  if (reading.context.mistakes.count() != before || reading.dimension == 0) return std::nullopt;
  std::optional<BoundMaterial> bound;
  catch_errors(reading, table->place, [&] { bound = bind_material(choice, kind.matter, reading.dimension); });
  return bound;
}

void read_smooth(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  ReadSmooth& smooth = reading.smooth;
  smooth.wanted = true;
  Section section(table, "[smooth]", reading.context);
  SmoothOptions options;
  read_options(section, smooth_options(), &options, {.dimension = reading.dimension});
  smooth.heating_place = section.place("heating");
  smooth.variable_place = section.place("variable_range");
  smooth.variable = options.variable_range;
  if (smooth.variable && smooth.variable->longest > 0 && smooth.variable->longest < smooth.variable->shortest)
    reading.mistake(
        section.item("variable_range")->find("longest")->item.place,
        fmt::format("longest: {} is below shortest = {}", smooth.variable->longest, smooth.variable->shortest));
  read_rezone(section, reading);
  section.finish();
  smooth.from_continuity = options.density != DensityFrom::summation;
  if (smooth.from_continuity && smooth.variable)
    reading.mistake(smooth.variable_place,
                    "variable_range: ranges follow densities that are summed; with density = \"continuity\" they stay");
  smooth.skin_place = section.place("skin");
  if (reading.context.mistakes.count() != before || !reading.box) return;
  catch_errors(reading, table.place, [&] {
    auto scheme = std::make_unique<SmoothScheme>(*reading.box, options.weight);
    scheme->density_from(options.density);
    scheme->mean_density(options.mean_density);
    scheme->heating(options.heating);
    if (options.artificial_viscosity) scheme->artificial_viscosity(*options.artificial_viscosity);
    if (options.skin) scheme->skin(*options.skin);
    reading.result->schemes.push_back(std::move(scheme));
  });
}

void add_to_smooth(Item const& table, Reading& reading) {
  auto* const found = reading.result->scheme<SmoothScheme>();
  if (!found) return;
  SmoothScheme& scheme = *found;
  std::vector<ReadEnsemble const*> matter;
  for (auto const& ensemble : reading.ensembles) {
    if (ensemble.kind ? ensemble.smooth() && (!ensemble.particles || !ensemble.material) : true) return;
    if (ensemble.smooth()) matter.push_back(&ensemble);
  }
  if (matter.empty() && !reading.ensembles.empty())
    return reading.mistake(table.place, "[smooth]: no ensemble is of smooth particles; classes Smooth and Solid are");
  for (auto const* one : matter) {
    ReadEnsemble const& ensemble = *one;
    catch_errors(reading, ensemble.place, [&] {
      scheme.add_material(*ensemble.particles, ensemble.material->kernels, ensemble.material->material);
    });
  }
  catch_errors(reading, reading.smooth.heating_place, [&] { scheme.check_heating(); });
  if (reading.context.mistakes.none() && reading.smooth.variable && !matter.empty()) try {
      scheme.variable_range(*reading.smooth.variable);
    } catch (std::runtime_error const& failure) {  // an error of the user's input or of the physics
      reading.mistake(reading.smooth.variable_place, failure.what());
      return;
    }
  for (auto const* one : matter) {
    ReadEnsemble const& ensemble = *one;
    auto const ranges = ensemble.particles->column(ensemble.particles->field("range"));
    for (int a = 0; a < reading.dimension && !ranges.empty(); ++a) {
      double const longest = *std::max_element(ranges.begin(), ranges.end()), length = reading.box->length(a);
      if (reading.box->boundary(a) == Boundary::open || longest <= length) continue;
      reading.mistake(ensemble.range_place,
                      fmt::format("range: {} is longer than axis {} of the box, which allows at most {}", longest,
                                  "xyz"[a], length));
      break;
    }
  }
}

}  // namespace boltzmann
