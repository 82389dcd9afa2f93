// Reads [smooth] and the materials of ensembles: continuum mechanics with smooth particles.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/materials.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/smooth/smooth_options.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <stdexcept>

namespace boltzmann {
namespace {

/// A table in braces under a key; a mistake with the example if it is something else.
Item const* inner_table(Section& section, std::string_view key, std::string_view example, Reading& reading) {
  Item const* item = section.find(key);
  if (!item || item->is(Item::Kind::table)) return item;
  reading.mistake(item->place, fmt::format("{}: a table is needed, {} = {}, not {}", key, key, example, found(*item)));
  return nullptr;
}

// ---- Materials ----

/// The parameters that stand in a table; those that may be missing are left out.
MaterialValues read_values(Section& section, std::string_view what, std::vector<MaterialParameter> const& parameters,
                           Reading& reading) {
  MaterialValues values;
  for (auto const& parameter : parameters) {
    Item const* item = section.find(parameter.name);
    bool const reduced = reading.context.base.is_reduced();
    if (!item && !usual_value(parameter, reduced)) {
      Dimension const dimension = parameter.dimension(std::max(reading.dimension, 1));
      auto const units = example_units(dimension);
      std::string const example = reduced || units.empty() ? fmt::format("{} = 1.4", parameter.name)
                                                           : fmt::format("{} = \"1 {}\"", parameter.name, units[0]);
      reading.mistake(section.place(),
                      fmt::format("{} needs '{}', {}; add e.g. {}", what, parameter.name, parameter.doc, example));
    } else if (item && reading.dimension > 0) {
      if (auto const value = read_quantity(*item, parameter.name, parameter.dimension(reading.dimension),
                                           reading.context, parameter.range))
        values.emplace_back(parameter.name, *value);
    }
  }
  return values;
}

std::vector<PressurePoint> read_points(Item const& item, Reading& reading) {
  auto const wrong = [&](Item const& where) {
    reading.mistake(where.place, fmt::format("points: pairs of a density and a pressure are needed, [[1, 0], [2, 3]], "
                                             "not {}",
                                             found(where)));
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

/// The points of a table; the table itself checks them.
void read_table(Section& section, MaterialChoice& choice, Reading& reading, std::optional<PressureTable>& from_file) {
  Item const *points = section.find("points"), *file = section.find("file");
  if ((points == nullptr) == (file == nullptr)) {
    reading.mistake(points ? points->place : section.place(),
                    "material 'table' needs 'points' or 'file', one of them; e.g. points = [[1, 0], [2, 3]]");
    return;
  }
  if (points) {
    choice.points = read_points(*points, reading);
    return;
  }
  auto const path = read_path(*file, "file", reading.context);
  if (!path) return;
  if (guarded(reading, file->place, [&] { from_file = PressureTable::from_file(*path); }))
    const_cast<Item&>(*file).text = *path;  // the stored scenario must find the file from any folder
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
  choice.parameters = read_values(section, fmt::format("material '{}'", *name), choice.info->parameters, reading);
  std::optional<PressureTable> from_file;
  if (choice.info->tabulated) read_table(section, choice, reading, from_file);
  choice.fluxes = read_values(section, "a material", flux_parameters(), reading);
  if (choice.info->barotropic)
    for (auto const& [key, value] : choice.fluxes)
      if (key == "conductivity" && value > 0)
        reading.mistake(section.place("conductivity"),
                        fmt::format("conductivity: material '{}' has no temperature, so that no heat flows", *name));
  if (Item const* elastic = inner_table(section, "elastic", "{ shear_modulus = 1 }", reading)) {
    if (kind.matter != Matter::solid) {
      reading.mistake(
          section.place("elastic"),
          fmt::format("elastic: particles of class {} have no strength; those of class Solid have", kind.name));
    } else {
      Section inner(*elastic, "elastic", reading.context);
      choice.elastic = read_values(inner, "elastic", elastic_parameters(), reading);
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
  guarded(reading, table->place, [&] {
    bound = from_file ? bind_table(*from_file, choice, kind.matter, reading.dimension)
                      : bind_material(choice, kind.matter, reading.dimension);
  });
  return bound;
}

void read_smooth(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  ReadSmooth& smooth = reading.smooth;
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
  if (reading.run.cutoff)
    reading.mistake(reading.run.cutoff_place,
                    "cutoff: smooth particles act as far as their 'range', a field of the ensembles; leave it out");
  if (reading.run.skin) reading.mistake(reading.run.skin_place, "skin: that of smooth particles stands in [smooth]");
  reading.run.skin_place = section.place("skin");
  if (reading.context.mistakes.count() != before || !reading.box) return;
  guarded(reading, table.place, [&] {
    auto scheme = std::make_unique<SmoothScheme>(*reading.box, options.weight);
    scheme->density_from(options.density);
    scheme->mean_density(options.mean_density);
    scheme->heating(options.heating);
    if (options.artificial_viscosity) scheme->artificial_viscosity(*options.artificial_viscosity);
    if (options.skin) scheme->skin(*options.skin);
    reading.result->smooth = scheme.get();
    reading.result->scheme = std::move(scheme);
  });
}

void load_smooth(Reading& reading) {
  SmoothScheme& scheme = *reading.result->smooth;
  for (auto const& ensemble : reading.ensembles) {
    if (!ensemble.particles || !ensemble.material) return;
    guarded(reading, ensemble.place,
            [&] { scheme.add_material(*ensemble.particles, ensemble.material->kernels, ensemble.material->material); });
  }
  guarded(reading, reading.smooth.heating_place, [&] { scheme.check_heating(); });
  if (reading.context.mistakes.none() && reading.smooth.variable && !reading.ensembles.empty()) try {
      scheme.variable_range(*reading.smooth.variable);
    } catch (std::runtime_error const& failure) {  // of the user's input or of the physics
      reading.mistake(reading.smooth.variable_place, failure.what());
      return;
    }
  for (auto const& ensemble : reading.ensembles) {
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
