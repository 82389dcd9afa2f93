// Initial drift and temperature, set when frozen particles and constraints are known.
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/scenario/reading.hpp>
#include <boltzmann/simulation/velocity_changes.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double rounding = 1e-12;  // relative change of the kinetic energy below which velocities keep their bits

/// Particles that move and have random velocities.
ChosenParticles drawn(ReadEnsemble const& ensemble) {
  auto given = ensemble.velocities->given;
  std::sort(given.begin(), given.end());
  ChosenParticles chosen{ensemble.particles, {}};
  for (std::uint32_t i = 0; i < ensemble.particles->size(); ++i)
    if (ensemble.particles->mobility.moves(i) && !std::binary_search(given.begin(), given.end(), i))
      chosen.which.push_back(i);
  return chosen;
}

/// Mass, and Sum m |v - drift|^2.
std::pair<double, double> mass_and_heat(ChosenParticles const& chosen, std::array<double, 3> const& drift) {
  AnyEnsemble const& ensemble = *chosen.ensemble;
  auto const mass = static_cast<std::size_t>(ensemble.field("mass").offset),
             velocity = static_cast<std::size_t>(ensemble.field("velocity").offset);
  ExactSum masses, heat;
  for (auto const i : chosen.which) {
    double const* row = ensemble.row(i);
    masses += row[mass];
    for (std::size_t a = 0; a < static_cast<std::size_t>(ensemble.dimension()); ++a)
      heat += row[mass] * square(row[velocity + a] - drift[a]);
  }
  return {masses.value(), heat.value()};
}

/// Returns true if the velocities were changed.
bool remove_drift(ChosenParticles const& chosen, ReadVelocities const& wanted) {
  auto const common = common_velocity({chosen});
  auto const [mass, heat] = mass_and_heat(chosen, wanted.drift);
  std::array<double, 3> change{};
  double far = 0;
  for (std::size_t a = 0; a < 3; ++a) change[a] = wanted.drift[a] - common[a], far += square(change[a]);
  if (!(mass * far > square(rounding) * heat)) return false;
  kick({chosen}, change);
  return true;
}

bool make_exact(ChosenParticles const& chosen, ReadVelocities const& wanted, KeptMomentum kept, Reading& reading) {
  auto const [mass, heat] = mass_and_heat(chosen, wanted.drift);
  if (wanted.remove_drift && wanted.drift != std::array<double, 3>{}) kept = {{true, true, true}, mass};
  double const freedom = freedom_left(freedom_of(chosen), chosen.ensemble->dimension(), kept, mass);
  double const right = freedom * reading.boltzmann_constant() * wanted.temperature;
  if (chosen.which.empty() || std::abs(heat - right) <= rounding * right) return false;
  if (!(heat > 0) || !(freedom > 0)) {
    reading.mistake(wanted.place,
                    fmt::format("exact_temperature: the particles of '{}' that move have no degree of freedom left",
                                chosen.ensemble->name()));
    return false;
  }
  auto const& d = wanted.drift;
  kick({chosen}, {-d[0], -d[1], -d[2]});
  scale_velocities({chosen}, std::sqrt(right / heat));
  kick({chosen}, d);
  return true;
}

}  // namespace

void settle_velocities(Reading& reading) {
  Simulation& simulation = *reading.result->simulation;
  bool changed = false, exact = false;
  for (auto const& ensemble : reading.ensembles) {
    if (!ensemble.velocities) continue;
    if (ensemble.velocities->remove_drift) changed = remove_drift(drawn(ensemble), *ensemble.velocities) || changed;
    exact = exact || (ensemble.velocities->exact && ensemble.velocities->temperature > 0);
  }
  if (exact) {
    auto const& all = simulation.ensembles();
    auto const kept = zero_momentum(all, simulation.momentum_is_kept(), &simulation.schemes().front()->box());
    for (auto const& ensemble : reading.ensembles)
      if (ensemble.velocities && ensemble.velocities->exact && ensemble.velocities->temperature > 0)
        changed = make_exact(drawn(ensemble), *ensemble.velocities, kept, reading) || changed;
  }
  if (changed) simulation.laws_changed();
}

}  // namespace boltzmann
