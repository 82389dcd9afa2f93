// Reads [[ensembles]]: which particles there are, where, and in what state.
#include <boltzmann/diagnoses/colour.hpp>
#include <boltzmann/loaders/fields.hpp>
#include <boltzmann/loaders/jitter.hpp>
#include <boltzmann/loaders/lattice.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/ripple_load.hpp>
#include <boltzmann/loaders/xyz_file.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/frozen.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <numeric>

namespace boltzmann {
namespace {

constexpr double most_particles = 1e9;

/// The value of a field for all particles, or one for each.
struct FieldValue {
  Field field;
  bool each;
  std::vector<double> values;  ///< field.components numbers, or that many for each particle
};

/// A field of `count` particles; count = 0: not known.
std::optional<FieldValue> read_field(Item const& item, Field const& field, std::size_t count, Reading& reading) {
  ReadContext& context = reading.context;
  bool const is_vector = field.components > 1;
  auto const wrong_count = [&](std::size_t n) {
    context.mistakes.add(item.place, fmt::format("{}: {} value{} for {} particle{}; give one for all, or one for each",
                                                 field.name, n, n == 1 ? "" : "s", count, count == 1 ? "" : "s"));
    return std::nullopt;
  };
  if (!item.is(Item::Kind::array)) {
    if (is_vector) {
      read_vector(item, field.name, field.components, field.dimension, context);  // says what is wrong
      return std::nullopt;
    }
    auto const value = read_quantity(item, field.name, field.dimension, context);
    return value ? std::optional(FieldValue{field, false, {*value}}) : std::nullopt;
  }
  bool const nested = !item.elements.empty() && item.elements.front().is(Item::Kind::array);
  if (nested || (!is_vector && item.elements.size() != 1)) {
    if (count > 0 && item.elements.size() != count) return wrong_count(item.elements.size());
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

void apply(FieldValue const& value, AnyEnsemble& particles, std::vector<std::uint32_t> const& which) {
  auto const components = static_cast<std::size_t>(value.field.components);
  for (std::size_t k = 0; k < which.size(); ++k)
    std::copy_n(value.values.data() + (value.each ? k * components : 0), components,
                particles.row(which[k]) + value.field.offset);
}

std::vector<std::uint32_t> everyone(AnyEnsemble const& particles) {
  std::vector<std::uint32_t> all(particles.size());
  std::iota(all.begin(), all.end(), 0U);
  return all;
}

/// What so many particles take, with their influences, the schemes' copies and lists.
double memory_of(double count, ClassVariant const& variant) {
  return count * (3.0 * static_cast<double>(variant.row_bytes) + 200);
}

bool fits_memory(double count, ClassVariant const& variant, Place const& place, Reading& reading) {
  double const machine = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  double const needed = memory_of(count, variant), gib = 1024.0 * 1024 * 1024;
  if (count <= most_particles && needed <= machine) return true;
  reading.mistake(place, fmt::format("{:.0f} particles would need about {:.0f} GiB of memory; this machine has {:.0f} "
                                     "GiB, and at most 1000000000 are allowed",
                                     count, std::ceil(needed / gib), machine / gib));
  return false;
}

/// The axis that a key names, from 0 on; `otherwise` if it is missing or wrong.
int read_axis(Section& section, char const* key, int otherwise, Reading const& reading) {
  std::vector<std::string> axes{"x", "y", "z"};
  if (reading.dimension > 0) axes.resize(static_cast<std::size_t>(reading.dimension));
  auto const word = section.word(key, axes);
  return word ? (*word)[0] - 'x' : otherwise;
}

/// axis, mode or wave_number, phase.
Wave read_wave(Section& section, Reading& reading) {
  int const axis = read_axis(section, "axis", 0, reading);
  double const phase = section.quantity("phase", dimensions::angle).value_or(0);
  auto const mode = section.integer("mode", 1);
  auto const wave_number = section.quantity("wave_number", dimensions::wave_number, positive);
  if (section.has("mode") == section.has("wave_number"))
    reading.mistake(section.place("wave_number"),
                    "a wave needs 'mode', its periods in the box, or 'wave_number', 2 pi over its length: one of them");
  if (wave_number) return {axis, *wave_number, phase};
  return mode && reading.box ? wave_of_mode(*reading.box, axis, static_cast<double>(*mode), phase)
                             : Wave{axis, 0, phase};
}

/// A wave to be added to the velocities.
struct VelocityRipple {
  Wave wave;
  int component = 0;
  double amplitude = 0;
};
VelocityRipple read_velocity_ripple(Item const& item, Reading& reading) {
  if (!item.is(Item::Kind::table)) {
    reading.mistake(
        item.place,
        fmt::format("velocity_ripple: a table is needed, {{ mode = 1, amplitude = 0.1 }}, not {}", found(item)));
    return {};
  }
  Section section(item, "velocity_ripple", reading.context);
  VelocityRipple ripple;
  ripple.wave = read_wave(section, reading);
  ripple.component = read_axis(section, "component", ripple.wave.axis, reading);
  ripple.amplitude = section.need_quantity("amplitude", dimensions::velocity, "amplitude = 0.1").value_or(0);
  section.finish();
  return ripple;
}

/// How the particles of one ensemble are put in their places.
class Loader {
 public:
  Loader(Item const& table, Reading& reading, ClassVariant const* variant)
      : reading_(reading), variant_(variant), section_(table, "load", reading.context), place_(table.place) {}

  /// Reads the table. `number` is what the ensemble says (0: what can't be read); afterwards count() particles are to
  /// be made.
  bool read(std::optional<std::size_t> number, Place const& number_place) {
    std::size_t const before = reading_.context.mistakes.count();
    Item const* word = section_.need("kind", "kind = \"block\"");
    if (!word) return false;
    auto const kind =
        read_word(*word, "load", {"block", "fill", "random", "quiet", "ripple", "gravity", "positions", "file"},
                  reading_.context);
    if (!kind) return false;
    kind_ = *kind;
    double own_count = 0;  // from what is loaded
    if (kind_ == "block") own_count = read_block();
    if (kind_ == "fill") own_count = read_fill();
    if (kind_ == "block" || kind_ == "fill")
      jitter_ = section_.quantity("jitter", dimensions::none, {0, 1}).value_or(0) * block_.spacing;
    if (kind_ == "random")
      distance_ = section_.quantity("minimum_distance", dimensions::length, not_negative).value_or(0);
    if (kind_ == "ripple") {
      wave_ = read_wave(section_, reading_);
      amplitude_ = section_.need_quantity("amplitude", dimensions::none, "amplitude = 0.1", {-1, 1}).value_or(0);
      quiet_ = section_.boolean("quiet");
    }
    if (kind_ == "gravity") {
      temperature_ = section_.need_quantity("temperature", dimensions::temperature, "temperature = \"300 K\"", positive)
                         .value_or(1);
      acceleration_ =
          section_.need_quantity("acceleration", dimensions::acceleration, "acceleration = \"9.81 m/s^2\"").value_or(0);
    }
    if (kind_ == "positions") own_count = read_positions();
    if (kind_ == "file") own_count = read_file();
    section_.finish();
    if (reading_.context.mistakes.count() != before) return false;
    if (kind_ == "random" || kind_ == "quiet" || kind_ == "ripple" || kind_ == "gravity") {
      if (!number) {
        reading_.mistake(place_, fmt::format("load \"{}\" needs 'number' in its ensemble, e.g. number = 1000", kind_));
        return false;
      }
      own_count = static_cast<double>(*number);
    } else if (number.value_or(0) != 0 && static_cast<double>(*number) != own_count) {
      reading_.mistake(number_place, fmt::format("number: {} particles, but load \"{}\" has places for {:.0f}; leave "
                                                 "'number' out",
                                                 *number, kind_, own_count));
      return false;
    }
    if (variant_ && !fits_memory(own_count, *variant_, number ? number_place : place_, reading_)) return false;
    if (kind_ == "fill" && own_count == 0) {
      if (reading_.box)
        reading_.mistake(section_.place("where"), "where: no place is left; the formula is 0 everywhere");
      return false;
    }
    count_ = static_cast<std::size_t>(own_count);
    return count_ > 0;
  }
  std::size_t count() const { return count_; }
  /// The space (length, area, volume) that each particle has, of lattices; nothing otherwise.
  std::optional<double> volume() const { return volume_; }

  /// Error if the lower rooms refuse.
  void load(AnyEnsemble& particles) {
    std::uint64_t const seed = reading_.run.seed;
    if (kind_ == "block") {
      block_load(particles, centred_ ? centred(block_, *reading_.box) : block_);
    } else if (kind_ == "random") {
      random_load(particles, *reading_.box, seed, distance_);
    } else if (kind_ == "quiet") {
      quiet_load(particles, *reading_.box);
    } else if (kind_ == "ripple" && quiet_) {
      quiet_load(particles, *reading_.box, wave_, amplitude_);
    } else if (kind_ == "ripple") {
      ripple_load(particles, *reading_.box, wave_, amplitude_, seed);
    } else if (kind_ == "gravity") {
      gravity_load(particles, *reading_.box, temperature_, acceleration_, reading_.boltzmann_constant(), seed);
    } else if (kind_ == "positions" || kind_ == "fill") {
      for (std::size_t i = 0; i < count_; ++i)
        std::copy_n(positions_.data() + i * static_cast<std::size_t>(particles.dimension()), particles.dimension(),
                    particles.row(i));
    } else {
      xyz_load(particles, frame_, options_);
    }
    if (jitter_ > 0) jitter(particles, jitter_, seed);
  }
  std::string const& file() const { return file_; }

 private:
  double read_block() {
    int const dimension = reading_.dimension;
    auto const name = section_.word("lattice", {"square", "triangular", "fcc", "bcc"});
    if (name) block_.kind = lattice_named(*name);
    block_.spacing =
        section_.need_quantity("spacing", dimensions::length, "spacing = \"2.551 angstrom\"", positive).value_or(1);
    double count = 1;
    if (Item const* counts = section_.need("counts", "counts = [25, 10]")) {
      if (!counts->is(Item::Kind::array) ||
          (dimension > 0 && counts->elements.size() != static_cast<std::size_t>(dimension))) {
        reading_.mistake(
            counts->place,
            fmt::format("counts: an array of {} whole numbers is needed, one for each axis, not {}{}", dimension,
                        found(*counts),
                        counts->is(Item::Kind::array) ? fmt::format(" of {}", counts->elements.size()) : ""));
      } else {
        for (std::size_t a = 0; a < counts->elements.size() && a < 3; ++a)
          if (auto const n = read_integer(counts->elements[a], "counts", 1, 1'000'000'000'000, reading_.context)) {
            block_.counts[a] = static_cast<std::size_t>(*n);
            count *= static_cast<double>(*n);
          }
      }
    }
    if (Item const* origin = section_.find("origin")) {
      if (origin->is(Item::Kind::text)) {
        centred_ = read_word(*origin, "origin", {"centred"}, reading_.context).has_value();
      } else if (dimension > 0) {
        if (auto const at = read_vector(*origin, "origin", dimension, dimensions::length, reading_.context)) {
          std::copy(at->begin(), at->end(), block_.origin.begin());
          centred_ = false;
        }
      }
    }
    if (block_.kind == Lattice::fcc) count *= 4;
    if (block_.kind == Lattice::bcc) count *= 2;
    if (dimension > 0) {
      try {
        volume_ = std::pow(block_.spacing / spacing_for_density(block_.kind, dimension, 1), dimension);
      } catch (Error const&) {  // there is no such lattice: load() says so
      }
    }
    return count;
  }

  /// A lattice that fills the block from low to high (without them the box), where a formula says so.
  double read_fill() {
    int const dimension = reading_.dimension;
    std::size_t const before = reading_.context.mistakes.count();
    auto const name = section_.word("lattice", {"square", "triangular"});
    if (name) block_.kind = lattice_named(*name);
    auto const spacing = section_.need_quantity("spacing", dimensions::length, "spacing = 0.1", positive);
    std::array<double, 3> low{}, high{};
    Item const *low_item = section_.find("low"), *high_item = section_.find("high"), *where = section_.find("where");
    for (int a = 0; a < dimension && reading_.box; ++a) {
      low[static_cast<std::size_t>(a)] = reading_.box->low(a);
      high[static_cast<std::size_t>(a)] = reading_.box->high(a);
    }
    for (auto const& [item, edge] : {std::pair(low_item, &low), std::pair(high_item, &high)})
      if (item && dimension > 0)
        if (auto const at =
                read_vector(*item, item == low_item ? "low" : "high", dimension, dimensions::length, reading_.context))
          std::copy(at->begin(), at->end(), edge->begin());
    if (reading_.box)
      for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
        if (!(low[a] < high[a]) && reading_.context.mistakes.count() == before)
          reading_.mistake(
              high_item ? high_item->place : low_item->place,
              fmt::format("{}: {} must be {} {} along {}", high_item ? "high" : "low", high_item ? high[a] : low[a],
                          high_item ? "above" : "below", high_item ? low[a] : high[a], "xyz"[a]));
    FormulaNames names(std::max(dimension, 1));
    auto const formula =
        where && dimension > 0 ? read_formula(*where, "where", names, {}, reading_) : std::optional<Formula>{};
    if (!spacing || !reading_.box || reading_.context.mistakes.count() != before) return 0;
    block_.spacing = *spacing;
    double count = 0;
    guarded(reading_, section_.place(section_.has("lattice") ? "lattice" : "spacing"), [&] {
      Filling const filling{block_.kind, *spacing, low, high};
      count = static_cast<double>(site_count(filling, dimension));
      if (variant_ && !fits_memory(count, *variant_, section_.place("spacing"), reading_)) return;
      volume_ = site_volume(filling, dimension);
      count = 0;
      for (auto const& place : lattice_sites(filling, dimension)) {
        if (formula && names.evaluate(*formula, place.data()) == 0) continue;
        positions_.insert(positions_.end(), place.begin(), place.begin() + dimension);
        ++count;
      }
    });
    return count;
  }

  double read_positions() {
    Item const* list = section_.need("positions", "positions = [[0, 0], [1, 0]]");
    if (!list) return 0;
    if (!list->is(Item::Kind::array) || list->elements.empty()) {
      reading_.mistake(list->place, fmt::format("positions: an array of positions is needed, [[0, 0], [1, 0]], not {}",
                                                found(*list)));
      return 0;
    }
    Dimension dimension = dimensions::length;
    if (variant_)
      for (auto const& field : variant_->fields)
        if (field.name == "position") dimension = field.dimension;
    if (reading_.dimension > 0)
      for (auto const& element : list->elements)
        if (auto const at = read_vector(element, "positions", reading_.dimension, dimension, reading_.context))
          positions_.insert(positions_.end(), at->begin(), at->end());
    return static_cast<double>(list->elements.size());
  }

  double read_file() {
    Item const* path_item = section_.need("path", "path = \"atoms.xyz\"");
    auto const path = path_item ? read_text(*path_item, "path", reading_.context) : std::nullopt;
    auto const frame = section_.integer("frame", 0).value_or(0);
    options_.species = section_.text("species").value_or("");
    options_.length = section_.quantity("length", dimensions::length, positive).value_or(1);
    options_.velocity = section_.quantity("velocity", dimensions::velocity, positive).value_or(1);
    if (!path) return 0;
    std::filesystem::path full = *path;
    if (full.is_relative() && !reading_.context.folder.empty())
      full = std::filesystem::path(reading_.context.folder) / full;
    file_ = std::filesystem::absolute(full).lexically_normal().string();
    guarded(reading_, path_item->place, [&] { frame_ = from_xyz_file(file_, static_cast<std::size_t>(frame)); });
    if (options_.species.empty()) return static_cast<double>(frame_.size());
    return static_cast<double>(std::count(frame_.species.begin(), frame_.species.end(), options_.species));
  }

  Reading& reading_;
  ClassVariant const* variant_;
  Section section_;
  Place place_;
  std::string kind_, file_;
  std::size_t count_ = 0;
  LatticeBlock block_;
  bool centred_ = true;
  std::optional<double> volume_;
  double jitter_ = 0, distance_ = 0, temperature_ = 1, acceleration_ = 0, amplitude_ = 0;
  Wave wave_;
  bool quiet_ = false;
  std::vector<double> positions_;
  XyzFrame frame_;
  XyzOptions options_;
};

/// The fields that the class has in this space (of its first variant if the space is not known).
std::vector<Field> fields_of(ParticleClass const& kind, int dimension) {
  ClassVariant const* variant = kind.in(dimension);
  return variant ? variant->fields : kind.variants.front().fields;
}

/// Fields of smooth particles that follow from others.
bool is_found(ParticleClass const& kind, std::string_view field) {
  return kind.matter != Matter::none && (field == "pressure" || field == "temperature" || field == "sound_speed");
}

/// The fields that a scenario can give.
std::vector<Field> given_fields(ParticleClass const& kind, int dimension) {
  auto fields = fields_of(kind, dimension);
  std::erase_if(fields, [&](Field const& field) { return is_found(kind, field.name); });
  return fields;
}

/// Says of fields that follow from others that they do.
void refuse_found(Section& section, ParticleClass const& kind, Reading& reading) {
  if (kind.matter == Matter::none) return;
  for (char const* key : {"pressure", "temperature", "sound_speed"}) {
    if (section.has(key))
      reading.mistake(section.place(key),
                      fmt::format("{}: the material finds it from density and specific_energy; give "
                                  "'specific_energy', e.g. by a formula",
                                  key));
    section.know(key);
  }
}

/// Reads the fields that stand in a table. The position is not one of them in an ensemble's own table.
std::vector<FieldValue> read_fields(Section& section, std::vector<Field> const& fields, bool with_position,
                                    std::size_t count, Reading& reading) {
  std::vector<FieldValue> values;
  for (auto const& field : fields) {
    if (field.name == "position" && !with_position) continue;
    Item const* item = section.find(field.name);
    if (item && reading.dimension > 0)
      if (auto value = read_field(*item, field, count, reading)) values.push_back(std::move(*value));
  }
  return values;
}

/// Whether an ensemble's table gives a field, as a value or by a formula.
bool gives(Section const& section, std::string_view field) {
  if (section.has(field)) return true;
  Item const* formulas = section.item("formulas");
  return formulas && formulas->find(field);
}

/// Fields that formulas can't use, because only the scheme finds them.
std::vector<std::string> unknown_fields(Section const& section, ParticleClass const& kind) {
  std::vector<std::string> unknown;
  for (auto const& field : fields_of(kind, 0))
    if (is_found(kind, field.name) ||
        (kind.matter != Matter::none && field.name == "density" && !gives(section, "density")))
      unknown.push_back(field.name);
  return unknown;
}

/// Whether there are ranges, masses and densities. `volume` is the space that each particle has.
void check_smooth(Section& section, std::optional<double> volume, bool loadable, Reading& reading) {
  bool const density = gives(section, "density"), mass = gives(section, "mass");
  if (reading.smooth.from_continuity && !density)
    reading.mistake(section.place(),
                    "density = \"continuity\" in [smooth] needs densities at the start; add e.g. "
                    "density = 1");
  if (density && mass && reading.smooth.wanted && !reading.smooth.from_continuity)
    reading.mistake(
        section.place(section.has("density") ? "density" : "formulas"),
        "density: it is the sum over the masses around a particle, and there is a 'mass' already; leave one "
        "out");
  if (!loadable) return;
  if (density && !mass && !volume)
    reading.mistake(section.place(section.has("density") ? "density" : "formulas"),
                    "density: masses follow from it only where particles are loaded by \"fill\" or \"block\", so that "
                    "each has its volume; give 'mass'");
  if (!gives(section, "range") && !(reading.smooth.variable && volume))
    reading.mistake(section.place(),
                    fmt::format("smooth particles need a 'range', {}; add e.g. range = 3",
                                reading.smooth.variable ? "from which variable_range starts"
                                                        : "how far each is spread: about 3 times their spacing"));
}

/// A range to start with, where ranges are found.
void set_ranges(AnyEnsemble& particles, double volume, double spacings) {
  int const offset = particles.field("range").offset;
  double const range = spacings * std::pow(volume, 1.0 / particles.dimension());
  for (std::size_t i = 0; i < particles.size(); ++i) particles.row(i)[offset] = range;
}

/// mass = density times volume.
void set_masses(AnyEnsemble& particles, double volume) {
  int const mass = particles.field("mass").offset, density = particles.field("density").offset;
  for (std::size_t i = 0; i < particles.size(); ++i) particles.row(i)[mass] = particles.row(i)[density] * volume;
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
      method_item ? read_word(*method_item, "integrator", method_names(), reading.context) : std::nullopt;
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
  if (kind) {
    if (section.has("position"))
      reading.mistake(table.find("position")->place,
                      "positions are loaded: load = { kind = \"positions\", positions = [...] }");
    refuse_found(section, *kind, reading);
    auto const given = given_fields(*kind, reading.dimension);
    fields = read_fields(section, given, false, count, reading);
    formulas =
        read_formulas(section, fields_of(*kind, reading.dimension), false, unknown_fields(section, *kind), reading);
    for (auto const& formula : formulas)
      if (is_found(*kind, formula.field.name))
        reading.mistake(formula.place,
                        fmt::format("{}: the material finds it from density and specific_energy", formula.field.name));
    section.know("position");
    for (auto const& value : fields)
      for (char const* key : {"mass", "density", "range"})
        if (value.field.name == key && (value.field.name == "mass" || kind->matter != Matter::none))
          for (double const number : value.values)
            if (!(number > 0)) {
              reading.mistake(section.place(key),
                              fmt::format("{}: {} is out of range; it must be positive", key, number));
              break;
            }
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
    bool const masses = smooth && loader->volume() && gives(section, "density") && !gives(section, "mass");
    if (smooth && loader->volume() && reading.smooth.variable && !gives(section, "range"))
      set_ranges(*particles, *loader->volume(), reading.smooth.variable->spacings);
    // The density goes before: from it follow masses, and other formulas may use both.
    for (bool const density : {true, false}) {
      for (auto const& formula : formulas)
        if (good && density == (formula.field.name == "density")) good = apply(formula, *particles, all, reading);
      if (density && good && masses) set_masses(*particles, *loader->volume());
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
      set_formulas = read_formulas(set, given, true, unknown_fields(section, *kind), reading);
    }
    if (kind) set.finish();
    if (!particles || !which || reading.context.mistakes.count() != before) continue;
    for (auto const& value : values) apply(value, *particles, *which);
    for (auto const& formula : set_formulas)
      if (!apply(formula, *particles, *which, reading)) break;
    if (freeze) frozen.insert(frozen.end(), which->begin(), which->end());
  }
  if (kind) section.finish();

  Method const method = method_word ? method_named(*method_word) : kind ? kind->usual_method : Method::leap_frog;
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
