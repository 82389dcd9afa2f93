// Material binding: from an equation of state to its kernels for fluids and for solids. Private to this room.
#pragma once

#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/materials/elastic.hpp>
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/isentropic_gas.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/laws/materials/pressure_table.hpp>
#include <boltzmann/laws/materials/stiffened_gas.hpp>
#include <boltzmann/laws/materials/tait.hpp>
#include <boltzmann/laws/materials/van_der_waals.hpp>
#include <boltzmann/scenario/materials.hpp>

#include <variant>

namespace boltzmann::detail {

using EquationOfState =
    std::variant<IdealGas, QuadraticGas, IsentropicGas, Tait, StiffenedGas, VanDerWaals, PressureTable>;

struct FluxNumbers {
  double shear_viscosity, bulk_viscosity, conductivity;
  bool none() const { return shear_viscosity == 0 && bulk_viscosity == 0 && conductivity == 0; }
};
struct ElasticNumbers {
  double shear_modulus, yield_stress, tensile_strength;
};

template <template <int, class> class P, class M>
BoundMaterial bound_in(M const& material, int dimension) {
  if constexpr (requires { material.check(); }) material.check();
  auto const kept = std::make_shared<M>(material);
  return {dimension == 1   ? material_kernels<P<1, double>>(material)
          : dimension == 2 ? material_kernels<P<2, double>>(material)
                           : material_kernels<P<3, double>>(material),
          kept};
}

/// With fluxes only where there are some: without, gradients need not be found.
template <template <int, class> class P, class M>
BoundMaterial bound_with_fluxes(M const& material, FluxNumbers const& fluxes, int dimension) {
  if (fluxes.none()) return bound_in<P>(material, dimension);
  return bound_in<P>(Newtonian<M>{material, fluxes.shear_viscosity, fluxes.bulk_viscosity, fluxes.conductivity},
                     dimension);
}

// One per source file, so that they compile side by side.
BoundMaterial bind_fluid(EquationOfState const& state, FluxNumbers const& fluxes, int dimension);
BoundMaterial bind_solid(EquationOfState const& state, FluxNumbers const& fluxes, ElasticNumbers const& elastic,
                         int dimension);

}  // namespace boltzmann::detail
