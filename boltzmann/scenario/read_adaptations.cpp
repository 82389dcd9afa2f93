// Reads [[remesh]] and [[split_cores]]: what changes vortices between steps.
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/simulation/remesher.hpp>
#include <boltzmann/simulation/split_cores.hpp>

#include <fmt/format.h>

#include <type_traits>
#include <utility>

namespace boltzmann {
namespace {

/// The ensembles that `on` names, or all that fit; those that can't be meant are mistakes.
template <class Fits>
std::vector<AnyEnsemble*> read_on(Section& section, std::string_view key, Fits const& fits, Reading& reading) {
  Item const* const on = section.find("on");
  std::vector<ReadEnsemble*> read;
  if (on && on->is(Item::Kind::array))
    for (Item const& word : on->elements) read.push_back(reading.ensemble(word, "on"));
  else if (on)
    read.push_back(reading.ensemble(*on, "on"));
  else
    for (auto& ensemble : reading.ensembles)
      if (ensemble.particles && fits(*ensemble.particles)) read.push_back(&ensemble);
  Place const& place = on ? on->place : section.place();
  if (!on && read.empty() && all_loaded(reading))
    reading.mistake(place, fmt::format("{}: there is no ensemble whose vortices could be meant", key));
  std::vector<AnyEnsemble*> ensembles;
  for (auto const* ensemble : read) {
    if (!ensemble || !ensemble->particles) continue;
    if (ensemble->integrator && !ensemble->integrator->same_for_all())
      reading.mistake(place,
                      fmt::format("{}: some particles of '{}' are frozen, by their numbers, which it changes; name "
                                  "other ensembles with 'on', or make an ensemble of those",
                                  key, ensemble->name));
    ensembles.push_back(ensemble->particles);
  }
  return ensembles;
}

/// One table: its options, and one Adapter of each ensemble.
template <class Adapter, class Options, class Fits>
void read_one(Item const& table, std::string const& key, OptionTable const& known, Fits const& fits, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, key, reading.context);
  Options options;
  read_options(section, known, &options, {.dimension = reading.dimension});
  auto const ensembles = read_on(section, key, fits, reading);
  section.finish();
  if constexpr (std::is_same_v<Options, RemeshOptions>)
    if (auto const* bodies = reading.result->scheme<PanelScheme>())
      options.how.allowed = [bodies, depth = 2.01 * options.how.spacing](std::array<double, 3> const& place) {
        return !bodies->sheet().deep_inside({place[0], place[1]}, depth);
      };
  if (reading.context.mistakes.count() != before || !reading.box) return;
  for (auto* ensemble : ensembles)
    catch_errors(reading, table.place, [&] {
      auto adapter = std::make_shared<Adapter>(*ensemble, reading.result->box(), options.how);
      reading.adaptations.push_back([adapter, every = static_cast<std::uint64_t>(options.every)](
                                        Simulation& simulation) { simulation.adapt(every, *adapter); });
    });
}

/// All tables of a key, [key] or [[key]].
template <class F>
void each_table(Section& document, std::string_view key, F const& f) {
  Item const* const item = document.find(key);
  if (item && item->is(Item::Kind::table)) return f(*item);
  for (Item const* table : find_tables(document, key)) f(*table);
}

}  // namespace

void read_adaptations(Section& document, Reading& reading) {
  each_table(document, "remesh", [&](Item const& table) {
    read_one<Remesher, RemeshOptions>(
        table, "remesh", remesh_options(), [](AnyEnsemble const& of) { return of.find_field("vorticity") != nullptr; },
        reading);
  });
  each_table(document, "split_cores", [&](Item const& table) {
    read_one<CoreSplitter, CoreSplittingOptions>(
        table, "split_cores", core_splitting_options(),
        [](AnyEnsemble const& of) { return of.class_name() == "Spreading"; }, reading);
  });
}

}  // namespace boltzmann
