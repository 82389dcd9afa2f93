// Reads [[events]]: changes at a time of the run.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/core/team.hpp>
#include <boltzmann/loaders/append.hpp>
#include <boltzmann/recording/progress.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/loader.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/tables.hpp>
#include <boltzmann/schemes/mesh/p3m_scheme.hpp>
#include <boltzmann/simulation/velocity_changes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <memory>

namespace boltzmann {
namespace {

/// Integrators of ensembles from a time on.
void add_integrators(Reading& reading) {
  for (auto const& ensemble : reading.ensembles) {
    if (!ensemble.particles || !ensemble.kind) continue;
    AnyEnsemble* const particles = ensemble.particles;
    ClassVariant const* variant = nullptr;
    for (auto const& one : ensemble.kind->variants)
      if (one.dimension == particles->dimension()) variant = &one;
    if (!variant) continue;
    std::string const path = fmt::format("ensembles.{}.integrator", ensemble.name);
    auto const integrate = variant->integrate;
    bool const frozen = ensemble.integrator && !ensemble.integrator->same_for_all();
    reading.settable.push_back(
        {path, [=](Item const& item, Reading& of) -> std::function<void(Simulation&)> {
           auto const method = read_word(item, path, method_words(), of.context);
           if (!method) return nullptr;
           auto const refuse = [&](char const* why) {
             of.mistake(item.place, fmt::format("{}: {}", path, why));
             return nullptr;
           };
           if (frozen) return refuse("some particles are frozen, which is the integrator's");
           bool const dissipates =
               std::any_of(of.result->dissipations.begin(), of.result->dissipations.end(), [&](auto const& d) {
                 auto const all = d->ensembles();
                 return std::find(all.begin(), all.end(), particles) != all.end();
               });
           if (dissipates && *method != Method::leap_frog)
             return refuse("friction and noise act on it, which needs leap-frog");
           if (!catch_errors(of, item.place, [&] { integrate(*particles, *method); })) return nullptr;
           return [=](Simulation& simulation) { simulation.integrate(*particles, integrate(*particles, *method)); };
         }});
  }
}

/// set = { "dissipation.0.temperature" = "100 K" }, with paths quoted or not.
void read_settings(Item const& table, std::string const& before, Reading& reading,
                   std::vector<std::function<void(Simulation&)>>& settings) {
  for (auto const& entry : table.entries) {
    std::string const path = before + entry.key;
    auto const found = std::find_if(reading.settable.begin(), reading.settable.end(),
                                    [&](Settable const& one) { return one.path == path; });
    if (found != reading.settable.end()) {
      if (auto setting = found->read(entry.item, reading)) settings.push_back(std::move(setting));
      continue;
    }
    if (entry.item.is(Item::Kind::table)) {
      read_settings(entry.item, path + ".", reading, settings);
      continue;
    }
    if (!all_loaded(reading) || !reading.context.mistakes.none()) continue;  // the target may not have been read
    std::vector<std::string> paths;
    for (auto const& one : reading.settable) paths.push_back(one.path);
    reading.mistake(entry.place,
                    fmt::format("set: an event can't set '{}'{}", path, choices(path, paths, "it can set")));
  }
}

/// The particles whose velocities an event changes.
struct Moved {
  AnyEnsemble* ensemble;
  std::shared_ptr<ParticleFormula> where;  // null: all
};

std::vector<ChosenParticles> who_is_moved(std::vector<Moved> const& moved, double time) {
  std::vector<ChosenParticles> all;
  for (auto const& [ensemble, where] : moved) {
    ChosenParticles one{ensemble, {}};
    for (std::uint32_t i = 0; i < ensemble->size(); ++i)
      if (!where || (*where)(ensemble->row(i), time) != 0) one.which.push_back(i);
    all.push_back(std::move(one));
  }
  return all;
}

bool is_nobody(std::vector<ChosenParticles> const& who) {
  return std::all_of(who.begin(), who.end(), [](ChosenParticles const& one) { return one.which.empty(); });
}

/// Warns of an event that affects no particle.
void warn_of_nobody(std::string const& where, std::string const& time) {
  if (team().first())
    fmt::print(stderr, "{}warning: event at {}: where '{}' is true for no particle\n",
               rewrites_lines() ? "\r\033[K" : "", time, where);
}

/// `on` and `where`.
std::vector<Moved> read_moved(Section& section, Reading& reading) {
  Item const *on = section.find("on"), *where = section.find("where");
  auto read = named_ensembles(on, "on", reading);
  for (auto& ensemble : reading.ensembles)
    if (!on && ensemble.particles && ensemble.particles->find_field("velocity"))
      read.push_back({&ensemble, ensemble.place});
  std::vector<Moved> moved;
  for (auto const& [ensemble, place] : read) {
    if (!ensemble->particles) continue;
    if (!ensemble->particles->find_field("velocity")) {
      reading.mistake(place, fmt::format("on: particles of class {} ('{}') have no velocity", ensemble->kind->name,
                                         ensemble->name));
      continue;
    }
    Moved one{ensemble->particles, nullptr};
    if (where) {
      auto names = formula_names(one.ensemble->fields(), reading.dimension, reading);
      names.add_time();
      auto formula = read_formula(*where, "where", names, {}, reading);
      if (!formula) break;
      if (!formula->formula().is_condition()) {
        reading.mistake(where->place, "where: a condition is needed, which is true or false, e.g. \"x < 5\"");
        break;
      }
      one.where = std::make_shared<ParticleFormula>(std::move(*formula));
    }
    moved.push_back(std::move(one));
  }
  return moved;
}

struct Addition {
  AnyEnsemble* to;
  std::vector<std::shared_ptr<AnyEnsemble const>> particles;  // for each time
  ClassVariant const* variant;
  PlaceAgain again = {};
};

/// Places them at this distance from all existing particles.
void append_apart(Addition const& added, AnyEnsemble const& more, double distance, Simulation const& simulation) {
  auto const particles = added.variant->make(more.name(), more.size());
  for (std::size_t i = 0; i < more.size(); ++i) std::copy_n(more.row(i), more.doubles(), particles->row(i));
  std::vector<AnyEnsemble const*> const others(simulation.ensembles().begin(), simulation.ensembles().end());
  added.again(*particles, simulation.schemes().front()->box(), others, distance);
  append(*added.to, *particles);
}

/// `add` of event `number`.
std::optional<Addition> read_added(Item const& add, Section& section, std::size_t number, std::int64_t times,
                                   Reading& reading) {
  Item const* on = section.need("on", "on = \"atoms\"");
  ReadEnsemble const* const to = on ? reading.ensemble(*on, "on") : nullptr;
  auto const refuse = [&](Place const& place, std::string const& why) {
    reading.mistake(place, "add: " + why);
    return std::nullopt;
  };
  if (!add.is(Item::Kind::table))
    return refuse(add.place, fmt::format("a table is needed, {{ load = {{ ... }} }}, not {}", describe(add)));
  if (!to || !to->particles) return std::nullopt;
  if (!to->table) return refuse(on->place, fmt::format("'{}' is the outline of a body", to->name));
  bool const rigid = std::any_of(reading.rigid.begin(), reading.rigid.end(),
                                 [&](auto const& bonds) { return &bonds->ensemble() == to->particles; });
  if (rigid || !to->molecules.bonds.empty())
    return refuse(on->place, fmt::format("particles of '{}' are joined by bonds, and what is added has none; make an "
                                         "ensemble of those",
                                         to->name));
  bool const nobody = std::all_of(reading.ensembles.begin(), reading.ensembles.end(),
                                  [](ReadEnsemble const& one) { return !one.particles || one.particles->size() == 0; });
  if (nobody && std::any_of(reading.result->schemes.begin(), reading.result->schemes.end(),
                            [](auto const& one) { return dynamic_cast<P3MScheme const*>(one.get()) != nullptr; }))
    return refuse(on->place,
                  "no particles exist at the start for which the accuracy of [mesh] could choose it; set cells and "
                  "assignment instead");
  Addition all{to->particles, {}, to->kind->in(reading.dimension)};
  for (std::int64_t k = 0; k < times; ++k) {
    auto particles =
        read_addition(add, *to, fmt::format("{}, event {}, time {}", to->name, number, k), reading, all.again);
    if (!particles) return std::nullopt;
    double const more = static_cast<double>(particles->size()) * static_cast<double>(times);
    if (!fits_memory(more + static_cast<double>(to->particles->size()), *to->kind->in(reading.dimension), add.place,
                     reading))
      return std::nullopt;
    all.particles.push_back(std::move(particles));
  }
  return all;
}

/// Adds the particles of one time.
std::function<void(Simulation&)> adding_event(Addition const& added, std::size_t time, double distance) {
  return [added, more = added.particles[time], distance](Simulation& simulation) {
    if (distance > 0)
      append_apart(added, *more, distance, simulation);
    else
      append(*added.to, *more);
  };
}

/// Checks that a distance from others is possible.
void check_distance(Section& section, Item const* add, Addition const* added, Reading& reading) {
  if (!add) section.mistake("keep_distance", "it belongs to 'add'; leave it out");
  if (!add || !added) return;
  if (!added->again)
    section.mistake("keep_distance", "it is of particles at random: add = { load = { kind = \"random\" } }");
  if (add->is(Item::Kind::table) && add->find("formulas"))
    section.mistake("keep_distance", "formulas are of the places that were drawn first; leave one of both out");
  if (reading.box && reading.box->sheared())
    section.mistake("keep_distance", "in a sheared box no distance to other particles can be kept; leave it out");
}

/// The text of `where`; empty if there is none.
std::string condition_of(Section const& section) {
  Item const* where = section.item("where");
  return where && where->is(Item::Kind::text) ? where->text : "";
}

/// Adds a note if the condition is true for no particle in the initial state.
void note_nobody(std::vector<Moved> const& moved, double time, std::string const& condition, Place const& place,
                 Reading& reading) {
  if (condition.empty() || !is_nobody(who_is_moved(moved, time))) return;
  reading.note(
      fmt::format("note: where: '{}' is true for no particle at the start (event in line {})", condition, place.line));
}

/// Applies temperature, scale and kick to the particles for which the condition is true at that time.
std::function<void(Simulation&)> velocity_change(std::vector<Moved> const& moved, EventOptions const& options,
                                                 std::string const& condition, Reading const& reading) {
  return [=, k = reading.boltzmann_constant(), units = reading.context.units](Simulation& simulation) {
    auto const who = who_is_moved(moved, simulation.time());
    if (!condition.empty() && is_nobody(who))
      warn_of_nobody(condition, units.text(simulation.time(), dimensions::time));
    if (options.temperature)
      scale_to_temperature(who, *options.temperature, k,
                           options.subtract_drift ? std::array{true, true, true} : simulation.momentum_is_kept());
    if (options.scale) scale_velocities(who, *options.scale);
    if (options.kick) kick(who, *options.kick);
  };
}

/// Checks keys that belong to changes of velocities.
void check_what_moves(Section& section, EventOptions const& options, bool adds, Reading& reading) {
  bool const moves = options.temperature || options.scale || options.kick;
  for (char const* key : {"on", "where"})
    if (!moves && section.has(key) && !(adds && std::string_view(key) == "on"))
      reading.mistake(section.place(key),
                      fmt::format("{}: it belongs to what changes velocities: temperature, scale or kick", key));
  if (!options.temperature) section.refuse("subtract_drift", "it belongs to 'temperature', which is missing");
}

void read_event(Item const& table, std::size_t number, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[[events]]", reading.context);
  EventOptions options;
  read_options(section, event_options(), &options, {.dimension = reading.dimension});
  std::vector<std::function<void(Simulation&)>> settings;
  if (Item const* set = section.find("set")) {
    if (set->is(Item::Kind::table))
      read_settings(*set, "", reading, settings);
    else
      reading.mistake(set->place, fmt::format("set: a table of paths and values is needed, {{ "
                                              "\"dissipation.0.temperature\" = 1 }}, not {}",
                                              describe(*set)));
  }
  bool const moves = options.temperature || options.scale || options.kick;
  if (options.every ? !section.has("times") : section.has("times"))
    reading.mistake(section.place(options.every ? "every" : "times"),
                    "every and times: what happens again needs both, the time between and how often");
  Item const* const add = section.find("add");
  for (char const* key : {"on", "where"}) section.allow(key);
  if (add && moves)
    reading.mistake(add->place,
                    "add: an event adds particles or changes velocities; two events at one time do both, in the order "
                    "of the file");
  std::optional<Addition> const added =
      add && !moves ? read_added(*add, section, number, options.times, reading) : std::nullopt;
  if (section.has("keep_distance")) check_distance(section, add, added ? &*added : nullptr, reading);
  auto const moved = add ? std::vector<Moved>{} : read_moved(section, reading);
  check_what_moves(section, options, add != nullptr, reading);
  if (!moves && !add && !section.has("set") && reading.context.mistakes.count() == before)
    reading.mistake(table.place, "[[events]]: nothing happens; add 'set', 'add', 'temperature', 'scale' or 'kick'");
  section.finish();
  if (reading.context.mistakes.count() != before) return;
  if (moves) note_nobody(moved, options.at, condition_of(section), section.place("where"), reading);
  using enum ReadEvent::Kind;
  for (std::int64_t time = 0; time < options.times; ++time) {
    double const at = options.at + static_cast<double>(time) * options.every.value_or(0);
    if (!settings.empty())
      reading.events.push_back({at, lasting, [settings](Simulation& simulation) {
                                  for (auto const& set : settings) set(simulation);
                                }});
    if (added)
      reading.events.push_back(
          {at, adding, adding_event(*added, static_cast<std::size_t>(time), options.keep_distance)});
    if (moves) reading.events.push_back({at, passing, velocity_change(moved, options, condition_of(section), reading)});
  }
}

}  // namespace

Settable settable_number(std::string path, Dimension dimension, NumberRange range,
                         std::function<void(Simulation&, double)> set) {
  return {path, [=](Item const& item, Reading& reading) -> std::function<void(Simulation&)> {
            auto const value = read_quantity(item, path, dimension, reading.context, range);
            if (!value) return nullptr;
            return [set, number = *value](Simulation& simulation) { set(simulation, number); };
          }};
}

void read_events(Section& document, Reading& reading) {
  auto const tables = find_tables(document, "events");
  if (tables.empty()) return;
  add_integrators(reading);
  for (std::size_t n = 0; n < tables.size(); ++n) read_event(*tables[n], n, reading);
}

void add_events(Reading& reading) {
  Simulation& simulation = *reading.result->simulation;
  for (auto const& event : reading.events) {
    auto const happen = [&simulation, happen = event.happen] { happen(simulation); };
    if (event.kind == ReadEvent::Kind::adding)
      simulation.add_particles(event.at, happen);
    else
      simulation.happen(event.at, happen, event.kind == ReadEvent::Kind::lasting);
  }
}

}  // namespace boltzmann
