// One row of the energy balance.
#include <boltzmann/diagnoses/energy_balance.hpp>
#include <boltzmann/diagnoses/measures.hpp>

#include <limits>

namespace boltzmann {

std::vector<Column> EnergyBalance::columns() const {
  return {{"energy", dimensions::energy},
          {"work of walls", dimensions::energy},
          {"heat of baths", dimensions::energy},
          {"energy balance", dimensions::energy}};
}

void EnergyBalance::measure(Sample const& sample, std::vector<double>& values) {
  constexpr double nan = std::numeric_limits<double>::quiet_NaN();
  if (sample.measures == nullptr) {
    values.insert(values.end(), {nan, nan, nan, nan});
    return;
  }
  EnergyAndVirial const& m = *sample.measures;
  double const energy = m.unknown.empty()
                            ? kinetic_energy(sample.ensembles, sample.threads) + m.potential + m.external + m.internal
                            : nan;
  values.insert(values.end(), {energy, m.work, m.heat, energy - m.work - m.heat});
}

}  // namespace boltzmann
