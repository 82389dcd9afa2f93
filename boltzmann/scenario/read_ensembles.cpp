// Reads [[ensembles]]: the particles and their initial state.
#include <boltzmann/core/elements.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/loaders/internal_energy_load.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>
#include <boltzmann/pictures/colour.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/field_values.hpp>
#include <boltzmann/scenario/frozen.hpp>
#include <boltzmann/scenario/loader.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/smooth_fields.hpp>
#include <boltzmann/scenario/tables.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>

namespace boltzmann {
namespace {

std::string title_of(Item const& table) {
  Entry const* name = table.find("name");
  return name && name->item.is(Item::Kind::text) ? "[[ensembles]] '" + name->item.text + "'" : "[[ensembles]]";
}

/// Creates an ensemble from one table: first its definition, then its particles.
class EnsembleReader {
 public:
  EnsembleReader(Item const& table, std::string title, Reading& reading, Item const* otherwise = nullptr)
      : reading_(reading),
        before_(reading.context.mistakes.count()),
        section_(table, std::move(title), reading.context, otherwise) {
    ensemble_.place = table.place;
    ensemble_.table = &table;
  }

  void read() {
    read_keys();
    read_class();
    read_particles_of_class();
    read_bonds(section_, particles_, ensemble_.molecules, reading_);
    if (kind_) section_.finish();
    if (variant_) make_integrator();
    complete();
    if (made_) reading_.result->ensembles.push_back(std::move(made_));
    ensemble_.particles = right() ? particles_ : nullptr;
    reading_.ensembles.push_back(std::move(ensemble_));
  }

  /// Further particles for an ensemble, with a name of their own.
  std::unique_ptr<AnyEnsemble> read_more(ReadEnsemble const& of, std::string const& name, PlaceAgain& again) {
    addition_ = true;
    read_options(section_, ensemble_options().only({{"number"}}), &options_, {.dimension = reading_.dimension});
    if (Item const* item = section_.item("number"); item && item->is(Item::Kind::integer) && item->integer == 0)
      mistake(item->place, "number: 0 adds no particle; 1 or more are needed");
    options_.name = name;
    options_.element = of.element;
    ensemble_.name = of.name;
    kind_ = of.kind;
    variant_ = kind_->in(reading_.dimension);
    section_.explain_said(ensemble_options());
    read_particles_of_class();
    section_.finish();
    complete();
    if (loader_ && right()) again = loader_->place_again();
    return right() ? std::move(made_) : nullptr;
  }

 private:
  void read_particles_of_class() {
    read_load();
    if (kind_) read_fields_of_class();
    if (smooth()) read_matter();
    read_velocities();
    if (variant_ && loadable_ && reading_.box && right()) make_particles();
    for (Item const* set : find_tables(section_, "set")) read_set(*set);
  }

  void complete() {
    if (particles_ && !addition_ && !options_.element.empty())
      reading_.result->elements.emplace_back(ensemble_.name, options_.element);
    if (particles_ && ensemble_.state) find_temperatures(*particles_, *ensemble_.state);
    if (particles_) catch_errors(reading_, ensemble_.load_place, [&] { reading_.box->check(*particles_); });
  }

  bool right() const { return reading_.context.mistakes.count() == before_; }
  bool smooth() const { return kind_ && kind_->matter != Matter::none; }
  void mistake(Place const& place, std::string const& what) { reading_.mistake(place, what); }
  /// The volume per particle on a lattice.
  std::optional<double> volume() const { return loader_ ? loader_->volume() : std::nullopt; }
  bool density_gives_mass() const {
    return smooth() && volume() && gives(section_, "density") && !gives(section_, "mass");
  }

  void read_keys() {
    read_options(section_,
                 ensemble_options().only(
                     {{"name"}, {"number"}, {"molecule"}, {"integrator"}, {"colour"}, {"diameter"}, {"element"}}),
                 &options_, {.dimension = reading_.dimension});
    ensemble_.name = options_.name;
    read_element();
    ensemble_.molecules.length = options_.molecule;
    if (Item const* item = section_.item("name"); item && item->is(Item::Kind::text)) {
      if (item->text.empty())
        mistake(item->place, "name: an ensemble needs a name, not an empty text");
      else
        catch_errors(reading_, item->place, [&] { check_stored_name("name: an ensemble", item->text); });
      for (auto const& other : reading_.ensembles)
        if (other.name == item->text && !item->text.empty())
          mistake(item->place, fmt::format("name: there is an ensemble '{}' already, in line {}; names must differ",
                                           item->text, other.place.line));
    }
    catch_errors(reading_, section_.place("colour"), [&] {
      if (!options_.appearance.colour.empty() || section_.has("colour")) colour_named(options_.appearance.colour);
    });
  }

