// Reads [[classes]]: classes that a scenario derives from shipped ones, with additional fields and rates.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/formulas/formula_reader.hpp>
#include <boltzmann/integrators/driven_fields.hpp>
#include <boltzmann/integrators/methods.hpp>
#include <boltzmann/particles/derived.hpp>
#include <boltzmann/scenario/field_values.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/tables.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <typeinfo>

namespace boltzmann {
namespace {

constexpr std::size_t max_fields = 32;

bool is_one_of(std::string_view word, std::vector<std::string> const& words) {
  return std::find(words.begin(), words.end(), word) != words.end();
}

/// Keys of [[ensembles]], which would be ambiguous as names of fields.
std::vector<std::string> const& keys_of_ensembles() {
  static std::vector<std::string> const all = [] {
    auto keys = ensemble_options().keys();
    for (auto const& key : set_options().keys()) keys.push_back(key);
    return keys;
  }();
  return all;
}

/// True if a name has another meaning in formulas.
bool means_something(std::string_view name) {
  static std::vector<std::string> const taken{"x", "y", "z", "r", "p", "q", "pi", "time", "separation", "number"};
  return is_one_of(name, taken) || is_one_of(name, formula_functions());
}

/// True if a formula uses a name: alone, or as a field of p or q.
bool uses(std::string_view formula, std::string_view name) {
  auto const in_word = [](char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; };
  for (std::size_t at = formula.find(name); at != std::string_view::npos; at = formula.find(name, at + 1)) {
    std::size_t const end = at + name.size();
    if ((at == 0 || !in_word(formula[at - 1])) && (end == formula.size() || !in_word(formula[end]))) return true;
  }
  return false;
}

void refuse_uses(std::vector<ReadNeighbourField> const& fields, std::string_view formula, std::string_view key,
                 Place const& place, Reading& reading) {
  for (auto const& one : fields)
    if (uses(formula, one.field.field))
      reading.mistake(place, fmt::format("{}: '{}' is computed only for output, so laws and rates can't use it; a "
                                         "field with sum = true can count neighbours at each step",
                                         key, one.field.field));
}

/// Creates a class from one table.
class ClassReader {
 public:
  ClassReader(Item const& table, Reading& reading)
      : reading_(reading),
        before_(reading.context.mistakes.count()),
        section_(table, title_of(table), reading.context) {
    result_->place = table.place;
  }

  void read() {
    section_.explain_said(class_options());
    read_name();
    read_base();
    told_.doc = section_.text("doc").value_or("");
    auto const before = reading_.context.mistakes.count();
    read_fields();
    fields_known_ = reading_.context.mistakes.count() == before;
    result_->rates.units = reading_.context.units;
    result_->rates.parameters = read_formula_parameters(section_, reading_);
    result_->rates.where = read_formula_parts(section_, reading_);
    for (auto const& part : result_->rates.where)
      refuse_uses(result_->neighbour_fields, part.text, "where." + part.name, section_.place("where"), reading_);
    read_rates("rate", result_->rates.rates);
    read_rates("diffusion", result_->rates.diffusions);
    section_.finish();
    if (base_ && !derived_.name.empty()) {
      check_driven();
      make();
    }
    if (result_ && !derived_.name.empty()) {  // after mistakes, ensembles of the class report none of their own
      result_->kind.name = derived_.name;
      reading_.classes.push_back(std::move(result_));
    }
  }

 private:
  static std::string title_of(Item const& table) {
    Entry const* name = table.find("name");
    return name && name->item.is(Item::Kind::text) ? "[[classes]] '" + name->item.text + "'" : "[[classes]]";
  }
  bool right() const { return reading_.context.mistakes.count() == before_; }
  void mistake(Place const& place, std::string const& what) { reading_.mistake(place, what); }

  void read_name() {
    Item const* item = section_.need("name", "name = \"Grain\"");
    auto const name = item ? read_text(*item, "name", reading_.context) : std::nullopt;
    if (!name) return;
    if (!is_formula_name(*name))
      return mistake(item->place, "name: letters, digits and _ make the name of a class, as in \"Grain\"");
    if (find_class(*name)) return mistake(item->place, fmt::format("name: there is a class {} already", *name));
    for (auto const& other : reading_.classes)
      if (other->kind.name == *name)
        return mistake(item->place, fmt::format("name: there is a class {} already, in line {}; names must differ",
                                                *name, other->place.line));
    derived_.name = told_.name = *name;
  }

