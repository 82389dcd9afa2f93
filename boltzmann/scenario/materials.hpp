// Materials: the shipped materials by name, for code that learns them at run time.
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

/// A material: what its struct says of itself, and where it stands.
struct MaterialInfo : MaterialText {
  bool barotropic;     ///< no temperature, no energy of its own: both follow from the density
  bool tabulated;      ///< has `points` or `file`
  bool typed;          ///< has `pressure`, and may have `temperature` and `sound_speed`
  std::string header;  ///< for programs
  std::string type;    ///< "IdealGas"
  std::vector<Parameter> parameters;
};

/// Those of shipped_materials.list.
std::vector<MaterialInfo> const& material_catalogue();
/// nullptr if there is none of that name.
MaterialInfo const* find_material(std::string_view name);

/// What viscosity and conduction add to any material, and strength to one of a solid.
std::vector<Parameter> const& flux_parameters();
std::vector<Parameter> const& elastic_parameters();

/// What a scenario says about a material: values of all its parameters.
struct MaterialChoice {
  MaterialInfo const* info = nullptr;
  ParameterValues parameters, fluxes, elastic;
  std::optional<PressureTable> table = {};       ///< of one that is tabulated
  std::optional<FormulaMaterial> formulas = {};  ///< of one that is typed
};

/// A material with its kernels for a class.
struct BoundMaterial {
  MaterialKernels kernels;
  std::shared_ptr<void const> material;
};

/// For fluids (class Smooth) and solids (class Solid). Error, "ideal-gas: specific_heat = 0 must be positive", if the
/// numbers don't go together.
BoundMaterial bind_material(MaterialChoice const& choice, Matter matter, int dimension);

}  // namespace boltzmann
