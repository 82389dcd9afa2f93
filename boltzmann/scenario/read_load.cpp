// Reads load = { kind = ... }: the positions of the particles of an ensemble.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/loaders/jitter.hpp>
#include <boltzmann/loaders/path_load.hpp>
#include <boltzmann/loaders/plummer_load.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/ring_load.hpp>
#include <boltzmann/loaders/vortex_tube_load.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/loader.hpp>
#include <boltzmann/scenario/read_options.hpp>

#include <fmt/format.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace boltzmann {
namespace {

constexpr double max_particles = 1e9;

/// The memory of this number of particles, with their influences, the schemes' copies and lists.
double memory_of(double count, std::size_t row_bytes) { return count * (3.0 * static_cast<double>(row_bytes) + 200); }

/// The wave of `mode` or `wave_number`.
Wave wave_of(LoadOptions const& options, Section& section, Reading& reading) {
  int const axis = options.axis[0] - 'x';
  if (section.has("mode") == section.has("wave_number"))
    reading.mistake(section.place("wave_number"),
                    "a wave needs 'mode', its periods in the box, or 'wave_number', 2 pi over its length: one of them");
  if (options.wave_number) return {axis, *options.wave_number, options.phase};
  return options.mode > 0 && reading.box
             ? wave_of_mode(*reading.box, axis, static_cast<double>(options.mode), options.phase)
             : Wave{axis, 0, options.phase};
}

}  // namespace

std::string too_many(double count, std::size_t row_bytes) {
  double const machine = static_cast<double>(sysconf(_SC_PHYS_PAGES)) * static_cast<double>(sysconf(_SC_PAGE_SIZE));
  double const needed = memory_of(count, row_bytes), gib = 1024.0 * 1024 * 1024;
  if (count <= max_particles && needed <= machine) return "";
  return fmt::format(
      "{:.0f} particles would need about {:.0f} GiB of memory; this machine has {:.0f} GiB, and at most "
      "1000000000 are allowed",
      count, std::ceil(needed / gib), machine / gib);
}

bool fits_memory(double count, ClassVariant const& variant, Place const& place, Reading& reading) {
  auto why = too_many(count, variant.row_bytes);
  if (!why.empty()) reading.mistake(place, std::move(why));
  return why.empty();
}

VelocityRipple read_velocity_ripple(Item const& item, Reading& reading) {
  if (!item.is(Item::Kind::table)) {
    reading.mistake(
        item.place,
        fmt::format("velocity_ripple: a table is needed, {{ mode = 1, amplitude = 0.1 }}, not {}", describe(item)));
    return {};
  }
  Section section(item, "velocity_ripple", reading.context);
  LoadOptions options;
  read_options(section, ripple_options(), &options, {.dimension = reading.dimension});
  Wave const wave = wave_of(options, section, reading);
  section.finish();
  return {wave, options.amplitude, options.component.empty() ? wave.axis : options.component[0] - 'x'};
}

/// For each kind: the keys that it reads besides its options, and the function that places particles.
Loader::Way const& Loader::way_of(std::string_view kind) {
  static std::array const all{
      Way{"block", &Loader::read_block, &Loader::load_block},
      Way{"fill", &Loader::read_fill, &Loader::load_places},
      Way{"random", &Loader::read_random, &Loader::load_random},
      Way{"quiet", nullptr, &Loader::load_quiet},
      Way{"sinusoidal", &Loader::read_wave, &Loader::load_sinusoidal},
      Way{"barometric", nullptr, &Loader::load_barometric},
      Way{"plummer-sphere", nullptr, &Loader::load_plummer},
      Way{"disc", &Loader::read_disc, &Loader::load_disc},
      Way{"ring", &Loader::read_ring, &Loader::load_ring},
      Way{"ring-tube", &Loader::read_vortex_ring, &Loader::load_vortex_ring},
      Way{"path", &Loader::read_way, &Loader::load_way},
      Way{"positions", &Loader::read_positions, &Loader::load_places},
      Way{"file", &Loader::read_file, &Loader::load_file},
      Way{"frame", &Loader::read_frame, &Loader::load_frame},
  };
  auto const found = std::find_if(all.begin(), all.end(), [&](Way const& way) { return way.kind == kind; });
  if (found == all.end()) throw std::logic_error(fmt::format("nothing loads '{}'", kind));
  return *found;
}

