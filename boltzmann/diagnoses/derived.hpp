// Derived quantities: every field of a class and quantities computed from fields (speed, energies), by name, for all
// particles.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// The meaning of a name.
struct QuantityMeaning {
  std::string name;   ///< "velocity.x", "kinetic-energy"
  std::string label;  ///< for axes and columns: "velocity x", "kinetic energy"
  Dimension dimension;
};

/// All valid names for an ensemble:
/// - its fields: "mass", "position.x", "stress.xy"; in 1D also "position";
/// - "speed", "potential-energy", "kinetic-energy" (with mass and velocity), "internal-energy" (with mass and
/// specific_energy);
/// - "influence.x": a force for classes with mass and velocity, else a velocity (its first dimension() components).
/// For a class without velocity "velocity.x" is its influence.
std::vector<QuantityMeaning> quantities(AnyEnsemble const& ensemble);

/// A name may be replaced by a formula of these quantities, "0.5*mass*(velocity.x - 1)^2", with '_' for '-'
/// ("kinetic_energy + potential_energy"), vectors ("norm(influence)/mass"), x, y, z and r (ParticleNames). If `units`
/// are given and not reduced, its dimensions are checked and its numbers may have units.
///
/// The meaning of one name, or formula; Error with all valid names, and the nearest.
QuantityMeaning quantity_meaning(AnyEnsemble const& ensemble, std::string_view name, UnitSystem const* units = nullptr);
/// True if there is such a quantity.
bool has_quantity(AnyEnsemble const& ensemble, std::string_view name, UnitSystem const* units = nullptr);

/// The quantity of every particle, in order. "potential-energy" comes from the scheme: pass the ensemble's vector of
/// EnergyAndVirial::per_particle; otherwise (or with another length) the values are NaN. Error as above.
std::vector<double> quantity(AnyEnsemble const& ensemble, std::string_view name,
                             std::span<double const> potential_energy = {}, UnitSystem const* units = nullptr);

}  // namespace boltzmann
