// Reads [[remesh]], [[split_cores]] and [[outflow]]: changes of vortices between steps.
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/simulation/outflow.hpp>
#include <boltzmann/simulation/remesher.hpp>
#include <boltzmann/simulation/split_cores.hpp>

#include <fmt/format.h>

#include <type_traits>
#include <utility>

namespace boltzmann {
namespace {

/// The ensembles that `on` names, or all that fit; adds mistakes for unsuitable ones.
template <class Fits>
std::vector<AnyEnsemble*> read_on(Section& section, std::string_view key, Fits const& fits, Reading& reading) {
  Item const* const on = section.find("on");
  auto read = named_ensembles(on, "on", reading);
  for (auto& ensemble : reading.ensembles)
    if (!on && ensemble.particles && fits(*ensemble.particles)) read.push_back({&ensemble, ensemble.place});
  Place const& place = on ? on->place : section.place();
  if (!on && read.empty() && all_loaded(reading))
    reading.mistake(place, fmt::format("{}: there is no ensemble whose vortices could be meant", key));
  std::vector<AnyEnsemble*> ensembles;
  for (auto const& one : read) {
    ReadEnsemble const* const ensemble = one.ensemble;
    if (!ensemble->particles) continue;
    if (ensemble->integrator && !ensemble->integrator->same_for_all())
      reading.mistake(place,
                      fmt::format("{}: some particles of '{}' are frozen, by their numbers, which it changes; name "
                                  "other ensembles with 'on', or make an ensemble of those",
                                  key, ensemble->name));
    ensembles.push_back(ensemble->particles);
  }
  return ensembles;
}

/// Reads the options that are not plain keys; returns false after a mistake.
bool complete(RemeshOptions& options, Item const& /*table*/, Reading& reading) {
  if (auto const* bodies = reading.result->scheme<PanelScheme>())
    options.how.allowed = [bodies, depth = 2.01 * options.how.spacing](std::array<double, 3> const& place) {
      return !bodies->sheet().deep_inside({place[0], place[1]}, depth);
    };
  return true;
}
bool complete(CoreSplittingOptions& /*options*/, Item const& /*table*/, Reading& /*reading*/) { return true; }
bool complete(OutflowOptions& options, Item const& table, Reading& reading) {
  auto const* bodies = reading.result->scheme<PanelScheme>();
  OutflowPlane const& plane = options.how;
  if (!bodies || !plane.from || !plane.direction) return true;
  for (auto const* body : bodies->bodies())
    for (std::size_t i = 0; i < body->size(); ++i)
      if (plane.beyond(body->row(i), 2)) {
        reading.mistake(table.place, fmt::format("outflow: the body '{}' is beyond the plane, where particles are "
                                                 "removed; move the plane downstream of all bodies",
                                                 body->name()));
        return false;
      }
  return true;
}

/// Reads the destination of removed particles; particles that are already there stay.
void read_into(Section& section, OutflowOptions& options, std::vector<AnyEnsemble*>& ensembles, Reading& reading) {
  Item const* const into = section.find("into");
  if (!into) return;
  ReadEnsemble* const found = reading.ensemble(*into, "into");
  if (!found || !found->particles) return;
  if (found->integrator && !found->integrator->same_for_all())
    reading.mistake(into->place,
                    fmt::format("outflow: some particles of '{}' are frozen, by their numbers, and more are "
                                "added; make an ensemble of those",
                                found->name));
  options.into = found->particles;
  if (!section.has("on"))
    std::erase_if(ensembles, [&](AnyEnsemble* one) { return one == options.into || !one->find_field("vorticity"); });
}

template <class Adapter, class Options>
std::shared_ptr<Adapter> adapter_of(AnyEnsemble& ensemble, Options const& options, Reading& reading) {
  if constexpr (std::is_same_v<Adapter, Outflow>)
    return std::make_shared<Outflow>(ensemble, reading.result->box(), options.how,
                                     OutflowInto{options.into, reading.result->scheme<PanelScheme>()});
  else
    return std::make_shared<Adapter>(ensemble, reading.result->box(), options.how);
}

/// Reads one table: its options, and one Adapter per ensemble.
template <class Adapter, class Options, class Fits>
void read_one(Item const& table, std::string const& key, OptionTable const& known, Fits const& fits, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, key, reading.context);
  Options options;
  read_options(section, known, &options, {.dimension = reading.dimension});
  auto ensembles = read_on(section, key, fits, reading);
  if constexpr (std::is_same_v<Options, OutflowOptions>) read_into(section, options, ensembles, reading);
  section.finish();
  if (reading.context.mistakes.count() != before || !reading.box) return;
  if (!complete(options, table, reading)) return;
  for (auto* ensemble : ensembles)
    catch_errors(reading, table.place, [&] {
      auto adapter = adapter_of<Adapter>(*ensemble, options, reading);
      reading.adaptations.push_back([adapter, every = static_cast<std::uint64_t>(options.every)](
                                        Simulation& simulation) { simulation.adapt(every, *adapter); });
    });
}

}  // namespace

void read_adaptations(Section& document, Reading& reading) {
  for (Item const* table : find_tables(document, "remesh", true))
    read_one<Remesher, RemeshOptions>(
        *table, "remesh", remesh_options(), [](AnyEnsemble const& of) { return of.find_field("vorticity") != nullptr; },
        reading);
  for (Item const* table : find_tables(document, "split_cores", true))
    read_one<CoreSplitter, CoreSplittingOptions>(
        *table, "split_cores", core_splitting_options(),
        [](AnyEnsemble const& of) { return of.class_name() == "Spreading"; }, reading);
  for (Item const* table : find_tables(document, "outflow", true))
    read_one<Outflow, OutflowOptions>(
        *table, "outflow", outflow_options(),
        [](AnyEnsemble const& of) {
          return of.class_name() != "Panel" && !of.find_field("velocity") && !of.find_field("mass") &&
                 of.influence_size() > 0;
        },
        reading);
}

}  // namespace boltzmann