  void read_base() {
    Item const* item = section_.need("base", "base = \"Newton\"");
    std::vector<std::string> names;
    for (auto const& entry : particle_classes()) names.push_back(entry.name);
    auto const name = item ? read_word(*item, "base", names, reading_.context) : std::nullopt;
    ParticleClass const* const base = name ? find_class(*name) : nullptr;
    if (!base) return;
    section_.explain_word("base", base->doc);
    told_.base = base->name;
    ClassVariant const* const variant = base->in(reading_.dimension);
    if (!variant && reading_.dimension > 0)
      return mistake(item->place,
                     fmt::format("class {} does not live in {}D, as the box does", base->name, reading_.dimension));
    if (!variant) return;
    base_ = base;
    variant_ = variant;
    particles_ = variant->make("base", 1);
  }

  // ---- Fields ----

  void read_fields() {
    Item const* item = section_.find("fields");
    if (!item) return;
    if (!item->is(Item::Kind::array))
      return mistake(item->place, fmt::format("fields: a list of tables is needed, [{{ name = \"charge\", unit = \"e\" "
                                              "}}], not {}",
                                              describe(*item)));
    if (item->elements.size() > max_fields)
      return mistake(item->place,
                     fmt::format("fields: {} of them; a class may have {}", item->elements.size(), max_fields));
    for (auto const& element : item->elements) {
      if (element.is(Item::Kind::table))
        read_field(element);
      else
        mistake(element.place, fmt::format("fields: a table is needed, {{ name = \"charge\", unit = \"e\" }}, not {}",
                                           describe(element)));
    }
  }

  void read_field(Item const& table) {
    Section section(table, "fields", reading_.context);
    ClassFieldOptions options;
    read_options(section, class_field_options(), &options, {.dimension = reading_.dimension});
    AddedField added;
    added.field.offset = 0;
    Field& field = added.field;
    Item const* const name = section.item("name");
    if (name && name->is(Item::Kind::text) && can_be_named(options.name, name->place)) field.name = options.name;
    added.vector = options.kind == "vector";
    field.components = added.vector ? std::max(reading_.dimension, 1) : 1;
    if (!options.unit.empty())
      catch_errors(reading_, section.place("unit"), [&] {
        try {
          field.dimension = parse_quantity("1 " + options.unit).dimension;
        } catch (Error const& error) {
          throw Error(fmt::format("unit: {}", error.what()));
        }
      });
    field.doc = options.doc;
    added.value.assign(static_cast<std::size_t>(field.components), 0.0);
    if (Item const* value = section.find("default"); value && reading_.dimension > 0) {
      if (added.vector) {
        if (auto const read = read_vector(*value, "default", field.components, field.dimension, reading_.context))
          added.value = *read;
      } else if (auto const read = read_quantity(*value, "default", field.dimension, reading_.context)) {
        added.value = {*read};
      }
    }
    added.sum = options.sum;
    added.period = section.quantity("period", field.dimension, positive).value_or(0);
    check_neighbours(section);
    section.finish();
    ReadNeighbourField around{{field.name, options.neighbours.value_or(0), options.bond_order},
                              options.of,
                              section.place("neighbours"),
                              section.place("of")};
    if (around.field.range > 0 && !field.name.empty()) result_->neighbour_fields.push_back(std::move(around));
    if (added.period > 0) periods_.push_back({field.name, section.place("period")});
    if (field.name.empty()) return;
    told_.fields.push_back(field);
    derived_.added.push_back(std::move(added));
  }

