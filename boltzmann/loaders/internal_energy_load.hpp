// Internal energies in equilibrium with a heat bath, for mesoparticles.
#pragma once

#include <boltzmann/laws/state_law.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <cstdint>
#include <limits>

namespace boltzmann {

struct InternalEnergyOptions {
  double temperature = std::numeric_limits<double>::quiet_NaN();  ///< required
  double boltzmann_constant = 1;                                  ///< 1: the temperature is an energy
  std::uint64_t seed = 1;
};

/// Gives every particle an internal energy drawn from its exact invariant law at this temperature (StateLaw::draw), and
/// its temperature to the field "temperature", if the class has one. Particle i draws from a stream of its own. Error
/// if the class has no field "internal_energy", or temperature or k is not positive.
void internal_energy_load(AnyEnsemble& ensemble, StateLaw const& law, InternalEnergyOptions const& options);

}  // namespace boltzmann
