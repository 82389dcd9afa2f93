// Reads [cylinder_flow]: the flow of a stream and vortices past a circle.
#include <boltzmann/scenario/read_options.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/schemes/cylinder/cylinder_flow.hpp>
#include <boltzmann/schemes/flow_classes.hpp>
#include <boltzmann/schemes/panels/panel_scheme.hpp>

#include <fmt/format.h>

#include <memory>

namespace boltzmann {
void read_cylinder(Item const& table, Reading& reading) {
  std::size_t const before = reading.context.mistakes.count();
  Section section(table, "[cylinder_flow]", reading.context);
  CylinderOptions options;
  read_options(section, cylinder_options(), &options, {.dimension = reading.dimension});
  section.finish();
  if (!reading.box || reading.context.mistakes.count() != before) return;
  catch_errors(reading, table.place,
               [&] { reading.result->schemes.push_back(std::make_unique<CylinderFlow>(*reading.box, options)); });
}

void add_to_cylinder(Item const& table, Reading& reading) {
  auto* const scheme = reading.result->scheme<CylinderFlow>();
  if (!scheme) return;
  if (reading.bodies)
    return reading.mistake(table.place,
                           "[cylinder_flow]: there are bodies, whose vortex sheets would need images in the cylinder; "
                           "make the cylinder one of the [[bodies]]");
  bool anybody = false;
  for (auto& ensemble : reading.ensembles) {
    if (!ensemble.particles || !ensemble.kind) return;
    SourceKind const kind = ensemble.kind->in(reading.dimension)->source;
    if (!kind.carried) continue;
    anybody = true;
    catch_errors(reading, ensemble.place, [&] { scheme->add(*ensemble.particles, kind); });
  }
  if (!anybody && !reading.ensembles.empty())
    reading.mistake(table.place, fmt::format("[cylinder_flow]: no ensemble is carried by a flow; classes {} are",
                                             classes_carried_by_flows));
}

}  // namespace boltzmann