  void read_element() {
    Item const* item = section_.item("element");
    if (!item || !item->is(Item::Kind::text)) return;
    auto const symbols = element_symbols();
    if (!find_element(options_.element) || std::isdigit(static_cast<unsigned char>(options_.element[0])) != 0)
      mistake(item->place, fmt::format("element: '{}' is not the symbol of an element, as in element = \"Cu\"{}",
                                       boltzmann::quoted(options_.element), did_you_mean(options_.element, symbols)));
    ensemble_.element = options_.element;
  }

  void read_class() {
    Item const* item = section_.need("class", "class = \"Newton\"");
    auto const name = item ? read_word(*item, "class", reading_.class_names(), reading_.context) : std::nullopt;
    ensemble_.kind = kind_ = name ? reading_.find_class(*name) : nullptr;
    if (!kind_) return;
    section_.explain_word("class", kind_->doc);
    section_.explain_said(ensemble_options());
    variant_ = kind_->in(reading_.dimension);
    if (!variant_ && reading_.dimension > 0) {
      std::vector<std::string> spaces;
      for (auto const& v : kind_->variants) spaces.push_back(std::to_string(v.dimension) + "D");
      mistake(item->place, fmt::format("class {} lives in {}; the box has {} dimension{}", kind_->name,
                                       join(spaces, " or "), reading_.dimension, reading_.dimension == 1 ? "" : "s"));
    }
    if (smooth() && !reading_.smooth.wanted)
      mistake(item->place,
              fmt::format("class {} needs the scheme of smooth particles; add a table [smooth]", kind_->name));
  }

  /// Before the fields, because it determines the number of particles.
  void read_load() {
    Item const* item = section_.need("load", "load = { kind = \"random\" }");
    if (!item) return;
    ensemble_.load_place = item->place;
    if (!item->is(Item::Kind::table))
      return mistake(item->place,
                     fmt::format("load: a table is needed, {{ kind = \"block\", ... }}, not {}", describe(*item)));
    loader_.emplace(*item, ensemble_.name, reading_, variant_);
    Item const* const number = section_.item("number");
    loadable_ = loader_->read(number ? std::optional(options_.number) : std::nullopt, section_.place("number"),
                              number && number->is(Item::Kind::integer) && number->integer == 0);
    if (loadable_) count_ = loader_->count();
  }

  void read_fields_of_class() {
    ensemble_.state = read_state_law(section_, *kind_, reading_);
    internal_temperature_ = read_internal_temperature(section_, *kind_, reading_);
    if (section_.has("position"))
      mistake(section_.key_place("position"),
              "positions are loaded: load = { kind = \"positions\", positions = [...] }");
    refuse_found(section_, *kind_, reading_);
    auto given = given_fields(*kind_, reading_.dimension);
    if (Item const* item = section_.item("internal_energy"); item && item->is(Item::Kind::table))
      std::erase_if(given, [](Field const& field) { return field.name == "internal_energy"; });
    fields_ = read_fields(section_, given, false, count_, reading_, options_.molecule);
    formulas_ = read_formulas(section_, fields_of(*kind_, reading_.dimension), false, unknown_fields(section_, *kind_),
                              reading_);
    for (auto const& formula : formulas_)
      if (is_found(*kind_, formula.field.name))
        mistake(formula.place,
                smooth() ? fmt::format("{}: the material finds it from density and specific_energy", formula.field.name)
                         : fmt::format("{}: it follows from internal_energy and heat_capacity", formula.field.name));
    section_.mark_used("position");
    check_positive(section_, fields_, *kind_, reading_);
    ensemble_.range_place = section_.place(section_.has("range") ? "range" : "formulas");
  }

  void read_matter() {
    check_smooth(section_, volume(), loadable_, reading_);
    ensemble_.material = read_material(section_, *kind_, reading_);
  }

  void read_velocities() {
    std::vector<OptionKey> const with_temperature{{"drift"}, {"remove_drift"}, {"exact_temperature"}, {"quiet"}};
    if (!smooth()) {
      auto keys = with_temperature;
      keys.push_back({"temperature"});
      read_options(section_, ensemble_options().only(keys), &options_, {.dimension = reading_.dimension});
      if (!section_.has("temperature"))
        for (auto const& one : with_temperature)
          section_.refuse(one.key, "it belongs to 'temperature', which is missing");
      if (section_.has("temperature") && section_.has("velocity"))
        mistake(section_.place("velocity"),
                "velocity: 'temperature' gives the velocities; for a common one on top write 'drift'");
    }
    if (Item const* item = section_.find("velocity_ripple")) ripple_ = read_velocity_ripple(*item, reading_);
  }

