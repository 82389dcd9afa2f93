// A gas of mesoparticles that do nothing but rub: no forces, so that its equilibrium is known to the last digit.
#pragma once

#include <boltzmann/core/random.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>
#include <boltzmann/loaders/internal_energy_load.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/meso.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <cmath>
#include <tests/seed.hpp>

namespace boltzmann {

template <int D>
struct MesoparticleGas {
  /// `number_density` particles per area or volume, in a periodic box.
  MesoparticleGas(std::size_t count, double number_density, double range, double k = 1)
      : gas("gas", count),
        scheme(Box(edge(0), edge(std::pow(static_cast<double>(count) / number_density, 1.0 / D)), Boundary::periodic),
               range),
        dpd(scheme, k),
        k(k) {
    scheme.add(gas);
    scheme.skin(0.3 * range);  // ideal particles are fast
    random_load(gas, scheme.box(), {.seed = test_seed(4)});
  }
  /// Velocities of this kinetic temperature (exactly), no momentum.
  void kinetic_temperature(double temperature) {
    maxwellian_load(gas, {.temperature = temperature,
                          .boltzmann_constant = k,
                          .seed = test_seed(5),
                          .remove_drift = true,
                          .exact_temperature = true});
  }
  double kinetic_energy() const {
    double sum = 0;
    for (auto const& p : gas) sum += p.mass * norm2(p.velocity) / 2;
    return sum;
  }
  double internal_energy() const {
    double sum = 0;
    for (auto const& p : gas) sum += p.internal_energy;
    return sum;
  }
  double size() const { return static_cast<double>(gas.size()); }
  /// 2 K / (D (N - 1) k): the momentum is none.
  double kinetic_temperature() const { return 2 * kinetic_energy() / (D * (size() - 1) * k); }
  /// 1 / <1 / T>, for a temperature as a function of energy.
  template <class T>
  double harmonic_temperature(T const& temperature) const {
    double sum = 0;
    for (auto const& p : gas) sum += 1 / temperature(p.internal_energy);
    return size() / sum;
  }

  Ensemble<Meso<D>> gas;
  PairScheme scheme;
  PairDissipation dpd;
  double k;

 private:
  static Vector<D> edge(double place) {
    Vector<D> x{};
    for (int d = 0; d < D; ++d) x[d] = place;
    return x;
  }
};

}  // namespace boltzmann