  /// Checks keys that have no effect without `neighbours`, or with it.
  void check_neighbours(Section& section) {
    bool const wanted = section.has("neighbours");
    for (char const* other : {"of", "bond_order"})
      if (!wanted) section.refuse(other, "it belongs to 'neighbours', the distance within which particles are that");
    if (wanted && section.has("bond_order") && reading_.dimension == 1)
      section.mistake("bond_order", "on a line neighbours have no directions");
    for (char const* other : {"kind", "unit", "default", "sum", "period"})
      if (wanted && section.has(other))
        section.mistake(other, "it means nothing beside 'neighbours', which find a number");
  }

  bool can_be_named(std::string const& name, Place const& place) {
    // Names that the program itself uses for lookups.
    static std::vector<std::string> const of_classes{
        "internal_energy", "specific_energy", "temperature", "density",   "range",    "pressure",
        "sound_speed",     "vorticity",       "core",        "viscosity", "anchor",   "stress",
        "damage",          "plastic_strain",  "sheet",       "position",  "velocity", "mass"};
    static std::vector<std::string> const of_files{"box", "count", "id", "species"};
    std::string why;
    if (!is_formula_name(name))
      why = "letters, digits and _ make the name of a field";
    else if (is_one_of(name, of_files))
      why = "trajectories need this name for themselves";
    else if (particles_ && particles_->find_field(name))
      why = fmt::format("class {} has one already, with its own meaning", told_.base);
    else if (is_one_of(name, of_classes))
      why =
          "the program knows what that is, of classes that have it (bzm list classes); take another name, or such a "
          "class as base";
    else if (is_one_of(name, keys_of_ensembles()))
      why = "that is a key of [[ensembles]]; take another name";
    else if (is_one_of(name, {"box", "count", "id", "image", "influence", "species", "speed"}))
      why = "it means something else in files and pictures; take another name";
    else if (means_something(name))
      why = "it means something else in formulas; take another name";
    else if (std::any_of(derived_.added.begin(), derived_.added.end(),
                         [&](AddedField const& other) { return other.field.name == name; }))
      why = "two have that name";
    if (!why.empty()) mistake(place, fmt::format("fields: '{}': {}", quoted(name), why));
    return why.empty();
  }

  // ---- Rates ----

  void read_rates(char const* key, std::vector<FieldRates::Rate>& rates) {
    Item const* table = section_.find(key);
    if (!table) return;
    if (!table->is(Item::Kind::table))
      return mistake(table->place,
                     fmt::format("{}: it is of a field, {}.charge = \"...\", not {}", key, key, describe(*table)));
    std::vector<std::string> names;
    for (auto const& field : fields()) names.push_back(field.name);
    for (auto const& entry : table->entries) {
      std::string const whole = fmt::format("{}.{}", key, entry.key);
      if (base_ && !is_one_of(entry.key, names)) {
        if (!fields_known_) continue;
        mistake(entry.place, fmt::format("{}: class {} has no such field{}", whole, derived_.name,
                                         choices(entry.key, names, "it has")));
        continue;
      }
      if (auto text = formula_of(entry.item, whole)) {
        refuse_uses(result_->neighbour_fields, *text, whole, entry.item.place, reading_);
        rates.push_back({entry.key, *text});
      }
      texts_.push_back({whole, &entry.item});
    }
  }
  /// Numbers are formulas, too; a list has the components of a vector.
  std::optional<std::string> formula_of(Item const& item, std::string const& whole) {
    if (item.is_number()) {
      if (reading_.context.notes) reading_.context.notes->plain(item, "number");
      return fmt::format("({})", item.number);
    }
    return read_text(item, whole, reading_.context);
  }

  std::vector<Field> fields() const {
    return particles_ ? boltzmann::fields_of(derived_, *particles_) : std::vector<Field>{};
  }
  Item const* text_of(std::string const& whole) const {
    for (auto const& [name, item] : texts_)
      if (name == whole) return item;
    return nullptr;
  }