bool Loader::read(std::optional<std::size_t> number, Place const& number_place, bool nobody) {
  std::size_t const before = reading_.context.mistakes.count();
  Item const* word = section_.need("kind", "kind = \"block\"");
  if (!word) return false;
  std::vector<std::string> names;
  for (auto const& one : load_kinds()) names.push_back(one.name);
  auto const name = read_word(*word, "load", names, reading_.context);
  if (!name) return false;
  for (auto const& one : load_kinds())
    if (one.name == *name) kind_ = &one;
  section_.explain_word("kind", kind_->doc);
  read_options(section_, kind_->options, &options_, {.dimension = reading_.dimension});
  block_.kind = options_.lattice;
  way_ = &way_of(*name);
  if (kind_->options.find("spacing")) read_spacing(number, number_place);
  double own_count = way_->read ? (this->*way_->read)() : 0;
  section_.finish();
  if (reading_.context.mistakes.count() != before) return false;
  if (nobody) {
    if (!kind_->counted)
      reading_.mistake(number_place,
                       "number: particles that events will add, and none before, need a load without "
                       "places of its own, e.g. load = { kind = \"random\" }");
    return kind_->counted;
  }
  if (kind_->counted && own_count == 0) {
    if (!number) {
      reading_.mistake(place_, fmt::format("load \"{}\" needs 'number' in its ensemble, e.g. number = 1000", *name));
      return false;
    }
    own_count = static_cast<double>(*number);
  } else if (number.value_or(0) != 0 && static_cast<double>(*number) != own_count) {
    reading_.mistake(number_place, fmt::format("number: {} particles, but load \"{}\" has places for {:.0f}; leave "
                                               "'number' out",
                                               *number, *name, own_count));
    return false;
  }
  if (variant_ && !fits_memory(own_count, *variant_, number ? number_place : place_, reading_)) return false;
  count_ = static_cast<std::size_t>(own_count);
  if (count_ == 0 && reading_.context.mistakes.count() == 0)
    reading_.mistake(place_, fmt::format("load \"{}\" gives no particles", *name));
  return count_ > 0;
}

/// The spacing of a lattice: as given, or from its density, or from the number of particles in a block.
void Loader::read_spacing(std::optional<std::size_t> number, Place const& number_place) {
  block_.spacing = 1;
  if (options_.spacing) {
    block_.spacing = *options_.spacing;
    spacing_known_ = true;
    for (char const* other : {"lattice_constant", "number_density"})
      section_.refuse(other, "'spacing' sets it, too; leave one out");
  } else if (options_.lattice_constant || options_.number_density) {
    bool const by_constant = options_.lattice_constant.has_value();
    if (by_constant) section_.refuse("number_density", "'lattice_constant' sets it, too; leave one out");
    if (reading_.dimension == 0) return;
    spacing_known_ = catch_errors(reading_, section_.place(by_constant ? "lattice_constant" : "number_density"), [&] {
      block_.spacing = by_constant ? spacing_for_constant(block_.kind, reading_.dimension, *options_.lattice_constant)
                                   : spacing_for_density(block_.kind, reading_.dimension, *options_.number_density);
    });
  } else if (kind_->name == "fill" && number) {
    read_corners();
    if (!reading_.box || *number == 0) return;
    if (variant_ && !fits_memory(static_cast<double>(*number), *variant_, number_place, reading_)) return;
    spacing_known_ = catch_errors(reading_, number_place, [&] {
      block_.spacing = spacing_for_number({block_.kind, 1, low_, high_}, reading_.dimension, *number);
    });
  } else if (!section_.has("spacing") && !section_.has("number_density") && !section_.has("lattice_constant")) {
    section_.need("spacing", reading_.context.units.is_reduced() ? "spacing = 1" : "spacing = \"2.551 angstrom\"");
  }
}

