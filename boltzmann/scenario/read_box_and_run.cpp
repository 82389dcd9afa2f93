// Reads [units], [box] and [run].
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/tables.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <stdexcept>

namespace boltzmann {
namespace {

/// Requires all keys of its base.
UnitSystem base_of(UnitsOptions const& of) {
  if (of.base == "cgs") return UnitSystem::cgs();
  if (of.base == "reduced") return UnitSystem::reduced();
  if (of.base == "lennard-jones") return UnitSystem::lennard_jones({*of.sigma}, {*of.epsilon}, {*of.mass});
  if (of.base == "gravitational") return UnitSystem::gravitational({*of.length}, {*of.mass});
  if (of.base == "plasma")
    return UnitSystem::electrostatic_plasma({*of.density}, {*of.charge}, {*of.mass}, {*of.temperature});
  if (of.base == "custom")
    return UnitSystem({*of.length}, {*of.mass}, {*of.time}, {of.temperature.value_or(units::kelvin.si)},
                      {of.charge.value_or(units::elementary_charge.si)});
  return UnitSystem::si();
}

void read_wall(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[box.walls]]", reading.context);
  WallOptions options;
  read_options(section, wall_options(), &options, {.dimension = reading.dimension});
  Wall& wall = options.wall;
  if (options.velocity) wall.velocity = *options.velocity;
  if (options.open)
    for (char const* key : {"slips", "velocity", "temperature"})
      section.refuse(key, "with open = true there is no wall that has one");
  section.finish();
  if (reading.context.mistakes.count() != before || !reading.box) return;
  int const a = options.axis[0] - 'x';
  Boundary const boundary = reading.box->boundary(a);
  if (boundary != Boundary::mirror && boundary != Boundary::reflecting)
    return section.mistake(
        "axis", fmt::format("{} is {}; walls need an axis whose boundary is \"mirror\" or \"reflecting\"", options.axis,
                            to_string(boundary)));
  if (boundary == Boundary::reflecting) {
    auto const refuse = [&](char const* key, char const* what) {
      section.mistake(key, fmt::format("{} is reflecting, where walls {}; what drags or heats is the wall of an axis "
                                       "whose boundary is \"mirror\"",
                                       options.axis, what));
    };
    if (!wall.slips) refuse("slips", "always slip");
    if (section.has("temperature")) refuse("temperature", "are insulated");
    auto along = wall.velocity;
    along[static_cast<std::size_t>(a)] = 0;
    if (along != std::array<double, 3>{}) refuse("velocity", "move along it only");
    if (reading.context.mistakes.count() != before) return;
  }
  catch_errors(reading, table.place,
               [&] { options.open ? reading.box->open_end(a, options.end) : reading.box->wall(a, options.end, wall); });
}

/// A time, "courant" or { courant = 0.5 }.
void read_step(Item const& item, ReadRun& run, Reading& reading) {
  if (item.is(Item::Kind::text) && item.text == "courant") {
    run.courant = 1;
    if (reading.context.notes) reading.context.notes->plain(item, "text");
  } else if (item.is(Item::Kind::table)) {
    Section section(item, "step", reading.context);
    run.courant = item.entries.empty() ? section.need_quantity("courant", dimensions::none, "courant = 0.5", positive)
                                       : section.quantity("courant", dimensions::none, positive);
    section.finish();
  } else {
    run.step = read_quantity(item, "step", dimensions::time, reading.context, positive);
  }
}

}  // namespace

void Reading::note(std::string line) {
  auto& notes = result->notes;
  if (std::find(notes.begin(), notes.end(), line) == notes.end()) notes.push_back(std::move(line));
}

std::vector<std::string> Reading::ensemble_names() const {
  std::vector<std::string> names;
  for (auto const& e : ensembles) names.push_back(e.name);
  return names;
}

ReadEnsemble* Reading::ensemble(Item const& word, std::string_view key) {
  auto const name = read_text(word, key, context);
  if (!name) return nullptr;
  auto const names = ensemble_names();
  if (context.notes) context.notes->word(word, names);
  for (auto& e : ensembles)
    if (e.name == *name) return &e;
  // An ensemble whose name could not be read may be the one that is named.
  for (auto const& e : ensembles)
    if (e.name.empty()) return nullptr;
  mistake(word.place, fmt::format("{}: there is no ensemble '{}'{}", key, *name, choices(*name, names)));
  return nullptr;
}

double Reading::boltzmann_constant() const {
  return context.units.is_reduced() ? 1.0 : context.units(constants::boltzmann);
}

