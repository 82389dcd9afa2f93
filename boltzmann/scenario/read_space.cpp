// Reads [units], [box] and [run].
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <fmt/format.h>

#include <array>
#include <limits>

namespace boltzmann {
namespace {

std::vector<std::string> const base_names{"si", "cgs", "reduced", "lennard-jones", "gravitational", "plasma", "custom"};

/// A quantity of a base's own table: it needs a unit, or is taken in SI.
template <Dimension d>
std::optional<Quantity<d>> unit(Section& units, std::string_view key, std::string_view example) {
  auto const value = units.need_quantity(key, d, example);
  return value ? std::optional(Quantity<d>{*value}) : std::nullopt;
}

Base read_base(Section& units, std::string const& name) {
  using namespace dimensions;
  if (name == "si") return Base::si();
  if (name == "cgs") return Base::cgs();
  if (name == "reduced") return Base::reduced();
  if (name == "lennard-jones") {
    auto const sigma = unit<length>(units, "sigma", "sigma = \"3.405 angstrom\"");
    auto const epsilon = unit<energy>(units, "epsilon", "epsilon = \"0.01032 eV\"");
    auto const m = unit<mass>(units, "mass", "mass = \"39.948 amu\"");
    if (sigma && epsilon && m) return Base::lennard_jones(*sigma, *epsilon, *m);
  } else if (name == "gravitational") {
    auto const l = unit<length>(units, "length", "length = \"1 AU\"");
    auto const m = unit<mass>(units, "mass", "mass = \"1 Msun\"");
    if (l && m) return Base::gravitational(*l, *m);
  } else if (name == "plasma") {
    auto const n = unit<number_density>(units, "density", "density = \"1e18 1/m^3\"");
    auto const q = unit<charge>(units, "charge", "charge = \"1.602176634e-19 C\"");
    auto const m = unit<mass>(units, "mass", "mass = \"9.1093837015e-31 kg\"");
    auto const t = unit<temperature>(units, "temperature", "temperature = \"10000 K\"");
    if (n && q && m && t) return Base::electrostatic_plasma(*n, *q, *m, *t);
  } else if (name == "custom") {
    auto const l = unit<length>(units, "length", "length = \"1 angstrom\"");
    auto const m = unit<mass>(units, "mass", "mass = \"1 amu\"");
    auto const t = unit<time>(units, "time", "time = \"1 ps\"");
    auto const kelvins = units.quantity("temperature", temperature);
    auto const coulombs = units.quantity("charge", charge);
    if (l && m && t)
      return Base(*l, *m, *t, kelvins ? Quantity<temperature>{*kelvins} : units::kelvin,
                  coulombs ? Quantity<charge>{*coulombs} : units::elementary_charge);
  }
  return Base::si();
}

}  // namespace

std::vector<std::string> Reading::ensemble_names() const {
  std::vector<std::string> names;
  for (auto const& e : ensembles) names.push_back(e.name);
  return names;
}

ReadEnsemble* Reading::ensemble(Item const& word, std::string_view key) {
  auto const name = read_text(word, key, context);
  if (!name) return nullptr;
  for (auto& e : ensembles)
    if (e.name == *name) return &e;
  auto const names = ensemble_names();
  // One whose own name could not be read may be the one that is meant.
  for (auto const& e : ensembles)
    if (e.name.empty()) return nullptr;
  mistake(word.place,
          fmt::format("{}: there is no ensemble '{}'; there {} {}{}", key, *name, names.size() == 1 ? "is" : "are",
                      names.empty() ? "none" : join(names), did_you_mean(*name, names)));
  return nullptr;
}

double Reading::boltzmann_constant() const {
  return context.base.is_reduced() ? 1.0 : context.base(constants::boltzmann);
}

void read_units(Section& document, Reading& reading) {
  Item const* table = find_table(document, "units");
  reading.base_known = !document.has("units");
  if (!table) return;
  Section units(*table, "[units]", reading.context);
  std::size_t const before = reading.context.mistakes.count();
  Item const* word = units.need("base", "base = \"si\"");
  auto const name = word ? read_word(*word, "base", base_names, reading.context) : std::nullopt;
  Base base;
  if (name) guarded(reading, units.place(), [&] { base = read_base(units, *name); });
  reading.base_known = reading.context.mistakes.count() == before;
  // Without a base nobody knows which keys it would have had.
  if (name) units.finish();
  if (reading.base_known) {
    reading.context.base = base;
    reading.result->base = base;
    reading.result->reduced = base.is_reduced();
  }
}

void read_box(Section& document, Reading& reading) {
  Item const* table = find_table(document, "box");
  if (!document.has("box"))
    reading.mistake({}, "there is no [box]; add e.g. [box] low = [0, 0], high = [10, 10], boundary = \"periodic\"");
  if (!table) return;
  Section section(*table, "[box]", reading.context);
  std::size_t const before = reading.context.mistakes.count();
  Item const* low_item = section.need("low", "low = [0, 0]");
  Item const* high_item = section.need("high", "high = [10, 10]");
  std::vector<double> low, high;
  for (auto const& [item, key] : {std::pair(low_item, "low"), std::pair(high_item, "high")}) {
    if (!item) continue;
    if (!item->is(Item::Kind::array) || item->elements.empty() || item->elements.size() > 3) {
      reading.mistake(item->place,
                      fmt::format("{}: an array of 1, 2 or 3 lengths is needed, not {}{}", key, found(*item),
                                  item->is(Item::Kind::array) && !item->elements.empty()
                                      ? fmt::format(" of {}", item->elements.size())
                                      : ""));
      continue;
    }
    if (reading.dimension == 0) reading.dimension = static_cast<int>(item->elements.size());
    auto values = read_vector(*item, key, reading.dimension, dimensions::length, reading.context);
    if (values) (item == low_item ? low : high) = *values;
  }
  auto const kind = [&](Item const& item) {
    auto const word = read_word(item, "boundary", {"open", "bounded", "periodic"}, reading.context);
    return !word || *word == "open" ? Boundary::open : *word == "bounded" ? Boundary::bounded : Boundary::periodic;
  };
  std::array<Boundary, 3> boundaries{Boundary::open, Boundary::open, Boundary::open};
  if (Item const* item = section.find("boundary")) {
    if (!item->is(Item::Kind::array)) {
      boundaries.fill(kind(*item));
    } else if (reading.dimension > 0 && item->elements.size() != static_cast<std::size_t>(reading.dimension)) {
      reading.mistake(item->place, fmt::format("boundary: {} word{} for {} ax{}; give one for all, or one for each",
                                               item->elements.size(), item->elements.size() == 1 ? "" : "s",
                                               reading.dimension, reading.dimension == 1 ? "is" : "es"));
    } else {
      for (std::size_t a = 0; a < item->elements.size() && a < 3; ++a) boundaries[a] = kind(item->elements[a]);
    }
  }
  auto const wide = [](std::vector<double> const& v) {
    std::array<double, 3> w{};
    for (std::size_t a = 0; a < v.size() && a < 3; ++a) w[a] = v[a];
    return w;
  };
  if (low_item && high_item && low_item->is(Item::Kind::array) && high_item->is(Item::Kind::array) &&
      low_item->elements.size() != high_item->elements.size())
    reading.dimension = 0;  // nobody knows which of the two is meant
  if (reading.context.mistakes.count() == before && reading.base_known && !low.empty() && !high.empty())
    guarded(reading, high_item->place,
            [&] { reading.box.emplace(reading.dimension, wide(low), wide(high), boundaries); });
  for (Item const* region_table : find_tables(section, "regions")) {
    Section region(*region_table, "[[box.regions]]", reading.context);
    Item const* first = region.need("low", "low = [2, 2]");
    Item const* second = region.need("high", "high = [4, 4]");
    Item const* side_item = region.need("side", "side = \"keep-out\"");
    auto const side =
        side_item ? read_word(*side_item, "side", {"keep-out", "keep-in"}, reading.context) : std::nullopt;
    region.finish();
    if (!first || !second || reading.dimension == 0) continue;
    auto const from = read_vector(*first, "low", reading.dimension, dimensions::length, reading.context);
    auto const to = read_vector(*second, "high", reading.dimension, dimensions::length, reading.context);
    if (from && to && side && reading.box)
      guarded(reading, region.place(), [&] {
        reading.box->install(
            {wide(*from), wide(*to), *side == "keep-in" ? Region::Side::keep_in : Region::Side::keep_out});
      });
  }
  section.finish();
}

void read_run(Section& document, Reading& reading) {
  Item const* table = find_table(document, "run");
  if (!document.has("run")) reading.mistake({}, "there is no [run]; add e.g. [run] step = 0.01, steps = 1000");
  ReadRun& run = reading.run;
  run.cutoff_known = table && (!table->find("cutoff"));
  if (!table) return;
  Section section(*table, "[run]", reading.context);
  run.place = table->place;
  run.step = section.need_quantity("step", dimensions::time, "step = 0.01", positive);
  if (Item const* steps = section.need("steps", "steps = 1000"))
    run.steps = read_integer(*steps, "steps", 0, std::numeric_limits<std::int64_t>::max(), reading.context).value_or(0);
  run.seed = static_cast<std::uint64_t>(section.integer("seed", 0).value_or(1));
  run.threads = static_cast<int>(section.integer("threads", 0, 4096).value_or(0));
  run.cutoff = section.quantity("cutoff", dimensions::length, positive);
  run.cutoff_known = run.cutoff_known || run.cutoff;
  run.cutoff_place = section.place("cutoff");
  run.skin = section.quantity("skin", dimensions::length, not_negative);
  section.finish();
  if (run.cutoff && reading.box)
    for (int a = 0; a < reading.dimension; ++a)
      if (reading.box->periodic(a) && *run.cutoff > reading.box->length(a)) {
        reading.mistake(run.cutoff_place,
                        fmt::format("cutoff: {} is longer than the periodic axis {}, which allows at most {}",
                                    *run.cutoff, "xyz"[a], reading.box->length(a)));
        run.cutoff = reading.box->length(a);
      }
}

}  // namespace boltzmann
