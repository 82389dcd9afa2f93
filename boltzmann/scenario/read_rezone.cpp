// Reads `rezone` of [smooth]: which smooth particles are split and merged while the simulation runs.
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/smooth/smooth_options.hpp>
#include <boltzmann/simulation/rezoner.hpp>

#include <fmt/format.h>

#include <algorithm>

namespace boltzmann {
namespace {

std::optional<Rezoning::Block> read_block(Section& section, Reading& reading) {
  Item const *low = section.find("low"), *high = section.find("high");
  if (!low && !high) return std::nullopt;
  if (!low || !high) {
    reading.mistake((low ? low : high)->place,
                    fmt::format("{}: a region needs both 'low' and 'high', the corners of a block; leave both out for "
                                "everywhere",
                                low ? "low" : "high"));
    return std::nullopt;
  }
  if (reading.dimension == 0) return std::nullopt;
  auto const from = read_vector(*low, "low", reading.dimension, dimensions::length, reading.context);
  auto const to = read_vector(*high, "high", reading.dimension, dimensions::length, reading.context);
  if (!from || !to) return std::nullopt;
  Rezoning::Block block{};
  std::copy(from->begin(), from->end(), block.low.begin());
  std::copy(to->begin(), to->end(), block.high.begin());
  for (int a = 0; a < reading.dimension; ++a)
    if (!(block.low[a] < block.high[a]))
      reading.mistake(high->place, fmt::format("high: on axis {} it is {}, not above low = {}", "xyz"[a], block.high[a],
                                               block.low[a]));
  return block;
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
  policy.region = read_block(section, reading);
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
    std::vector<ReadEnsemble*> on;
    if (rezone.on && rezone.on->is(Item::Kind::array))
      for (Item const& word : rezone.on->elements) on.push_back(reading.ensemble(word, "on"));
    else if (rezone.on)
      on.push_back(reading.ensemble(*rezone.on, "on"));
    else
      for (auto& ensemble : reading.ensembles)
        if (ensemble.smooth()) on.push_back(&ensemble);
    for (auto const* ensemble : on) {
      if (!ensemble || !ensemble->particles) continue;
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
