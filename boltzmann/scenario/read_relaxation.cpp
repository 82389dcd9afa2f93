// Reads [relaxation]: vorticity that relaxes towards the curl of the flow.
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>

namespace boltzmann {

void read_relaxation(Section& document, Reading& reading) {
  Item const* table = find_table(document, "relaxation");
  if (!table) return;
  std::size_t const before = reading.context.mistakes.count();
  Section section(*table, "[relaxation]", reading.context);
  RelaxationOptions options;
  read_options(section, relaxation_options(), &options, {.dimension = reading.dimension});
  section.finish();
  if (reading.context.mistakes.count() == before) reading.relaxation = {options, table->place};
}

void add_relaxation(Reading& reading) {
  if (!reading.relaxation.options) return;
  catch_errors(reading, reading.relaxation.place, [&] {
    Simulation& simulation = *reading.result->simulation;
    auto const& [every, relaxing] = *reading.relaxation.options;
    simulation.adapt(static_cast<std::uint64_t>(every), VortexRelaxation(simulation.schemes(), relaxing));
  });
}

}  // namespace boltzmann
