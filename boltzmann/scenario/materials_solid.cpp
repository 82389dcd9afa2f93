// Materials of solids.
#include <boltzmann/scenario/material_binding.hpp>

namespace boltzmann::detail {

BoundMaterial bind_solid(EquationOfState const& state, FluxNumbers const& fluxes, ElasticNumbers const& elastic,
                         int dimension) {
  return std::visit(
      [&](auto const& material) {
        Elastic<std::decay_t<decltype(material)>> const solid{material, elastic.shear_modulus, elastic.yield_stress,
                                                              elastic.tensile_strength};
        return bound_with_fluxes<Solid>(solid, fluxes, dimension);
      },
      state);
}

}  // namespace boltzmann::detail