  void make_particles() {
    made_ = variant_->make(options_.name, count_);
    particles_ = made_.get();
    auto const all = all_indices(*particles_);
    for (auto const& value : fields_) apply(value, *particles_, all);  // loaders use masses
    bool const loaded = catch_errors(reading_, ensemble_.load_place, [&] {
      loader_->load(*particles_);
      settle_masses();
    });
    // after the default diameter of a lattice, which pictures of scenarios may select
    particles_->appearance = options_.appearance;
    for (auto const& value : fields_) apply(value, *particles_, all);
    if (smooth() && volume() && reading_.smooth.variable && !gives(section_, "range"))
      set_ranges(*particles_, *volume(), reading_.smooth.variable->spacings);
    if (loaded)
      for (auto& line : loader_->notes(*particles_, given_names())) reading_.note(std::move(line));
    if (loaded && !addition_) loader_->count_species_taken();
    if (!loaded || !fill_fields(all) || !fill_velocities()) particles_ = nullptr;
  }

  /// Fields whose values the table sets.
  std::vector<std::string> given_names() const {
    std::vector<std::string> names;
    for (auto const& value : fields_) names.push_back(value.field.name);
    for (auto const& formula : formulas_) names.push_back(formula.field.name);
    if (options_.temperature) names.emplace_back("velocity");
    return names;
  }

  /// Masses set neither by the table nor by the loader are those of the elements. For pure numbers they are 1.
  void settle_masses() {
    Field const* mass = particles_->find_field("mass");
    UnitSystem const& units = reading_.context.units;
    if (!mass || smooth() || units.is_reduced() || !reading_.base_known) return;
    if (gives(section_, "mass") || loader_->sets("mass")) return;
    if (!options_.element.empty()) {
      auto const of_element = element_mass(options_.element, units);
      if (!of_element)
        throw Error(fmt::format("element: {} has no stable isotope, so that its mass is not known; add mass",
                                options_.element));
      for (std::size_t i = 0; i < count_; ++i) particles_->row(i)[mass->offset] = *of_element;
    } else if (loader_->reads_file()) {
      take_element_masses(*mass);
    }
  }

  /// For a file without masses. In a base with a user-defined unit of mass, 1 may be intended; 1 kg is always wrong.
  void take_element_masses(Field const& mass) {
    UnitSystem const& units = reading_.context.units;
    auto const masses = loader_->element_masses();
    std::string const file = loader_->file_name();
    for (std::size_t i = 0; i < masses.size(); ++i) particles_->row(i)[mass.offset] = masses[i];
    if (masses.size() == count_)
      return reading_.note(
          fmt::format("note: '{}': {} has no masses; those of the elements are taken, and `mass` gives "
                      "others",
                      options_.name, file));
    constexpr char const* cure = "add mass = \"18 amu\" or element = \"O\" to the ensemble";
    if (set_gives_mass()) return;
    if (units.scale() == UnitSystem::si().scale() || units.scale() == UnitSystem::cgs().scale())
      throw Error(
          fmt::format("load: {} has no masses, and its species are no elements with known masses; {}", file, cure));
    reading_.note(
        fmt::format("warning: '{}': {} has no masses, and its species are no elements with known masses: each "
                    "mass is {}; {}",
                    options_.name, file, units.text(1, dimensions::mass, 6), cure));
  }

  /// Sets internal energies and fields given by formulas. The density comes first: masses follow from it, and other
  /// formulas may use both.
  bool fill_fields(std::vector<std::uint32_t> const& all) {
    if (internal_temperature_ && ensemble_.state && !catch_errors(reading_, section_.place("internal_energy"), [&] {
          internal_energy_load(*particles_, *ensemble_.state,
                               {.temperature = *internal_temperature_,
                                .boltzmann_constant = reading_.boltzmann_constant(),
                                .seed = reading_.run.seed});
        }))
      return false;
    for (bool const density : {true, false}) {
      for (auto const& formula : formulas_)
        if (density == (formula.field.name == "density") && !apply(formula, *particles_, all, reading_)) return false;
      if (density && density_gives_mass()) set_masses(*particles_, *volume(), all);
    }
    Field const* anchor = particles_->find_field("anchor");
    if (anchor && !section_.has("anchor"))
      for (std::size_t i = 0; i < count_; ++i)
        std::copy_n(particles_->row(i), anchor->components, particles_->row(i) + anchor->offset);
    return true;
  }