void Loader::load(AnyEnsemble& particles) {
  (this->*way_->load)(particles);
  if (options_.jitter > 0) jitter(particles, {.most = options_.jitter * block_.spacing, .seed = reading_.run.seed});
}

void Loader::load_block(AnyEnsemble& particles) {
  refuse_overlapping_ends(repeat_lengths(block_, particles.dimension()));
  block_load(particles, centred_ ? centred(block_, *reading_.box) : block_);
}

void Loader::load_quiet(AnyEnsemble& particles) { quiet_load(particles, *reading_.box); }

double Loader::read_wave() {
  wave_ = wave_of(options_, section_, reading_);
  return 0;
}

void Loader::load_sinusoidal(AnyEnsemble& particles) {
  if (options_.quiet)
    quiet_load(particles, *reading_.box, {.wave = wave_, .amplitude = options_.amplitude});
  else
    sinusoidal_load(particles, *reading_.box,
                    {.wave = wave_, .amplitude = options_.amplitude, .seed = reading_.run.seed});
}

void Loader::load_barometric(AnyEnsemble& particles) {
  barometric_load(particles, *reading_.box,
                  {.temperature = options_.temperature,
                   .gravity = options_.acceleration,
                   .boltzmann_constant = reading_.boltzmann_constant(),
                   .seed = reading_.run.seed});
}

double Loader::newton_constant() const {
  return options_.G.value_or(reading_.context.units.is_reduced() ? 1 : reading_.context.units(constants::gravitation));
}

void Loader::load_plummer(AnyEnsemble& particles) {
  std::array<double, 3> const none{0, 0, 0};
  plummer_load(particles, {.mass = options_.mass,
                           .radius = options_.radius,
                           .G = newton_constant(),
                           .centre = options_.centre.value_or(none),
                           .drift = options_.drift.value_or(none),
                           .seed = reading_.run.seed});
}

/// In two dimensions there is no normal.
double Loader::read_disc() {
  if (options_.normal && reading_.dimension == 2)
    reading_.mistake(section_.place("normal"), "normal: a disc in a plane has none; leave it out");
  if (options_.edge && options_.profile == DiscProfile::uniform)
    reading_.mistake(section_.place("edge"), "edge: a uniform disc ends at its radius; leave it out");
  return 0;
}

void Loader::load_disc(AnyEnsemble& particles) {
  DiscOptions options{.profile = options_.profile,
                      .mass = options_.mass,
                      .radius = options_.radius,
                      .edge = options_.edge.value_or(0),
                      .central_mass = options_.central_mass,
                      .G = newton_constant(),
                      .seed = reading_.run.seed};
  if (options_.centre) options.centre = *options_.centre;
  if (options_.drift) options.drift = *options_.drift;
  if (options_.normal) options.normal = *options_.normal;
  disc_load(particles, options);
}

double Loader::read_ring() {
  if (options_.normal && reading_.dimension == 2)
    reading_.mistake(section_.place("normal"), "normal: a ring in a plane has none; leave it out");
  if (options_.ripple != 0 ? !section_.has("mode") : section_.has("mode") && !section_.has("ripple"))
    reading_.mistake(section_.place(section_.has("mode") ? "mode" : "ripple"),
                     "a ripple has a mode, its periods around the circle, and a ripple, its height: both or none");
  return 0;
}

