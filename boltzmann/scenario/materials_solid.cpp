// Materials of solids.
#include <boltzmann/scenario/material_binding.hpp>

namespace boltzmann::detail {

BoundMaterial bind_solid(EquationOfState const& state, MaterialChoice const& choice, int dimension) {
  return std::visit(
      [&]<class Material>(Material const& material) {
        Elastic<Material> solid{material, 0};
        set_parameters(solid, choice.elastic);
        return bound_with_fluxes<Solid>(solid, choice.fluxes, dimension);
      },
      state);
}

}  // namespace boltzmann::detail
