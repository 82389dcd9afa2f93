// Materials of fluids.
#include <boltzmann/scenario/material_binding.hpp>

namespace boltzmann::detail {

BoundMaterial bind_fluid(EquationOfState const& state, MaterialChoice const& choice, int dimension) {
  return std::visit([&](auto const& material) { return bound_with_fluxes<Smooth>(material, choice.fluxes, dimension); },
                    state);
}

}  // namespace boltzmann::detail