void read_units(Section& document, Reading& reading) {
  Item const* table = find_table(document, "units");
  reading.base_known = !document.has("units");
  if (!table) return;
  Section units(*table, "[units]", reading.context);
  std::size_t const before = reading.context.mistakes.count();
  UnitsOptions options;
  OptionTable const base = units_options().only({{.key = "base", .needed = "\"si\""}});
  read_options(units, base, &options, {});
  read_options(units, units_options(options.base), &options, {});
  UnitSystem chosen;
  if (reading.context.mistakes.count() == before)
    catch_errors(reading, units.place(), [&] { chosen = base_of(options); });
  reading.base_known = reading.context.mistakes.count() == before;
  // Without a base, its keys are unknown.
  if (!options.base.empty()) units.finish();
  if (reading.base_known) {
    reading.context.units = chosen;
    reading.result->units = chosen;
    reading.result->reduced = chosen.is_reduced();
  }
}

namespace {

std::array<double, 3> wide(std::vector<double> const& v) {
  std::array<double, 3> w{};
  for (std::size_t a = 0; a < v.size() && a < 3; ++a) w[a] = v[a];
  return w;
}

/// A corner; the first one determines the number of dimensions.
std::vector<double> read_corner(Item const* item, char const* key, Reading& reading) {
  if (!item) return {};
  bool const list = item->is(Item::Kind::array);
  if (!list || item->elements.empty() || item->elements.size() > 3) {
    reading.mistake(item->place,
                    fmt::format("{}: an array of 1, 2 or 3 lengths is needed, not {}{}", key, describe(*item),
                                list && !item->elements.empty() ? fmt::format(" of {}", item->elements.size()) : ""));
    return {};
  }
  if (reading.dimension == 0) reading.dimension = static_cast<int>(item->elements.size());
  return read_vector(*item, key, reading.dimension, dimensions::length, reading.context)
      .value_or(std::vector<double>{});
}

std::array<Boundary, 3> read_boundaries(Item const* item, Reading& reading) {
  std::array<Boundary, 3> boundaries{Boundary::open, Boundary::open, Boundary::open};
  auto const kind = [&](Item const& word) {
    return read_word(word, "boundary", boundary_words(), reading.context).value_or(Boundary::open);
  };
  if (!item) return boundaries;
  if (!item->is(Item::Kind::array))
    boundaries.fill(kind(*item));
  else if (reading.dimension > 0 && item->elements.size() != static_cast<std::size_t>(reading.dimension))
    reading.mistake(item->place, fmt::format("boundary: {} word{} for {} ax{}; give one for all, or one for each",
                                             item->elements.size(), item->elements.size() == 1 ? "" : "s",
                                             reading.dimension, reading.dimension == 1 ? "is" : "es"));
  else
    for (std::size_t a = 0; a < item->elements.size() && a < 3; ++a) boundaries[a] = kind(item->elements[a]);
  return boundaries;
}

void read_region(Item const& table, Reading& reading) {
  Section region(table, "[[box.regions]]", reading.context);
  std::size_t const before = reading.context.mistakes.count();
  RegionOptions options;
  read_options(region, region_options(), &options, {.dimension = reading.dimension});
  bool const right = reading.context.mistakes.count() == before;
  region.finish();
  if (right && options.low && options.high && reading.box)
    catch_errors(reading, region.place(), [&] { reading.box->install({*options.low, *options.high, options.side}); });
}

void read_shear(Section& box, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  BoxOptions options;
  read_options(box, box_options(), &options, {.dimension = reading.dimension});
  reading.shear_place = box.place("shear");
  if (options.shear && reading.context.mistakes.count() == before && reading.box)
    catch_errors(reading, reading.shear_place, [&] {
      auto const& read = *options.shear;
      reading.box->shear({read.rate, read.flow[0] - 'x', read.gradient[0] - 'x', read.established});
    });
  reading.shear_is_right = reading.context.mistakes.count() == before;
}

}  // namespace

void read_box(Section& document, Reading& reading) {
  Item const* table = find_table(document, "box");
  if (!document.has("box") && !document.other_capitals("box"))
    reading.mistake({}, "there is no [box]; add one with e.g. low = [0, 0] and high = [10, 10]");
  if (!table) return;
  Section section(*table, "[box]", reading.context);
  section.explain_said(box_options());
  std::size_t const before = reading.context.mistakes.count();
  Item const* low_item = section.need("low", "low = [0, 0]");
  Item const* high_item = section.need("high", "high = [10, 10]");
  auto const low = read_corner(low_item, "low", reading), high = read_corner(high_item, "high", reading);
  auto const boundaries = read_boundaries(section.find("boundary"), reading);
  if (low_item && high_item && low_item->is(Item::Kind::array) && high_item->is(Item::Kind::array) &&
      low_item->elements.size() != high_item->elements.size())
    reading.dimension = 0;  // it is unknown which of the two is right
  if (reading.context.mistakes.count() == before && reading.base_known && !low.empty() && !high.empty())
    catch_errors(reading, high_item->place,
                 [&] { reading.box.emplace(reading.dimension, wide(low), wide(high), boundaries); });
  read_shear(section, reading);
  for (Item const* region : find_tables(section, "regions")) read_region(*region, reading);
  for (Item const* wall : find_tables(section, "walls")) read_wall(*wall, reading);
  section.finish();
}