  /// Fields that the base's equations of motion change, or that schemes compute, can't have a rate.
  void check_driven() {
    bool const plain = is_moved_as<Newton<1>, Newton<2>, Newton<3>, Tracer<1>, Tracer<2>, Tracer<3>>();
    for (auto const& rate : result_->rates.rates) {
      std::string const whole = "rate." + rate.field;
      Place const place = text_of(whole)->place;
      bool const own = std::any_of(derived_.added.begin(), derived_.added.end(),
                                   [&](AddedField const& added) { return added.field.name == rate.field; });
      Field const* field = particles_->find_field(rate.field);
      bool const sum = std::any_of(derived_.added.begin(), derived_.added.end(), [&](AddedField const& added) {
        return added.field.name == rate.field && added.sum;
      });
      auto const& around = result_->neighbour_fields;
      bool const found = std::any_of(around.begin(), around.end(),
                                     [&](ReadNeighbourField const& one) { return one.field.field == rate.field; });
      if (sum)
        mistake(place, fmt::format("{}: it is a sum, which has no rate", whole));
      else if (found)
        mistake(place, fmt::format("{}: it is computed from neighbours and has no rate", whole));
      else if (rate.field == "position" || rate.field == "velocity")
        mistake(place, fmt::format("{}: laws move particles; write an [[influences]] with an influence, from_outside = "
                                   "true",
                                   whole));
      else if (!own && (!plain || is_found(*base_, rate.field) || rate.field == "internal_energy"))
        mistake(place,
                fmt::format("{}: class {} changes it already; give a rate to a field of your own", whole, told_.base));
      else if (field && field->components != 1 && field->components != reading_.dimension)
        mistake(place, fmt::format("{}: only numbers and vectors have rates", whole));
      derived_.driven.push_back({rate.field, false});
    }
    for (auto const& period : periods_)
      if (std::none_of(derived_.driven.begin(), derived_.driven.end(),
                       [&](DerivedClass::Driven const& one) { return one.field == period.first; }))
        mistake(period.second, fmt::format("period: {} has no rate, and stays as it is", period.first));
    for (auto const& diffusion : result_->rates.diffusions) {
      auto const driven = std::find_if(derived_.driven.begin(), derived_.driven.end(),
                                       [&](DerivedClass::Driven const& one) { return one.field == diffusion.field; });
      if (driven != derived_.driven.end())
        driven->diffuses = true;
      else
        mistake(text_of("diffusion." + diffusion.field)->place,
                fmt::format("diffusion.{}: it needs a rate beside it, rate.{} = 0 if it does not drift",
                            diffusion.field, diffusion.field));
    }
  }
  template <class... P>
  bool is_moved_as() const {
    return ((particles_->moves_as() == typeid(P)) || ...);
  }

  bool has_rates() const { return !result_->rates.rates.empty(); }

  void make() {
    if (!right()) return;
    // The texts are invalid for all ensembles of the class, or for none.
    DerivedEnsemble const empty("empty", derived_, *particles_);
    try {
      if (has_rates()) result_->rates.on(empty);
    } catch (FormulaPartError const& error) {
      Item const* item = text_of(error.part);
      if (!item && !texts_.empty()) item = texts_.front().second;
      if (item && item->is(Item::Kind::text))
        refuse_formula(section_, error, *item, error.part, reading_);
      else
        mistake(item ? item->place : section_.place(), fmt::format("{}: {}", error.part, error.what()));
    } catch (Error const& error) {
      mistake(section_.place(), error.what());
    }
    for (auto const& rate : result_->rates.rates)
      told_.rates.push_back({fmt::format("d {} / dt", rate.field), rate.text});
    for (auto const& diffusion : result_->rates.diffusions)
      told_.rates.push_back({fmt::format("diffusion of {}", diffusion.field), diffusion.text});
    if (!right()) return;
    result_->kind = kind();
    reading_.result->classes.push_back(told_);
    reading_.classes.push_back(std::move(result_));
  }

  ParticleClass kind() const {
    ClassVariant const base = *variant_;
    auto const derived = std::make_shared<DerivedClass const>(derived_);
    ClassVariant variant = base;
    variant.fields = fields();
    variant.source.newton = base.source.newton && derived_.driven.empty();
    DerivedEnsemble const empty("empty", derived_, *particles_);
    variant.row_bytes = base.row_bytes + (empty.stride() - particles_->stride()) * sizeof(double) +
                        derived_.driven.size() * empty.rate_stride() * sizeof(double);
    variant.make = [base, derived](std::string name, std::size_t size) -> std::unique_ptr<AnyEnsemble> {
      auto const of_base = base.make("base", 1);
      return std::make_unique<DerivedEnsemble>(std::move(name), *derived, *of_base, size);
    };
    variant.integrate = [base](AnyEnsemble& ensemble, Method method) {
      return with_driven_fields(base.integrate(ensemble, method), ensemble);
    };
    return {derived_.name, told_.doc, base_->classical, {variant}, base_->matter};
  }

