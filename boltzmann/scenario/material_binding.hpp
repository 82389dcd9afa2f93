// Material binding: creates a material with its kernels for fluids and for solids from an equation of state. Private to
// this module.
#pragma once

#include <boltzmann/laws/materials/elastic.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/scenario/materials.hpp>

#include <shipped_materials.hpp>  // the headers of the list

#include <variant>

namespace boltzmann::detail {

template <class First, class... Others>
struct OneOf {
  using Type = std::variant<Others...>;
};
using EquationOfState = OneOf<void
#define MATERIAL(header, Material) , Material
#include <boltzmann/scenario/shipped_materials.list>
#undef MATERIAL
                              >::Type;

template <template <int, class> class P, class M>
BoundMaterial bound_in(M const& material, int dimension) {
  check_parameters(material);
  auto const kept = std::make_shared<M>(material);
  return {dimension == 1   ? material_kernels<P<1, double>>(material)
          : dimension == 2 ? material_kernels<P<2, double>>(material)
                           : material_kernels<P<3, double>>(material),
          kept};
}

/// Omits fluxes if all are zero, so that gradients need not be computed.
template <template <int, class> class P, class M>
BoundMaterial bound_with_fluxes(M const& material, ParameterValues const& fluxes, int dimension) {
  Newtonian<M> viscous{material};
  set_parameters(viscous, fluxes);
  bool const none = viscous.shear_viscosity == 0 && viscous.bulk_viscosity == 0 && viscous.conductivity == 0;
  return none ? bound_in<P>(material, dimension) : bound_in<P>(viscous, dimension);
}

// One per source file, so that they compile in parallel.
BoundMaterial bind_fluid(EquationOfState const& state, MaterialChoice const& choice, int dimension);
BoundMaterial bind_solid(EquationOfState const& state, MaterialChoice const& choice, int dimension);

}  // namespace boltzmann::detail