void read_run(Section& document, Reading& reading) {
  Item const* table = find_table(document, "run");
  if (!document.has("run") && !document.other_capitals("run"))
    reading.mistake({}, "there is no [run]; add one with e.g. step = 0.01 and steps = 1000");
  ReadRun& run = reading.run;
  run.cutoff_known = table && (!table->find("cutoff"));
  if (!table) return;
  Section section(*table, "[run]", reading.context);
  run.place = table->place;
  run.step_place = section.place("step");
  if (Item const* step = section.find("step")) read_step(*step, run, reading);
  std::size_t const before = reading.context.mistakes.count();
  read_options(section, run_options(), static_cast<RunOptions*>(&run), {.dimension = reading.dimension});
  bool const counted = section.has("steps");
  if (counted || section.has("time"))
    section.refuse(counted ? "time" : "steps", "'steps' also sets the length of the run; leave one out");
  else
    section.need("steps", "steps = 1000");
  run.cutoff_known = run.cutoff_known || run.cutoff;
  run.time_place = section.place("time");
  run.cutoff_place = section.place("cutoff");
  run.skin_place = section.place("skin");
  run.tolerance_place = section.place("tolerance");
  run.substeps_place = section.place("substeps");
  if (run.substeps && reading.context.mistakes.count() == before)
    catch_errors(reading, run.substeps_place, [&] { check(*run.substeps); });
  if (Item const* stop = section.find("stop")) run.stop = *stop;
  section.finish();
  if (run.cutoff && reading.box)
    for (int a = 0; a < reading.dimension; ++a)
      if (reading.box->periodic(a) && *run.cutoff > reading.box->length(a)) {
        refuse_cutoff(run.cutoff_place, *run.cutoff, a, reading);
        run.cutoff = reading.box->length(a);
      }
}

void refuse_cutoff(Place const& place, double cutoff, int axis, Reading& reading) {
  auto const& units = reading.context.units;
  reading.mistake(place, fmt::format("cutoff: {} is longer than the periodic axis {}, which allows at most {}",
                                     units.text(cutoff, dimensions::length, 6), "xyz"[axis],
                                     units.text(reading.box->length(axis), dimensions::length, 6)));
}

void settle_run(Item& resolved, Reading& reading) {
  ReadRun& run = reading.run;
  if (run.courant && !reading.smooth.wanted)
    reading.mistake(run.step_place,
                    "step: only smooth particles have a Courant step, and the scenario has no [smooth]; "
                    "give a time");
  if (!reading.context.mistakes.none() || (!run.step && !reading.result->scheme<SmoothScheme>())) return;
  if (run.courant) {
    double longest = 0;
    try {
      longest = reading.result->scheme<SmoothScheme>()->courant_step();
    } catch (std::runtime_error const& failure) {  // an error of the user's input or of the physics
      return reading.mistake(place_of(failure.what(), reading), failure.what());
    }
    if (!(longest > 0) || !std::isfinite(longest))
      return reading.mistake(
          run.step_place,
          fmt::format("step: the Courant step is {} for this state, which nothing moves; give a time", longest));
    run.step = *run.courant * longest;
  }
  Entry* table = resolved.find("run");
  if (!table || !run.step) return;
  auto const replace = [&](char const* old, char const* now, Item item) {
    item.place = table->item.find(old)->place;
    std::erase_if(table->item.entries, [&](Entry const& entry) { return entry.key == now && entry.key != old; });
    Entry& entry = *table->item.find(old);
    entry.key = now;
    entry.item = std::move(item);
  };
  if (run.courant) replace("step", "step", Item::of_number(*run.step));
  if (run.time) {
    // A time that equals a number of steps, up to rounding, gives this number.
    double const steps = std::ceil(*run.time / *run.step * (1 - 1e-12));
    if (steps > 9e18) return reading.mistake(run.time_place, fmt::format("time: it would need {:.3g} steps", steps));
    run.steps = static_cast<std::int64_t>(steps);
    replace("time", "steps", Item::of_integer(run.steps));
  } else {
    std::erase_if(table->item.entries, [](Entry const& entry) { return entry.key == "time"; });
  }
}

}  // namespace boltzmann
