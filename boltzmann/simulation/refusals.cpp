// One measurement for all diagnoses.
#include <boltzmann/simulation/refusals.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <fmt/format.h>

#include <optional>

namespace boltzmann {

std::vector<std::string> refusals(Simulation& simulation, std::span<std::unique_ptr<Diagnosis> const> diagnoses) {
  std::vector<std::string> lines(diagnoses.size());
  std::optional<EnergyAndVirial> measures;
  for (std::size_t d = 0; d < diagnoses.size(); ++d) {
    if (diagnoses[d]->by_number() && simulation.numbers_change()) {
      lines[d] = fmt::format(
          "the diagnosis of '{}' follows particles by their numbers, which change where particles come and go between "
          "steps",
          diagnoses[d]->columns().front().name);
      continue;
    }
    if (!diagnoses[d]->needs_energies() && !diagnoses[d]->needs_virial()) continue;
    if (!measures) {
      simulation.check();
      measures = simulation.measure();
    }
    lines[d] = refusal(*diagnoses[d], *measures);
  }
  return lines;
}

}  // namespace boltzmann
