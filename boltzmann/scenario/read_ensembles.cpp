// Reads [[ensembles]]: which particles there are, and in what state.
#include <boltzmann/diagnoses/colour.hpp>
#include <boltzmann/loaders/fields.hpp>
#include <boltzmann/loaders/internal_energy_load.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/ripple_load.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/field_values.hpp>
#include <boltzmann/scenario/frozen.hpp>
#include <boltzmann/scenario/loader.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/smooth_fields.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <numeric>

namespace boltzmann {
namespace {

std::vector<std::uint32_t> everyone(AnyEnsemble const& particles) {
  std::vector<std::uint32_t> all(particles.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

void read_ensemble(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Entry const* name_entry = table.find("name");
  Section section(table,
                  name_entry && name_entry->item.is(Item::Kind::text) ? "[[ensembles]] '" + name_entry->item.text + "'"
                                                                      : "[[ensembles]]",
                  reading.context);
  ReadEnsemble ensemble;
  ensemble.place = table.place;
  Item const* name_item = section.need("name", "name = \"atoms\"");
  auto const name = name_item ? read_text(*name_item, "name", reading.context) : std::nullopt;
  if (name) {
    ensemble.name = *name;
    if (name->empty()) reading.mistake(name_item->place, "name: an ensemble needs a name, not an empty text");
    for (auto const& other : reading.ensembles)
      if (other.name == *name && !name->empty())
        reading.mistake(name_item->place, fmt::format("name: there is an ensemble '{}' already, in line {}; names must "
                                                      "differ",
                                                      *name, other.place.line));
  }

  Item const* class_item = section.need("class", "class = \"Newton\"");
  std::vector<std::string> class_names;
  for (auto const& entry : particle_classes()) class_names.push_back(entry.name);
  auto const class_name = class_item ? read_word(*class_item, "class", class_names, reading.context) : std::nullopt;
  ParticleClass const* kind = class_name ? find_class(*class_name) : nullptr;
  ensemble.kind = kind;
  ClassVariant const* variant = kind ? kind->in(reading.dimension) : nullptr;
  if (kind && !variant && reading.dimension > 0) {
    std::vector<std::string> spaces;
    for (auto const& v : kind->variants) spaces.push_back(std::to_string(v.dimension) + "D");
    reading.mistake(class_item->place,
                    fmt::format("class {} lives in {}; the box has {} dimension{}", kind->name, join(spaces, " or "),
                                reading.dimension, reading.dimension == 1 ? "" : "s"));
  }

  Item const* method_item = section.find("integrator");
  auto const method_word =
      method_item ? read_word(*method_item, "integrator", method_words(), reading.context) : std::nullopt;
  Place const method_place = method_item ? method_item->place : table.place;

  std::optional<std::size_t> number;
  if (Item const* item = section.find("number"))
    number = static_cast<std::size_t>(
        read_integer(*item, "number", 1, std::numeric_limits<std::int64_t>::max(), reading.context).value_or(0));

  Appearance appearance;
  if (Item const* item = section.find("colour"))
    if (auto const colour = read_text(*item, "colour", reading.context))
      if (guarded(reading, item->place, [&] { colour_named(*colour); })) appearance.colour = *colour;
  appearance.diameter = section.quantity("diameter", dimensions::length, not_negative).value_or(0);

  // The loader comes before the fields: it knows how many particles there are.
  Item const* load_item = section.need("load", "load = { kind = \"random\" }");
  std::optional<Loader> loader;
  bool loadable = false;
  if (load_item) {
    ensemble.load_place = load_item->place;
    if (load_item->is(Item::Kind::table)) {
      loader.emplace(*load_item, reading, variant);
      loadable = loader->read(number, section.place("number"));
    } else {
      reading.mistake(load_item->place,
                      fmt::format("load: a table is needed, {{ kind = \"block\", ... }}, not {}", found(*load_item)));
    }
  }
  std::size_t const count = loadable ? loader->count() : 0;

  std::vector<FieldValue> fields;
  std::vector<FieldFormula> formulas;
  std::optional<double> internal_temperature;
  if (kind) {
    ensemble.state = read_state_law(section, *kind, reading);
    internal_temperature = read_internal_temperature(section, *kind, reading);
    if (section.has("position"))
      reading.mistake(table.find("position")->place,
                      "positions are loaded: load = { kind = \"positions\", positions = [...] }");
    refuse_found(section, *kind, reading);
    auto given = given_fields(*kind, reading.dimension);
    if (Item const* item = section.item("internal_energy"); item && item->is(Item::Kind::table))
      std::erase_if(given, [](Field const& field) { return field.name == "internal_energy"; });
    fields = read_fields(section, given, false, count, reading);
    formulas =
        read_formulas(section, fields_of(*kind, reading.dimension), false, unknown_fields(section, *kind), reading);
    for (auto const& formula : formulas)
      if (is_found(*kind, formula.field.name))
        reading.mistake(
            formula.place,
            kind->matter != Matter::none
                ? fmt::format("{}: the material finds it from density and specific_energy", formula.field.name)
                : fmt::format("{}: it follows from internal_energy and heat_capacity", formula.field.name));
    section.know("position");
    check_positive(section, fields, *kind, reading);
  }
  bool const smooth = kind && kind->matter != Matter::none;
  ensemble.range_place = section.place(section.has("range") ? "range" : "formulas");
  if (smooth) check_smooth(section, loader ? loader->volume() : std::nullopt, loadable, reading);
  if (kind && smooth != reading.smooth.wanted)
    reading.mistake(class_item->place, smooth
                                           ? fmt::format("class {} needs the scheme of smooth particles; add a table "
                                                         "[smooth]",
                                                         kind->name)
                                           : fmt::format("class {} is none of smooth particles, which [smooth] is "
                                                         "for: {}",
                                                         kind->name, "Smooth, Solid"));
  if (smooth) ensemble.material = read_material(section, *kind, reading);
  Item const* temperature_item = smooth ? nullptr : section.find("temperature");
  auto const temperature =
      smooth ? std::nullopt : section.quantity("temperature", dimensions::temperature, not_negative);
  MaxwellianOptions thermal;
  if (!smooth) {
    thermal.remove_drift = section.boolean("remove_drift");
    thermal.exact_temperature = section.boolean("exact_temperature");
    thermal.quiet = section.boolean("quiet");
  }
  if (Item const* item = smooth ? nullptr : section.find("drift"); item && reading.dimension > 0)
    if (auto const drift = read_vector(*item, "drift", reading.dimension, dimensions::velocity, reading.context))
      std::copy(drift->begin(), drift->end(), thermal.drift.begin());
  for (char const* key : {"drift", "remove_drift", "exact_temperature", "quiet"})
    if (section.has(key) && !temperature_item && !smooth)
      reading.mistake(section.place(key), fmt::format("{}: it belongs to 'temperature', which is missing", key));
  if (temperature_item && section.has("velocity"))
    reading.mistake(section.place("velocity"),
                    "velocity: 'temperature' gives the velocities; for a common one on top "
                    "write 'drift'");

  Item const* ripple_item = section.find("velocity_ripple");
  VelocityRipple const ripple = ripple_item ? read_velocity_ripple(*ripple_item, reading) : VelocityRipple{};

  auto const volume = loader ? loader->volume() : std::nullopt;
  bool const density_gives_mass = smooth && volume && gives(section, "density") && !gives(section, "mass");

  // From here on there are particles, if everything so far is right.
  AnyEnsemble* particles = nullptr;
  if (variant && loadable && reading.box && reading.context.mistakes.count() == before) {
    reading.result->ensembles.push_back(variant->make(ensemble.name, count));
    particles = reading.result->ensembles.back().get();
    particles->appearance = appearance;
    auto const all = everyone(*particles);
    for (auto const& value : fields) apply(value, *particles, all);  // loaders look at masses
    bool good = guarded(reading, ensemble.load_place, [&] { loader->load(*particles); });
    for (auto const& value : fields) apply(value, *particles, all);
    if (smooth && volume && reading.smooth.variable && !gives(section, "range"))
      set_ranges(*particles, *volume, reading.smooth.variable->spacings);
    if (internal_temperature && ensemble.state && good)
      good = guarded(reading, section.place("internal_energy"), [&] {
        internal_energy_load(*particles, *ensemble.state, *internal_temperature, reading.boltzmann_constant(),
                             reading.run.seed);
      });
    // The density goes before: from it follow masses, and other formulas may use both.
    for (bool const density : {true, false}) {
      for (auto const& formula : formulas)
        if (good && density == (formula.field.name == "density")) good = apply(formula, *particles, all, reading);
      if (density && good && density_gives_mass) set_masses(*particles, *volume, all);
    }
    if (temperature && good)
      good = guarded(reading, temperature_item->place, [&] {
        maxwellian_load(*particles, *temperature, reading.boltzmann_constant(), reading.run.seed, thermal);
      });
    if (ripple_item && good)
      good = guarded(reading, ripple_item->place, [&] {
        velocity_ripple(*particles, *reading.box, ripple.wave, ripple.amplitude, ripple.component);
      });
    Field const* anchor = particles->find_field("anchor");
    if (anchor && !section.has("anchor"))
      for (std::size_t i = 0; i < count; ++i)
        std::copy_n(particles->row(i), anchor->components, particles->row(i) + anchor->offset);
    if (!good) particles = nullptr;
  }

  std::vector<std::uint32_t> frozen;
  for (Item const* set_table : find_tables(section, "set")) {
    Section set(*set_table, "[[ensembles.set]]", reading.context);
    auto const which = read_particles(set, particles, reading);
    if (!set.has("particles") && !set.has("where"))
      reading.mistake(set.place(),
                      "[[ensembles.set]] has no 'particles'; add e.g. particles = [0], \"edge\" or "
                      "\"all\", or where = \"x < 1\"");
    bool const freeze = set.boolean("freeze");
    std::vector<FieldValue> values;
    std::vector<FieldFormula> set_formulas;
    if (kind) {
      refuse_found(set, *kind, reading);
      auto const given = given_fields(*kind, reading.dimension);
      values = read_fields(set, given, true, which ? which->size() : 0, reading);
      check_positive(set, values, *kind, reading);
      if (smooth && gives(set, "density") && !density_gives_mass && !reading.smooth.from_continuity)
        reading.mistake(set.place(set.has("density") ? "density" : "formulas"),
                        "density: it is the sum over the masses around a particle; give 'mass' here, or 'density' "
                        "in [[ensembles]]");
      set_formulas = read_formulas(set, given, true, unknown_fields(section, *kind), reading);
    }
    if (kind) set.finish();
    if (!particles || !which || reading.context.mistakes.count() != before) continue;
    for (auto const& value : values) apply(value, *particles, *which);
    for (auto const& formula : set_formulas)
      if (!apply(formula, *particles, *which, reading)) break;
    if (density_gives_mass && gives(set, "density") && !gives(set, "mass")) set_masses(*particles, *volume, *which);
    if (freeze) frozen.insert(frozen.end(), which->begin(), which->end());
  }
  if (kind) section.finish();

  Method const method = method_word.value_or(kind ? kind->usual_method : Method::leap_frog);
  // Whether the class can be advanced that way is known without particles, too.
  if (variant && (method_word || !method_item)) {
    std::unique_ptr<AnyEnsemble> nobody;
    if (!particles) nobody = variant->make(ensemble.name, 0);
    guarded(reading, method_place,
            [&] { ensemble.integrator = variant->integrate(particles ? *particles : *nobody, method); });
    if (nobody) ensemble.integrator.reset();
  }
  if (particles && ensemble.integrator && !frozen.empty()) {
    std::sort(frozen.begin(), frozen.end());
    frozen.erase(std::unique(frozen.begin(), frozen.end()), frozen.end());
    if (Field const* velocity = particles->find_field("velocity"))
      for (auto const i : frozen) std::fill_n(particles->row(i) + velocity->offset, velocity->components, 0.0);
    ensemble.integrator = std::make_unique<Frozen>(*particles, frozen, std::move(ensemble.integrator));
  }
  if (particles && ensemble.state) find_temperatures(*particles, *ensemble.state);
  if (particles) guarded(reading, ensemble.load_place, [&] { reading.box->check(*particles); });
  ensemble.particles = reading.context.mistakes.count() == before ? particles : nullptr;
  if (loader && !loader->file().empty()) {
    // The stored scenario must find the file from any folder.
    Item& load = const_cast<Item&>(*load_item);
    load.find("path")->item.text = loader->file();
  }
  reading.ensembles.push_back(std::move(ensemble));
}

}  // namespace

std::optional<std::vector<std::uint32_t>> read_particles(Section& section, AnyEnsemble const* ensemble,
                                                         Reading& reading) {
  Item const* margin_item = section.find("margin");
  auto const margin = section.quantity("margin", dimensions::length, not_negative);
  Item const* item = section.find("particles");
  if (Item const* where = section.find("where")) {
    if (item) reading.mistake(where->place, "where: 'particles' says which, too; leave one out");
    if (item || !ensemble) return std::nullopt;
    FormulaNames names(ensemble->fields(), ensemble->dimension());
    auto const formula = read_formula(*where, "where", names, {}, reading);
    if (!formula) return std::nullopt;
    std::vector<std::uint32_t> which;
    for (std::size_t i = 0; i < ensemble->size(); ++i)
      if (names.evaluate(*formula, ensemble->row(i)) != 0) which.push_back(static_cast<std::uint32_t>(i));
    return which;
  }
  if (!item) return std::nullopt;
  bool const edge = item->is(Item::Kind::text) && item->text == "edge";
  if (margin_item && !edge) reading.mistake(margin_item->place, "margin: it belongs to particles = \"edge\"");
  if (item->is(Item::Kind::text)) {
    auto const word = read_word(*item, "particles", {"all", "edge"}, reading.context);
    if (!word) return std::nullopt;
    if (edge && !margin_item) {
      reading.mistake(item->place,
                      "particles = \"edge\" needs a 'margin': those nearer than it to a face of the block "
                      "that encloses all, e.g. margin = \"1.5 angstrom\"");
      return std::nullopt;
    }
    if (!ensemble || (edge && !margin)) return std::nullopt;
    return edge ? edge_particles(*ensemble, *margin) : everyone(*ensemble);
  }
  if (!item->is(Item::Kind::array)) {
    reading.mistake(item->place,
                    fmt::format("particles: an array of numbers, \"edge\" or \"all\" is needed, not {}", found(*item)));
    return std::nullopt;
  }
  std::vector<std::uint32_t> which;
  for (auto const& element : item->elements) {
    auto const i = read_integer(element, "particles", 0, 4'000'000'000, reading.context);
    if (!i) return std::nullopt;
    if (ensemble && static_cast<std::size_t>(*i) >= ensemble->size()) {
      reading.mistake(element.place,
                      fmt::format("particles: there is no particle {}; '{}' has {}, numbered from 0 to {}", *i,
                                  ensemble->name(), ensemble->size(), ensemble->size() - 1));
      return std::nullopt;
    }
    which.push_back(static_cast<std::uint32_t>(*i));
  }
  return which;
}

void read_ensembles(Section& document, Reading& reading) {
  if (!document.has("ensembles")) reading.mistake({}, "there are no [[ensembles]]; a scenario needs particles");
  auto const tables = find_tables(document, "ensembles");
  if (Item const* item = document.find("ensembles"); item && item->is(Item::Kind::array) && item->elements.empty())
    reading.mistake(item->place, "there are no [[ensembles]]; a scenario needs particles");
  for (Item const* table : tables) read_ensemble(*table, reading);
}

}  // namespace boltzmann
