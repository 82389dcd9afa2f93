// Reads [[events]]: what happens once at a time of the run.
#include <boltzmann/core/quantity_text.hpp>
#include <boltzmann/scenario/field_formulas.hpp>
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/scenario/tables.hpp>
#include <boltzmann/simulation/velocity_changes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <memory>

namespace boltzmann {
namespace {

/// How ensembles are advanced from a time on.
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

/// set = { "dissipation.0.temperature" = "100 K" }, with its paths in quotes or not.
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
    if (!all_loaded(reading) || !reading.context.mistakes.none()) continue;  // what is meant may not have been read
    std::vector<std::string> paths;
    for (auto const& one : reading.settable) paths.push_back(one.path);
    reading.mistake(entry.place, fmt::format("set: an event can't set '{}'; it can set {}{}", path,
                                             paths.empty() ? "nothing here" : join(paths), did_you_mean(path, paths)));
  }
}

/// Whose velocities an event changes.
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

/// `on` and `where`.
std::vector<Moved> read_moved(Section& section, Reading& reading) {
  Item const *on = section.find("on"), *where = section.find("where");
  std::vector<std::pair<ReadEnsemble const*, Place>> read;
  if (on) {
    std::vector<Item> const one{*on};
    if (read_texts(*on, "on", reading.context).empty()) return {};
    for (Item const& word : on->is(Item::Kind::array) ? on->elements : one)
      if (ReadEnsemble const* ensemble = reading.ensemble(word, "on")) read.emplace_back(ensemble, word.place);
  } else {
    for (auto const& ensemble : reading.ensembles)
      if (ensemble.particles && ensemble.particles->find_field("velocity"))
        read.emplace_back(&ensemble, ensemble.place);
  }
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

void read_event(Item const& table, Reading& reading) {
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
  auto const moved = read_moved(section, reading);
  for (char const* key : {"on", "where"})
    if (!moves && section.has(key))
      reading.mistake(section.place(key),
                      fmt::format("{}: it belongs to what changes velocities: temperature, scale or kick", key));
  if (!moves && !section.has("set") && reading.context.mistakes.count() == before)
    reading.mistake(table.place, "[[events]]: nothing happens; add 'set', 'temperature', 'scale' or 'kick'");
  section.finish();
  if (reading.context.mistakes.count() != before) return;
  if (!settings.empty())
    reading.events.push_back({options.at, true, [settings](Simulation& simulation) {
                                for (auto const& set : settings) set(simulation);
                              }});
  if (moves)
    reading.events.push_back({options.at, false, [=, k = reading.boltzmann_constant()](Simulation& simulation) {
                                auto const who = who_is_moved(moved, simulation.time());
                                if (options.temperature) scale_to_temperature(who, *options.temperature, k);
                                if (options.scale) scale_velocities(who, *options.scale);
                                if (options.kick) kick(who, *options.kick);
                              }});
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
  for (Item const* table : tables) read_event(*table, reading);
}

void add_events(Reading& reading) {
  Simulation& simulation = *reading.result->simulation;
  for (auto const& event : reading.events)
    simulation.happen(
        event.at, [&simulation, happen = event.happen] { happen(simulation); }, event.lasting);
}

}  // namespace boltzmann