  bool fill_velocities() {
    if (options_.drift) options_.thermal.drift = *options_.drift;
    if (options_.temperature) options_.thermal.temperature = *options_.temperature;
    options_.thermal.boltzmann_constant = reading_.boltzmann_constant();
    options_.thermal.seed = reading_.run.seed;
    if (options_.temperature && !ripple_ && (options_.thermal.remove_drift || options_.thermal.exact_temperature))
      ensemble_.velocities = ReadVelocities{*options_.temperature,
                                            options_.thermal.remove_drift,
                                            options_.thermal.exact_temperature,
                                            options_.thermal.drift,
                                            {},
                                            section_.place("temperature")};
    if (options_.temperature &&
        !catch_errors(reading_, section_.place("temperature"), [&] { maxwellian_load(*particles_, options_.thermal); }))
      return false;
    return !ripple_ || catch_errors(reading_, section_.place("velocity_ripple"),
                                    [&] { velocity_ripple(*particles_, *reading_.box, *ripple_); });
  }

  /// True if some [[ensembles.set]] sets masses.
  bool set_gives_mass() const {
    Item const* sets = section_.item("set");
    if (!sets || !sets->is(Item::Kind::array)) return false;
    return std::any_of(sets->elements.begin(), sets->elements.end(), [](Item const& set) {
      Entry const* formulas = set.find("formulas");
      return set.find("mass") || (formulas && formulas->item.find("mass"));
    });
  }

  /// [[ensembles.set]]: other values for some of the particles.
  void read_set(Item const& table) {
    Section set(table, "[[ensembles.set]]", reading_.context);
    SetOptions options;
    read_options(set, set_options(), &options, {.dimension = reading_.dimension});
    auto const which = read_particles(set, particles_, reading_);
    if (!set.has("particles") && !set.has("where"))
      mistake(
          set.place(),
          "[[ensembles.set]] has no 'particles'; add e.g. particles = [0], \"edge\" or \"all\", or where = \"x < 1\"");
    if (!kind_) return;
    refuse_found(set, *kind_, reading_);
    auto const given = given_fields(*kind_, reading_.dimension);
    auto const values = read_fields(set, given, true, which ? which->size() : 0, reading_);
    check_positive(set, values, *kind_, reading_);
    if (smooth() && gives(set, "density") && !density_gives_mass() && !reading_.smooth.from_continuity)
      mistake(set.place(set.has("density") ? "density" : "formulas"),
              "density: it is the sum over the masses around a particle; give 'mass' here, or 'density' in "
              "[[ensembles]]");
    auto const formulas = read_formulas(set, given, true, unknown_fields(section_, *kind_), reading_);
    set.finish();
    if (!particles_ || !which || !right()) return;
    auto const is_velocity = [](auto const& one) { return one.field.name == "velocity"; };
    if (ensemble_.velocities && (std::any_of(values.begin(), values.end(), is_velocity) ||
                                 std::any_of(formulas.begin(), formulas.end(), is_velocity)))
      ensemble_.velocities->given.insert(ensemble_.velocities->given.end(), which->begin(), which->end());
    for (auto const& value : values) apply(value, *particles_, *which);
    for (auto const& formula : formulas)
      if (!apply(formula, *particles_, *which, reading_)) break;
    if (density_gives_mass() && gives(set, "density") && !gives(set, "mass"))
      set_masses(*particles_, *volume(), *which);
    if (options.freeze && addition_)
      return mistake(set.place("freeze"), "freeze: particles that are added are not frozen");
    if (options.freeze) frozen_.insert(frozen_.end(), which->begin(), which->end());
  }

  /// Checks the method of the class even without particles.
  void make_integrator() {
    if (section_.has("integrator") && !options_.integrator) return;
    Method const method = options_.integrator.value_or(variant_->usual_method);
    std::unique_ptr<AnyEnsemble> none;
    if (!particles_) none = variant_->make(ensemble_.name, 0);
    catch_errors(reading_, section_.place("integrator"),
                 [&] { ensemble_.integrator = variant_->integrate(particles_ ? *particles_ : *none, method); });
    if (none) return ensemble_.integrator.reset();
    if (!ensemble_.integrator || frozen_.empty()) return;
    std::sort(frozen_.begin(), frozen_.end());
    frozen_.erase(std::unique(frozen_.begin(), frozen_.end()), frozen_.end());
    if (Field const* velocity = particles_->find_field("velocity"))
      for (auto const i : frozen_) std::fill_n(particles_->row(i) + velocity->offset, velocity->components, 0.0);
    ensemble_.integrator = std::make_unique<Frozen>(*particles_, frozen_, std::move(ensemble_.integrator));
  }

