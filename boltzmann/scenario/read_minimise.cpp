// Reads [minimise]: energy minimisation before the run.
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>

#include <algorithm>

namespace boltzmann {

void read_minimise(Section& document, Reading& reading) {
  Item const* table = find_table(document, "minimise");
  if (!table) return;
  std::size_t const before = reading.context.mistakes.count();
  Section section(*table, "[minimise]", reading.context);
  MinimiseOptions options;
  read_options(section, minimise_options(), &options, {.dimension = reading.dimension});
  section.finish();
  if (reading.context.mistakes.count() != before || !all_loaded(reading)) return;
  if (std::all_of(reading.ensembles.begin(), reading.ensembles.end(),
                  [](ReadEnsemble const& one) { return one.smooth(); }))
    return reading.mistake(table->place,
                           "[minimise]: there are only smooth particles, whose pressure does work on their heat: no "
                           "state has the least energy; let viscosity bring them to rest");
  reading.minimisation = options;
}

void add_minimisation(Reading const& reading) {
  if (reading.minimisation) reading.result->simulation->minimise_first(*reading.minimisation);
}

}  // namespace boltzmann