void Loader::load_ring(AnyEnsemble& particles) {
  RingOptions options{.radius = options_.radius, .mode = options_.mode, .ripple = options_.ripple};
  if (options_.centre) options.centre = *options_.centre;
  if (options_.normal) options.normal = *options_.normal;
  ring_load(particles, options);
}

namespace {

VortexTube tube_of(LoadOptions const& options) {
  return {.circulation = options.circulation,
          .core_radius = options.core_radius,
          .layers = static_cast<std::size_t>(options.layers),
          .overlap = options.overlap,
          .sections = static_cast<std::size_t>(options.sections)};
}

}  // namespace

double Loader::read_vortex_ring() {
  double count = 0;
  if (!section_.has("radius") || !section_.has("core_radius")) return 0;
  catch_errors(reading_, section_.place("core_radius"),
               [&] { count = static_cast<double>(vortex_tube_count(2 * pi * options_.radius, tube_of(options_))); });
  return count;
}

void Loader::load_vortex_ring(AnyEnsemble& particles) {
  if (!particles.find_field("vorticity"))
    throw Error(
        fmt::format("'{}' is of class {}, which has no vorticity; a vortex-ring is of Vortex, Inviscid or "
                    "Viscous",
                    particles.name(), particles.class_name()));
  VortexRing ring{.radius = options_.radius, .tube = tube_of(options_)};
  if (options_.centre) ring.centre = *options_.centre;
  if (options_.normal) ring.normal = *options_.normal;
  vortex_ring_load(particles, ring);
}

/// For `fill` and `positions`.
void Loader::load_places(AnyEnsemble& particles) {
  auto const dimension = static_cast<std::size_t>(particles.dimension());
  for (std::size_t i = 0; i < count_; ++i) std::copy_n(positions_.data() + i * dimension, dimension, particles.row(i));
}

void Loader::load_file(AnyEnsemble& particles) { frame_load(particles, frame_, frame_options()); }

FrameOptions Loader::frame_options() const {
  return {.species = options_.species,
          .length = options_.length,
          .velocity = options_.velocity,
          .units = reading_.context.units};
}

/// Reads the number of cells along each axis into block_.counts; returns their product.
double Loader::read_counts() {
  int const dimension = reading_.dimension;
  double count = 1;
  if (Item const* counts = section_.find("counts")) {
    if (!counts->is(Item::Kind::array) ||
        (dimension > 0 && counts->elements.size() != static_cast<std::size_t>(dimension))) {
      reading_.mistake(
          counts->place,
          fmt::format("counts: an array of {} whole numbers is needed, one for each axis, not {}{}", dimension,
                      describe(*counts),
                      counts->is(Item::Kind::array) ? fmt::format(" of {}", counts->elements.size()) : ""));
    } else {
      for (std::size_t a = 0; a < counts->elements.size() && a < 3; ++a)
        if (auto const n = read_integer(counts->elements[a], "counts", 1, 1'000'000'000'000, reading_.context)) {
          block_.counts[a] = static_cast<std::size_t>(*n);
          count *= static_cast<double>(*n);
        }
    }
  }
  return count;
}

double Loader::read_way() { return read_counts(); }

void Loader::load_way(AnyEnsemble& particles) {
  path_load(particles, *reading_.box, {.counts = block_.counts, .seed = reading_.run.seed});
}

double Loader::read_block() {
  int const dimension = reading_.dimension;
  double count = read_counts();
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
  if (block_.kind == Lattice::fcc || block_.kind == Lattice::hcp) count *= 4;
  if (block_.kind == Lattice::bcc) count *= 2;
  if (block_.kind == Lattice::diamond) count *= 8;
  if (dimension > 0 && spacing_known_) {
    try {
      volume_ = std::pow(block_.spacing / spacing_for_density(block_.kind, dimension, 1), dimension);
    } catch (Error const&) {  // there is no such lattice; load() reports it
    }
  }
  return count;
}

