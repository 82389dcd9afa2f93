// The catalogue of materials, with the description of each struct and its construction from parameters.
#include <boltzmann/scenario/material_binding.hpp>

namespace boltzmann {
namespace {

template <class Material>
MaterialInfo described(char const* header, char const* type) {
  return {Material::text,
          is_barotropic<Material>,
          std::is_same_v<Material, PressureTable>,
          std::is_same_v<Material, FormulaMaterial>,
          header,
          type,
          parameters_of<Material>()};
}

template <class Material>
bool is_made(MaterialChoice const& choice, detail::EquationOfState& state) {
  if (choice.info->name != Material::text.name) return false;
  if constexpr (std::is_same_v<Material, PressureTable>)
    state = choice.table.value();
  else if constexpr (std::is_same_v<Material, FormulaMaterial>)
    state = choice.formulas.value();
  else
    state = made_from<Material>(choice.parameters);
  return true;
}

detail::EquationOfState state_of(MaterialChoice const& choice) {
  detail::EquationOfState state;
#define MATERIAL(header, Material) || is_made<Material>(choice, state)
  if (false
#include <boltzmann/scenario/shipped_materials.list>
  )
    return state;
#undef MATERIAL
  throw Error("'" + std::string(choice.info->name) + "' is none of the shipped materials");
}

}  // namespace

std::vector<MaterialInfo> const& material_catalogue() {
  static std::vector<MaterialInfo> const all{
#define MATERIAL(header, Material) described<Material>("boltzmann/laws/materials/" #header ".hpp", #Material),
#include <boltzmann/scenario/shipped_materials.list>
#undef MATERIAL
  };
  return all;
}

MaterialInfo const* find_material(std::string_view name) {
  for (auto const& material : material_catalogue())
    if (material.name == name) return &material;
  return nullptr;
}

std::vector<Parameter> const& flux_parameters() {
  static auto const all = parameters_of<Newtonian<IdealGas>>();
  return all;
}
std::vector<Parameter> const& elastic_parameters() {
  static auto const all = parameters_of<Elastic<IdealGas>>();
  return all;
}

BoundMaterial bind_material(MaterialChoice const& choice, Matter matter, int dimension) {
  auto const bind = matter == Matter::fluid ? detail::bind_fluid : detail::bind_solid;
  return bind(state_of(choice), choice, dimension);
}

}  // namespace boltzmann