  Reading& reading_;
  std::size_t before_;
  Section section_;
  EnsembleOptions options_;
  ReadEnsemble ensemble_;
  ParticleClass const* kind_ = nullptr;
  ClassVariant const* variant_ = nullptr;
  std::optional<Loader> loader_;
  bool loadable_ = false;
  std::size_t count_ = 0;
  std::vector<FieldValue> fields_;
  std::vector<FieldFormula> formulas_;
  std::optional<double> internal_temperature_;
  std::optional<VelocityRipple> ripple_;
  bool addition_ = false;
  std::unique_ptr<AnyEnsemble> made_;
  AnyEnsemble* particles_ = nullptr;  ///< null until everything is valid
  std::vector<std::uint32_t> frozen_;
};

bool any_of_these(std::initializer_list<std::string_view> keys, std::string const& key) {
  return std::find(keys.begin(), keys.end(), key) != keys.end();
}

/// A value per particle, or per particle of a molecule.
bool is_list(Item const& item, std::string const& key, ParticleClass const& kind, int dimension) {
  if (!item.is(Item::Kind::array) || item.elements.empty()) return false;
  for (auto const& field : given_fields(kind, dimension))
    if (field.name == key)
      return item.elements.front().is(Item::Kind::array) || (field.components == 1 && item.elements.size() != 1);
  return false;
}

/// The properties that added particles inherit from an ensemble's own table: all except positions and velocities. Adds
/// a mistake if `table` must set one.
Item alike(Item const& table, ReadEnsemble const& of, Reading& reading) {
  Item all;
  bool const one_gives_the_other = of.smooth() && !reading.smooth.from_continuity;
  for (Entry const& entry : of.table->entries) {
    if (one_gives_the_other &&
        ((entry.key == "density" && table.find("mass")) || (entry.key == "mass" && table.find("density"))))
      continue;
    if (table.find(entry.key) ||
        any_of_these({"name", "class", "integrator", "colour", "diameter", "load", "number", "molecule", "bonds", "set",
                      "element", "velocity", "temperature", "drift", "remove_drift", "exact_temperature", "quiet",
                      "velocity_ripple", "anchor"},
                     entry.key))
      continue;
    if (is_list(entry.item, entry.key, *of.kind, reading.dimension)) {
      reading.mistake(
          table.place,
          fmt::format("add: '{}' of '{}' is a list; give the values of the added particles here", entry.key, of.name));
      continue;
    }
    all.entries.push_back(entry);
    if (entry.key == "formulas")
      std::erase_if(all.entries.back().item.entries, [](Entry const& formula) { return formula.key == "velocity"; });
  }
  return all;
}

/// Notes particles of files that no ensemble uses, or several.
void note_species(Reading& reading) {
  for (auto const& [path, file] : reading.files) {
    std::vector<std::string> none, several;
    for (auto const& [word, species] : file.species) {
      std::string const text = fmt::format("'{}' ({})", boltzmann::quoted(word), species.particles);
      if (species.ensembles == 0) none.push_back(text);
      if (species.ensembles > 1) several.push_back(text);
    }
    if (!none.empty())
      reading.note(fmt::format("note: {}: no ensemble takes the particles of species {}", file.name, some_of(none)));
    if (!several.empty())
      reading.note(
          fmt::format("warning: {}: several ensembles take the particles of species {}, which are there several "
                      "times; write `species` in each load",
                      file.name, some_of(several)));
  }
}

}  // namespace

std::shared_ptr<AnyEnsemble const> read_addition(Item const& table, ReadEnsemble const& to, std::string const& name,
                                                 Reading& reading, PlaceAgain& again) {
  std::size_t const before = reading.context.mistakes.count();
  for (char const* key : {"material", "heat_capacity"})
    if (Entry const* own = table.find(key))
      reading.mistake(own->place, fmt::format("{}: it is that of '{}', whose particles are added", key, to.name));
  Item const otherwise = alike(table, to, reading);
  if (reading.context.mistakes.count() != before) return nullptr;
  return EnsembleReader(table, "add", reading, &otherwise).read_more(to, name, again);
}

void read_ensembles(Section& document, Reading& reading) {
  if (!document.has("ensembles") && !document.other_capitals("ensembles"))
    reading.mistake({}, "there are no [[ensembles]]; a scenario needs particles");
  auto const tables = find_tables(document, "ensembles");
  if (Item const* item = document.find("ensembles"); item && item->is(Item::Kind::array) && item->elements.empty())
    reading.mistake(item->place, "there are no [[ensembles]]; a scenario needs particles");
  for (Item const* table : tables) EnsembleReader(*table, title_of(*table), reading).read();
  note_species(reading);
}

}  // namespace boltzmann