/// A block longer than its periodic axis would wrap around and overlap itself.
void Loader::refuse_overlapping_ends(std::array<double, 3> const& lengths) {
  for (int a = 0; a < reading_.dimension && reading_.box; ++a) {
    double const length = lengths[static_cast<std::size_t>(a)], axis = reading_.box->length(a);
    if (!reading_.box->periodic(a) || length - axis <= block_.spacing / 2) continue;
    auto const told = [&](double number) { return reading_.context.units.text(number, dimensions::length, 6); };
    Place const counts = section_.place("counts"), spacing = section_.place("spacing");
    reading_.mistake(
        spacing.override_number > counts.override_number ? spacing : counts,
        fmt::format("counts: the block is {} long along {}, the periodic axis {}: its ends would overlap{}",
                    told(length), "xyz"[a], told(axis),
                    options_.spacing && block_.kind != Lattice::square
                        ? "; 'spacing' is of nearest neighbours, not the lattice constant"
                        : ""));
    return;
  }
}

/// The block from low to high; default: the box.
void Loader::read_corners() {
  if (std::exchange(corners_read_, true)) return;
  int const dimension = reading_.dimension;
  for (int a = 0; a < dimension && reading_.box; ++a) {
    low_[static_cast<std::size_t>(a)] = reading_.box->low(a);
    high_[static_cast<std::size_t>(a)] = reading_.box->high(a);
  }
  low_ = options_.low.value_or(low_), high_ = options_.high.value_or(high_);
  if (!reading_.box || section_.has("low") != options_.low.has_value() ||
      section_.has("high") != options_.high.has_value())
    return;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
    if (!(low_[a] < high_[a]))
      section_.mistake(options_.high ? "high" : "low",
                       fmt::format("{} must be {} {} along {}", options_.high ? high_[a] : low_[a],
                                   options_.high ? "above" : "below", options_.high ? low_[a] : high_[a], "xyz"[a]));
}

void Loader::read_where() {
  Item const* where = section_.find("where");
  if (where && reading_.dimension > 0)
    where_ = read_formula(*where, "where", formula_names(reading_.dimension, reading_), {}, reading_);
}

bool Loader::is_wanted(double const* place) { return !where_ || (*where_)(place) != 0; }

/// The number follows from a packing fraction and a distance.
double Loader::read_random() {
  read_corners();
  read_where();
  if (!options_.packing_fraction || !reading_.box || reading_.dimension == 0) return 0;
  if (section_.has("where") || !reading_.box->regions().empty()) {
    reading_.mistake(section_.place("packing_fraction"),
                     "packing_fraction: it refers to the whole block, of which 'where' and regions leave an unknown "
                     "part; give minimum_distance and number");
    return 0;
  }
  double count = 0;
  catch_errors(reading_, section_.place("packing_fraction"), [&] {
    check_packing(*options_.packing_fraction, reading_.dimension);
    if (options_.minimum_distance > 0)
      count = count_for_packing(part_of_box(), options_.minimum_distance, *options_.packing_fraction);
    if (options_.minimum_distance > 0 && count < 1)
      throw Error("packing_fraction: a single particle of this minimum_distance fills more");
  });
  return count;
}

/// The box from low to high; a whole periodic axis remains periodic.
Box Loader::part_of_box() const {
  Box const& box = *reading_.box;
  std::array<Boundary, 3> boundaries{Boundary::open, Boundary::open, Boundary::open};
  for (std::size_t a = 0; a < static_cast<std::size_t>(box.dimension()); ++a) {
    int const axis = static_cast<int>(a);
    if (low_[a] == box.low(axis) && high_[a] == box.high(axis)) boundaries[a] = box.boundary(axis);
  }
  return Box(box.dimension(), low_, high_, boundaries);
}

RandomLoadOptions Loader::random_options() const {
  RandomLoadOptions options{.minimum_distance = options_.minimum_distance, .seed = reading_.run.seed};
  if (options_.packing_fraction && options.minimum_distance == 0) options.packing_fraction = *options_.packing_fraction;
  return options;
}

