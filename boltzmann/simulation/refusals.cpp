// One measurement for all that ask.
#include <boltzmann/simulation/refusals.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <optional>

namespace boltzmann {

std::vector<std::string> refusals(Simulation& simulation, std::span<std::unique_ptr<Diagnosis> const> diagnoses) {
  std::vector<std::string> lines(diagnoses.size());
  std::optional<EnergyAndVirial> measures;
  for (std::size_t d = 0; d < diagnoses.size(); ++d) {
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