  Reading& reading_;
  std::size_t before_;
  Section section_;
  std::unique_ptr<ReadClass> result_ = std::make_unique<ReadClass>();
  DerivedClassText told_;
  DerivedClass derived_;
  ParticleClass const* base_ = nullptr;
  ClassVariant const* variant_ = nullptr;
  bool fields_known_ = true;                                ///< false after mistakes
  std::unique_ptr<AnyEnsemble> particles_;                  ///< of the base
  std::vector<std::pair<std::string, Place>> periods_;      ///< the fields, and the places in the file
  std::vector<std::pair<std::string, Item const*>> texts_;  ///< "rate.charge"
};

}  // namespace

ParticleClass const* Reading::find_class(std::string_view name) const {
  for (auto const& one : classes)
    if (one->kind.name == name) return one->kind.variants.empty() ? nullptr : &one->kind;
  return boltzmann::find_class(name);
}

std::vector<std::string> Reading::class_names() const {
  std::vector<std::string> names;
  for (auto const& one : classes) names.push_back(one->kind.name);
  for (auto const& one : particle_classes()) names.push_back(one.name);
  return names;
}

void read_classes(Section& document, Reading& reading) {
  for (Item const* table : find_tables(document, "classes")) ClassReader(*table, reading).read();
}

void Reading::refuse_neighbour_fields(std::string_view formula, std::string_view key, Place const& place) {
  for (auto const& one : classes) refuse_uses(one->neighbour_fields, formula, key, place, *this);
}

namespace {

/// The ensembles of these names, or all; nothing and a mistake if one is unknown.
std::vector<AnyEnsemble*> neighbours_of(ReadNeighbourField const& around, Reading& reading) {
  std::vector<AnyEnsemble*> among;
  for (auto const& ensemble : reading.ensembles)
    if (ensemble.particles && (around.among.empty() || is_one_of(ensemble.name, around.among)))
      among.push_back(ensemble.particles);
  auto const names = reading.ensemble_names();
  for (auto const& name : around.among)
    if (!is_one_of(name, names)) {
      reading.mistake(around.among_place,
                      fmt::format("of: there is no ensemble '{}'{}", quoted(name), choices(name, names)));
      among.clear();
    }
  return among;
}

}  // namespace

void load_neighbour_fields(Reading& reading) {
  if (!reading.box || !reading.context.mistakes.none()) return;  // particles may be missing
  for (auto const& one : reading.classes)
    for (auto const& around : one->neighbour_fields) {
      auto const among = neighbours_of(around, reading);
      for (auto const& ensemble : reading.ensembles) {
        if (ensemble.kind != &one->kind || !ensemble.particles || among.empty()) continue;
        auto* scheme = reading.result->scheme<NeighbourFields>();
        if (!scheme) {
          auto made = std::make_unique<NeighbourFields>(*reading.box);
          made->threads(reading.run.threads);
          scheme = made.get();
          reading.result->schemes.push_back(std::move(made));
        }
        NeighbourField field = around.field;
        field.among = among;
        catch_errors(reading, around.place, [&] { scheme->find(*ensemble.particles, std::move(field)); });
      }
    }
  // For groups selected by these fields.
  if (auto* scheme = reading.result->scheme<NeighbourFields>(); scheme && reading.context.mistakes.none())
    scheme->complete(0);
}

void load_rates(Reading& reading) {
  for (auto const& ensemble : reading.ensembles)
    for (auto const& one : reading.classes)
      if (ensemble.kind == &one->kind && ensemble.particles && !one->rates.rates.empty() && reading.result->pairs)
        catch_errors(reading, ensemble.place, [&] { reading.result->pairs->rates(*ensemble.particles, one->rates); });
}

}  // namespace boltzmann
