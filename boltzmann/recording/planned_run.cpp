// Whether a run is long enough for what is measured in it.
#include <boltzmann/recording/planned_run.hpp>

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/multipole/multipole_scheme.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {

namespace {

/// Gas that its own gravity pulls together while steps stay as they are.
std::vector<std::string> collapse_warnings(Simulation const& simulation) {
  constexpr double held = 0.2;  // of |gravity|, the energies below which it falls together; 0.5 would hold it
  constexpr double step_of_collapse =
      0.05;  // of the Courant step of the start, for a collapse to a tenth of the radius
  double longest = std::numeric_limits<double>::infinity();
  bool far = false;
  for (auto* scheme : simulation.schemes()) {
    if (std::isfinite(scheme->sound_step())) longest = std::min(longest, scheme->longest_step());
    far = far || dynamic_cast<MeshScheme const*>(scheme) || dynamic_cast<MultipoleScheme const*>(scheme);
  }
  if (!far || simulation.divides_steps() || !(std::abs(simulation.step_size()) > step_of_collapse * longest)) return {};
  auto const measures = simulation.measure();
  double const kinetic = kinetic_energy(simulation.ensembles());
  if (!measures.unknown.empty() || measures.potential >= 0 || measures.external != 0) return {};
  double const part = (kinetic + measures.internal) / -measures.potential;
  if (part > held) return {};
  return {
      fmt::format("warning: kinetic and internal energy are {:.2g} of the energy of gravity: the gas will fall "
                  "together, and sound in "
                  "it needs shorter steps then; write substeps = {{ courant = 0.4 }} in [run] (divide_steps() in C++)",
                  part)};
}

}  // namespace

std::vector<std::string> planned_warnings(Recording const& recording, std::int64_t steps) {
  Simulation const& simulation = recording.simulation();
  PlannedRun const run{simulation.time(), simulation.step_size(), steps, recording.diagnoses_every()};
  std::vector<std::string> lines;
  if (steps <= 0) return lines;
  lines = collapse_warnings(simulation);
  auto const told = [&](double number) { return recording.units().text(number, dimensions::time, 3); };
  for (auto const* diagnosis : recording.instruments()) {
    if (diagnosis->since() > run.end() && run.step_size > 0) {
      auto const columns = diagnosis->columns();
      auto const tables = diagnosis->tables();
      lines.push_back(fmt::format(
          "warning: '{}' is measured from the time {} on, and the run ends at {}: nothing is measured; run longer, or "
          "take an earlier 'since'",
          !columns.empty()  ? columns.front().name
          : !tables.empty() ? tables.front().name
                            : "a diagnosis",
          told(diagnosis->since()), told(run.end())));
      continue;
    }
    for (auto const& line : diagnosis->warnings(run, recording.units())) lines.push_back(line);
  }
  return lines;
}

}  // namespace boltzmann
