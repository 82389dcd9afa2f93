// Reads `rezone` of [smooth]: splitting and merging of smooth particles during the run.
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/smooth/smooth_options.hpp>
#include <boltzmann/simulation/rezoner.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

std::optional<Rezoning::Block> block_of(RezoneOptions const& options, Section& section, int dimension) {
  auto const &low = options.low, &high = options.high;
  if (section.has("low") != section.has("high")) {
    char const* const key = section.has("low") ? "low" : "high";
    section.mistake(key, "a region needs both 'low' and 'high', the corners of a block; leave both out for everywhere");
  }
  if (!low || !high) return std::nullopt;
  for (std::size_t a = 0; a < static_cast<std::size_t>(dimension); ++a)
    if (!((*low)[a] < (*high)[a]))
      section.mistake("high", fmt::format("on axis {} it is {}, not above low = {}", "xyz"[a], (*high)[a], (*low)[a]));
  return Rezoning::Block{*low, *high};
}

void read_one(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "rezone", reading.context);
  ReadRezone rezone;
  rezone.place = table.place;
  rezone.on = section.find("on");  // read when the ensembles are there
  RezoneOptions options;
  read_options(section, rezone_options(), &options,
               {.dimension = reading.dimension, .shown = [&]() -> std::optional<Dimension> {
                  if (reading.dimension == 0) return std::nullopt;
                  Dimension const volume = pow(dimensions::length, reading.dimension);
                  return options.policy.by == Rezoning::By::density ? dimensions::mass / volume : volume;
                }});
  rezone.every = options.every;
  Rezoning& policy = rezone.policy;
  policy = options.policy;
  if (!section.has("split_above") && !section.has("merge_below"))
    reading.mistake(table.place,
                    "rezone needs 'split_above' or 'merge_below', or both; add e.g. split_above = 2, smallest_mass = "
                    "0.5");
  policy.region = block_of(options, section, reading.dimension);
  section.finish();
  if (reading.context.mistakes.count() == before) catch_errors(reading, table.place, [&] { policy.check(); });
  reading.smooth.rezones.push_back(std::move(rezone));
}

}  // namespace

void read_rezone(Section& smooth, Reading& reading) {
  Item const* item = smooth.find("rezone");
  if (!item) return;
  std::vector<Item const*> tables;
  if (item->is(Item::Kind::array))
    for (Item const& element : item->elements) tables.push_back(&element);
  else
    tables.push_back(item);
  for (Item const* table : tables) {
    if (table->is(Item::Kind::table))
      read_one(*table, reading);
    else
      reading.mistake(table->place,
                      fmt::format("rezone: a table is needed, rezone = {{ every = 20, split_above = 2, smallest_mass = "
                                  "0.5 }}, not {}",
                                  describe(*table)));
  }
}

void load_rezone(Reading& reading) {
  for (auto& rezone : reading.smooth.rezones) {
    auto on = named_ensembles(rezone.on, "on", reading);
    for (auto& ensemble : reading.ensembles)
      if (!rezone.on && ensemble.smooth()) on.push_back({&ensemble, ensemble.place});
    for (auto const& one : on) {
      ReadEnsemble const* const ensemble = one.ensemble;
      if (!ensemble->particles) continue;
      if (!ensemble->smooth())
        reading.mistake(rezone.on->place, fmt::format("rezone: '{}' is of class {}; smooth particles are rezoned",
                                                      ensemble->name, ensemble->kind->name));
      if (ensemble->integrator && !ensemble->integrator->same_for_all())
        reading.mistake(rezone.on ? rezone.on->place : rezone.place,
                        fmt::format("rezone: some particles of '{}' are frozen, by their numbers, which rezoning "
                                    "changes; name other ensembles with 'on', or make an ensemble of those",
                                    ensemble->name));
      rezone.ensembles.push_back(ensemble->particles);
    }
  }
}

void add_rezoners(Reading const& reading) {
  ScenarioSimulation& result = *reading.result;
  for (auto const& rezone : reading.smooth.rezones)
    for (auto* ensemble : rezone.ensembles)
      result.simulation->adapt(static_cast<std::uint64_t>(rezone.every),
                               Rezoner(*ensemble, result.box(), rezone.policy));
}

}  // namespace boltzmann
