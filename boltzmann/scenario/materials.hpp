// Materials: the shipped materials by name, for code that learns them at run time.
#pragma once

#include <boltzmann/core/dimension.hpp>
#include <boltzmann/core/number_range.hpp>
#include <boltzmann/laws/materials/pressure_table.hpp>
#include <boltzmann/scenario/classes.hpp>
#include <boltzmann/schemes/smooth/material_kernels.hpp>

#include <memory>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

namespace boltzmann {

struct MaterialParameter {
  std::string_view name;
  Dimension (*dimension)(int of_space);  ///< in 1D and 2D densities are mass per length and area, pressures alike
  std::string_view doc;
  NumberRange range;
  std::optional<double> usual = {};  ///< the value unless told; none: required
  bool usual_with_units = true;      ///< false: only a base without units has that value
};

/// A material: an equation of state.
struct MaterialInfo {
  std::string_view name;  ///< the word in scenarios: "ideal-gas"
  std::string_view doc;   ///< one line
  std::string_view formula;
  bool barotropic;          ///< no temperature, no energy of its own: both follow from the density
  bool tabulated;           ///< has `points` or `file`
  std::string_view header;  ///< for programs
  std::string_view type;    ///< "IdealGas"
  std::vector<MaterialParameter> parameters;
};

/// Every material that is shipped.
std::vector<MaterialInfo> const& material_catalogue();
/// nullptr if there is none of that name.
MaterialInfo const* find_material(std::string_view name);

/// What viscosity and conduction add to any material, and strength to one of a solid.
std::vector<MaterialParameter> const& flux_parameters();
std::vector<MaterialParameter> const& elastic_parameters();

/// A value of a parameter that is not given.
std::optional<double> usual_value(MaterialParameter const& parameter, bool reduced_base);

/// Numbers by name, in the simulation's base.
using MaterialValues = std::vector<std::pair<std::string_view, double>>;

/// What a scenario says about a material. Parameters that are missing in `fluxes` and `elastic` have their usual
/// values.
struct MaterialChoice {
  MaterialInfo const* info = nullptr;
  MaterialValues parameters, fluxes, elastic;
  std::vector<PressurePoint> points;  ///< of a table
};

/// A material with its kernels for a class.
struct BoundMaterial {
  MaterialKernels kernels;
  std::shared_ptr<void const> material;
};

/// For fluids (class Smooth) and solids (class Solid). Error, "ideal-gas: cv = 0 must be positive", if the numbers
/// don't go together.
BoundMaterial bind_material(MaterialChoice const& choice, Matter matter, int dimension);
/// The same with a table that has been read already.
BoundMaterial bind_table(PressureTable const& table, MaterialChoice const& choice, Matter matter, int dimension);

}  // namespace boltzmann