PlaceAgain Loader::place_again() const {
  if (!kind_ || kind_->name != "random" || !reading_.box) return nullptr;
  auto options = random_options();
  if (where_)
    options.where = [where = std::make_shared<ParticleFormula>(*where_)](double const* at) {
      return (*where)(at) != 0;
    };
  std::optional<Box> part;
  if (section_.has("low") || section_.has("high")) {
    part.emplace(part_of_box());
    for (auto const& region : reading_.box->regions()) part->install(region);
  }
  return
      [options, part](AnyEnsemble& particles, Box const& now, std::vector<AnyEnsemble const*> others, double distance) {
        RandomLoadOptions again = options;
        again.others = std::move(others);
        again.distance_to_others = distance;
        again.space = &now;
        random_load(particles, part ? *part : now, again);
      };
}

void Loader::load_random(AnyEnsemble& particles) {
  Box const& box = *reading_.box;
  RandomLoadOptions options = random_options();
  if (where_) options.where = [&](double const* place) { return is_wanted(place); };
  if (!section_.has("low") && !section_.has("high")) return random_load(particles, box, options);
  Box part = part_of_box();
  for (auto const& region : box.regions()) part.install(region);
  random_load(particles, part, options);
}

double Loader::read_fill() {
  int const dimension = reading_.dimension;
  std::size_t const before = reading_.context.mistakes.count();
  read_corners();
  read_where();
  if (!spacing_known_ || !reading_.box || reading_.context.mistakes.count() != before) return 0;
  double count = 0;
  catch_errors(reading_, section_.place(section_.has("lattice") ? "lattice" : "spacing"), [&] {
    Filling const filling{block_.kind, block_.spacing, low_, high_};
    count = static_cast<double>(filling_count(filling, dimension));
    if (variant_ && !fits_memory(count, *variant_, section_.place("spacing"), reading_)) return;
    volume_ = site_volume(filling, dimension);
    count = 0;
    for (auto const& place : filling_sites(filling, dimension)) {
      if (!is_wanted(place.data())) continue;
      positions_.insert(positions_.end(), place.begin(), place.begin() + dimension);
      ++count;
    }
  });
  if (count == 0 && reading_.context.mistakes.count() == before)
    reading_.mistake(section_.place("where"), "where: no place is left; the formula is 0 everywhere");
  return count;
}

