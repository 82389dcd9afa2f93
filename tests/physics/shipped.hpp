// Shipped scenarios in tests: loaded as a user runs them.
#pragma once

#include <boltzmann/scenario/scenario.hpp>

#include <tests/nudge.hpp>

#include <stdexcept>

namespace boltzmann {

/// With the seed of the scenario; with another one and other roundings where BOLTZMANN_TEST_SEED asks for them.
inline std::unique_ptr<ScenarioSimulation> shipped(std::string const& name, Overrides overrides = {}) {
  if (!overrides.seed && test_seed(0) != 0) overrides.seed = test_seed(0);
  auto run = load_scenario(std::string(BOLTZMANN_SOURCE) + "/scenarios/" + name + ".toml", overrides);
  for (auto& ensemble : run->ensembles) nudge(*ensemble);
  return run;
}

inline AnyEnsemble& ensemble(ScenarioSimulation& run, std::string const& name) {
  for (auto& e : run.ensembles)
    if (e->name() == name) return *e;
  throw std::runtime_error("the scenario has no ensemble '" + name + "'");
}

/// Kinetic energy of all classical ensembles, plainly summed.
inline double kinetic_energy(ScenarioSimulation const& run) {
  double sum = 0;
  for (auto const& e : run.ensembles) {
    Field const *v = e->find_field("velocity"), *m = e->find_field("mass");
    if (!v || !m) continue;
    for (std::size_t i = 0; i < e->size(); ++i)
      for (int a = 0; a < v->components; ++a)
        sum += 0.5 * e->row(i)[m->offset] * e->row(i)[v->offset + a] * e->row(i)[v->offset + a];
  }
  return sum;
}

inline double total_energy(ScenarioSimulation const& run) {
  EnergyAndVirial const m = run.simulation->measure();
  return kinetic_energy(run) + m.potential + m.external;
}

}  // namespace boltzmann
