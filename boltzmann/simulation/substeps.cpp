// Computes the longest substep of a state.
#include <boltzmann/core/error.hpp>
#include <boltzmann/simulation/substeps.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>

namespace boltzmann {

void check(SubstepOptions const& options) {
  if (!options.distance && !options.energy && !options.courant)
    throw Error("substeps: no limit is set; give distance, energy or courant");
  for (auto const& [name, value] :
       {std::pair{"distance", options.distance}, {"energy", options.energy}, {"courant", options.courant}})
    if (value && !(*value > 0 && std::isfinite(*value)))
      throw Error(fmt::format("substeps: {} is {}; it must be positive", name, *value));
}

double longest_substep(SubstepOptions const& options, std::span<Moved const> moved, std::span<Scheme* const> schemes) {
  double const infinite = std::numeric_limits<double>::infinity();
  double shortest = infinite;
  if (options.courant)
    for (auto* scheme : schemes) shortest = std::min(shortest, *options.courant * scheme->longest_step());
  if (!options.distance && !options.energy) return shortest;
  for (auto const& one : moved) {
    AnyEnsemble const& ensemble = *one.ensemble;
    Field const *mass = ensemble.find_field("mass"), *velocity = ensemble.find_field("velocity");
    if (!mass || !velocity) continue;
    double speed = 0, acceleration = 0, power = 0;  // the largest squares
    one.each([&](std::size_t i) {
      double const *row = ensemble.row(i), *force = ensemble.influence(i);
      double v2 = 0, f2 = 0;
      for (int a = 0; a < velocity->components; ++a) {
        v2 += row[velocity->offset + a] * row[velocity->offset + a];
        f2 += force[a] * force[a];
      }
      speed = std::max(speed, v2);
      acceleration = std::max(acceleration, f2 / (row[mass->offset] * row[mass->offset]));
      power = std::max(power, f2 * v2);
    });
    if (options.distance && speed > 0) shortest = std::min(shortest, *options.distance / std::sqrt(speed));
    if (options.distance && acceleration > 0)
      shortest = std::min(shortest, std::sqrt(2 * *options.distance / std::sqrt(acceleration)));
    if (options.energy && power > 0) shortest = std::min(shortest, *options.energy / std::sqrt(power));
  }
  return shortest;
}

}  // namespace boltzmann
