// What tests of gases made of smooth particles share: lattices at rest, and what is conserved.
#pragma once

#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/particles/ensemble.hpp>
#include <boltzmann/particles/smooth.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <type_traits>

namespace boltzmann {

/// Particles in the middles of the cells of a square lattice that fills a block, x fastest.
template <int D>
void fill(Ensemble<Smooth<D>>& gas, Vector<D> const& low, double spacing,
          std::type_identity_t<std::array<std::size_t, D>> const& counts) {
  std::size_t number = 1;
  for (auto const count : counts) number *= count;
  gas.resize(number);
  for (std::size_t i = 0; i < number; ++i) {
    std::size_t rest = i;
    for (int a = 0; a < D; ++a) {
      gas[i].position[a] = low[a] + (static_cast<double>(rest % counts[a]) + 0.5) * spacing;
      rest /= counts[a];
    }
  }
}

template <int D>
double kinetic_energy(Ensemble<Smooth<D>> const& gas) {
  ExactSum sum;
  for (auto const& p : gas) sum += 0.5 * p.mass * norm2(p.velocity);
  return sum.value();
}

/// The total energy of a scheme with one gas.
template <int D>
double total_energy(SmoothScheme& scheme, Ensemble<Smooth<D>> const& gas) {
  EnergyAndVirial const measures = scheme.measure();
  return kinetic_energy(gas) + measures.internal + measures.external;
}

/// The length of the total momentum by the sum of the lengths of all momenta.
template <int D>
double momentum_share(Ensemble<Smooth<D>> const& gas) {
  Vector<D> total{};
  double size = 0;
  for (auto const& p : gas) {
    total += p.velocity * p.mass;
    size += p.mass * magnitude(p.velocity);
  }
  return magnitude(total) / size;
}

/// Advances to a time in even steps that are at most that part of the Courant step at every look, so many looks.
template <class Simulation>
void run_by_courant(Simulation& simulation, SmoothScheme& scheme, double until, double part, int looks) {
  double const start = simulation.time();
  for (int look = 1; look <= looks; ++look) {
    double const rest = start + (until - start) * look / looks - simulation.time();
    auto const steps = static_cast<std::uint64_t>(std::ceil(rest / (part * scheme.courant_step())));
    simulation.step_size(rest / static_cast<double>(steps));
    simulation.run(steps);
  }
}

}  // namespace boltzmann