double Loader::read_positions() {
  Item const* list = section_.find("positions");
  if (!list) return 0;
  if (!list->is(Item::Kind::array) || list->elements.empty()) {
    reading_.mistake(list->place, fmt::format("positions: an array of positions is needed, [[0, 0], [1, 0]], not {}",
                                              describe(*list)));
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

double Loader::read_file() {
  Place const path = section_.place("path");
  if (options_.path.empty()) return 0;
  if (!catch_errors(reading_, path, [&] {
        frame_ = from_particle_file(options_.path, {.frame = static_cast<std::size_t>(options_.frame),
                                                    .format = options_.format,
                                                    .units = options_.units,
                                                    .style = options_.style});
      }))
    return 0;
  if (reading_.box)
    catch_errors(reading_, path, [&] {
      if (auto const line = lattice_misfit(frame_, *reading_.box, frame_options()); !line.empty())
        throw Error("path: " + line);
    });
  double count = 0;
  catch_errors(reading_, section_.place(section_.has("species") ? "species" : "path"), [&] {
    count = static_cast<double>(count_species(frame_, options_.species));
    if (count == 0) throw Error(fmt::format("path: frame {} of '{}' has no particles", options_.frame, file_name()));
  });
  return count;
}

namespace {

/// True if the edges of a lattice are not those of a rectangular box.
bool is_skew(std::array<double, 9> const& lattice) {
  for (std::size_t k = 0; k < 9; ++k)
    if (k % 4 != 0 && lattice[k] != 0) return true;
  return false;
}

}  // namespace

std::string Loader::file_name() const { return options_.path.substr(options_.path.find_last_of('/') + 1); }

bool Loader::sets(std::string_view field) const {
  if (!kind_) return false;
  if (kind_->name == "file") return frame_.find(field) != nullptr;
  if (kind_->name == "frame") return true;
  return field == "mass" && (kind_->name == "plummer-sphere" || kind_->name == "disc");
}

std::vector<double> Loader::element_masses() const {
  return boltzmann::element_masses(frame_, options_.species, reading_.context.units);
}

/// Units if neither the file nor the scenario sets them. XYZ files have positions in angstrom.
std::string Loader::assumed_units(AnyEnsemble const& particles, std::vector<std::string> const& given) const {
  UnitSystem const& units = reading_.context.units;
  if (units.is_reduced() || !reading_.base_known || !options_.units.empty()) return "";
  std::vector<std::string> assumed;
  for (auto const& [name, dimension] : {std::pair<char const*, Dimension>{"position", dimensions::length},
                                        {"velocity", dimensions::velocity},
                                        {"mass", dimensions::mass},
                                        {"charge", dimensions::charge}}) {
    auto const* column = frame_.find(name);
    if (!column || !column->unit.empty() || !particles.find_field(name)) continue;
    if (std::find(given.begin(), given.end(), name) != given.end()) continue;
    if ((options_.length && dimension == dimensions::length) ||
        (options_.velocity && dimension == dimensions::velocity))
      continue;
    auto const base = units.display(dimension);
    std::string const text = base.factor == 1 ? base.unit : units.text(1, dimension, 6);
    bool const usual = dimension == dimensions::length && text == "angstrom";
    if (!usual) assumed.push_back(fmt::format("{} in {}", name, text));
  }
  if (assumed.empty()) return "";
  return fmt::format("note: '{}': {} has no units, and is read in those of the base ({}); `units` in load names others",
                     ensemble_, file_name(), join(assumed));
}

/// Notes on a stored frame: fields that the class does not have, and another box.
std::vector<std::string> Loader::notes_of_frame(AnyEnsemble const& particles) const {
  std::vector<std::string> all, unread;
  auto const& stored = stored_->find(options_.ensemble);
  for (auto const& field : stored.fields)
    if (!particles.find_field(field.name)) unread.push_back(field.name);
  if (!unread.empty())
    all.push_back(fmt::format("note: '{}': left aside of {}: {} (a class with fields of these names gets them)",
                              ensemble_, file_name(), join(unread)));
  bool const in_units = std::any_of(stored.fields.begin(), stored.fields.end(),
                                    [](auto const& field) { return field.name == "position" && !field.unit.empty(); });
  if (!in_units && !reading_.context.units.is_reduced())
    all.push_back(fmt::format("note: '{}': {} has pure numbers, which are read in the units of the base", ensemble_,
                              file_name()));
  if (in_units != !reading_.context.units.is_reduced()) return all;
  auto const before = stored_->box(stored_frame_, TrajectoryReader::Numbers::written);
  double unit = 1;
  for (auto const& field : stored.fields)
    if (field.name == "position" && in_units)
      unit = reading_.context.units.from_si(parse_quantity("1 " + field.unit).si, dimensions::length);
  Box const& box = *reading_.box;
  for (int a = 0; a < std::min(before.dimension, box.dimension()); ++a) {
    double const length = unit * (before.high[a] - before.low[a]);
    if (before.periodic[a] && box.periodic(a) && !(std::abs(length - box.length(a)) <= 1e-6 * length))
      all.push_back(fmt::format("warning: '{}': the box of {} is {} long along {}, this one {}", ensemble_, file_name(),
                                reading_.context.units.text(length, dimensions::length, 8), "xyz"[a],
                                reading_.context.units.text(box.length(a), dimensions::length, 8)));
  }
  return all;
}

std::vector<std::string> Loader::notes(AnyEnsemble const& particles, std::vector<std::string> const& given) const {
  std::vector<std::string> all;
  if (kind_ && kind_->name == "frame" && stored_) return notes_of_frame(particles);
  if (!reads_file()) return all;
  if (frame_.lattice && is_skew(*frame_.lattice))
    all.push_back(
        fmt::format("note: '{}': the box of {} has no right angles; only its atoms are taken", ensemble_, file_name()));
  auto const aside = left_aside(particles, frame_, given);
  if (!aside.empty())
    all.push_back(fmt::format("note: '{}': left aside of {}: {}", ensemble_, file_name(), join(aside, "; ")));
  if (auto line = assumed_units(particles, given); !line.empty()) all.push_back(std::move(line));
  auto const* charge = particles.find_field("charge");
  if (charge && !frame_.find("charge") && std::find(given.begin(), given.end(), "charge") == given.end())
    all.push_back(
        fmt::format("note: '{}': {} has no charges, so they are 0; `charge` gives others", ensemble_, file_name()));
  return all;
}

void Loader::count_species_taken() const {
  if (!reads_file()) return;
  auto& file = reading_.files[fmt::format("{}, frame {}", options_.path, options_.frame)];
  file.name = file_name();
  if (file.species.empty())
    for (auto const& word : frame_.species) ++file.species[word].particles;
  for (auto const& word : words_of_species(frame_, options_.species))
    if (auto const found = file.species.find(word); found != file.species.end()) ++found->second.ensembles;
}

double Loader::read_frame() {
  std::string const& path = options_.path;
  if (path.empty()) return 0;
  double count = 0;
  catch_errors(reading_, section_.place("path"), [&] {
    stored_.emplace(path);
    if (options_.ensemble.empty()) options_.ensemble = ensemble_;
    auto const frames = static_cast<std::int64_t>(stored_->frames());
    std::int64_t const frame = section_.has("frame") ? options_.frame : -1;
    if (frame >= frames || frame < -frames)
      throw Error(fmt::format("path: '{}' has {} frames, there is none of number {}", path, frames, frame));
    stored_frame_ = static_cast<std::size_t>(frame < 0 ? frame + frames : frame);
    auto const& stored = stored_->find(options_.ensemble);
    if (reading_.dimension > 0 && stored.dimension != reading_.dimension)
      throw Error(fmt::format("path: '{}' is in {}D, the box in {}D", path, stored.dimension, reading_.dimension));
    count = static_cast<double>(stored_->size(stored_frame_, options_.ensemble));
    if (count == 0)
      throw Error(fmt::format("path: that frame of '{}' has no particles of '{}'", path, options_.ensemble));
  });
  return count;
}

/// Numbers of a run with another base are converted; those with the same base keep their bits.
void Loader::load_frame(AnyEnsemble& particles) {
  stored_->load(stored_frame_, options_.ensemble, particles);
  UnitSystem const& units = reading_.context.units;
  if (units.is_reduced() || !reading_.base_known) return;
  for (auto const& stored : stored_->find(options_.ensemble).fields) {
    Field const* field = particles.find_field(stored.name);
    if (!field || field->components != stored.components || stored.unit.empty()) continue;
    auto const unit = parse_quantity("1 " + stored.unit);
    if (unit.dimension != field->dimension)
      throw Error(fmt::format("path: '{}' has {} in {}, which is no {}", file_name(), stored.name, stored.unit,
                              name_of(field->dimension)));
    double const ratio = stored.factor * units.from_si(unit.si, field->dimension);
    if (std::abs(ratio - 1) < 1e-9) continue;
    for (std::size_t i = 0; i < particles.size(); ++i)
      for (int c = 0; c < field->components; ++c) particles.row(i)[field->offset + c] *= ratio;
  }
}

}  // namespace boltzmann
