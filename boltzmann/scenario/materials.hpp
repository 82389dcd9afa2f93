// Materials: the shipped materials by name, for code that selects them at run time.
#pragma once

#include <boltzmann/laws/materials/formula_material.hpp>
#include <boltzmann/laws/materials/pressure_table.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/scenario/law_parameters.hpp>
#include <boltzmann/schemes/smooth/material_kernels.hpp>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// A material: the description of its struct, and its header.
struct MaterialInfo : MaterialText {
  bool barotropic;     ///< without independent temperature and energy: both follow from the density
  bool tabulated;      ///< has `points` or `file`
  bool typed;          ///< has `pressure`, and may have `temperature` and `sound_speed`
  std::string header;  ///< for programs
  std::string type;    ///< "IdealGas"
  std::vector<Parameter> parameters;
};

/// The materials of shipped_materials.list.
std::vector<MaterialInfo> const& material_catalogue();
/// nullptr if there is none of that name.
MaterialInfo const* find_material(std::string_view name);

/// Parameters of viscosity and conduction for any material, and of strength for a solid.
std::vector<Parameter> const& flux_parameters();
std::vector<Parameter> const& elastic_parameters();

/// The material of a scenario: values of all its parameters.
struct MaterialChoice {
  MaterialInfo const* info = nullptr;
  ParameterValues parameters, fluxes, elastic;
  std::optional<PressureTable> table = {};       ///< of a tabulated material
  std::optional<FormulaMaterial> formulas = {};  ///< of a typed material
};

/// A material with its kernels for a class.
struct BoundMaterial {
  MaterialKernels kernels;
  std::shared_ptr<void const> material;
};

/// For fluids (class Smooth) and solids (class Solid). Throws Error, "ideal-gas: specific_heat = 0 must be positive",
/// for an invalid combination of numbers.
BoundMaterial bind_material(MaterialChoice const& choice, Matter matter, int dimension);

}  // namespace boltzmann
