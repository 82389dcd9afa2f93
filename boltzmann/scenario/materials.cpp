// The catalogue of materials: one entry for each, and how it is made from its parameters.
#include <boltzmann/scenario/material_binding.hpp>

#include <fmt/format.h>

#include <limits>

namespace boltzmann {
namespace {

Dimension none(int) { return dimensions::none; }
Dimension velocity(int) { return dimensions::velocity; }
Dimension density(int space) { return dimensions::mass / pow(dimensions::length, space); }
Dimension pressure(int space) { return dimensions::energy / pow(dimensions::length, space); }
Dimension viscosity(int space) { return pressure(space) * dimensions::time; }
Dimension heat_conductivity(int space) {
  return dimensions::energy * dimensions::length / pow(dimensions::length, space - 1) /
         (dimensions::time * dimensions::temperature);
}
Dimension specific_heat(int) { return dimensions::specific_heat; }
Dimension by_density2(int space) { return pressure(space) / pow(density(space), 2); }
Dimension by_density(int space) { return dimensions::none / density(space); }

MaterialParameter gamma_parameter(std::optional<double> usual = {}) {
  return {"gamma", none, "ratio of the specific heats", above(1), usual};
}
MaterialParameter specific_heat_parameter() {
  return {"specific_heat", specific_heat, "at constant volume, energy by mass and temperature", positive, 1.0, false};
}

double number(MaterialValues const& values, std::string_view name, std::vector<MaterialParameter> const& parameters) {
  for (auto const& [key, value] : values)
    if (key == name) return value;
  for (auto const& parameter : parameters)
    if (parameter.name == name && parameter.usual) return *parameter.usual;
  throw Error(fmt::format("a material needs '{}'", name));
}

detail::EquationOfState state_of(MaterialChoice const& choice) {
  std::string_view const name = choice.info->name;
  auto const v = [&](std::string_view key) { return number(choice.parameters, key, choice.info->parameters); };
  if (name == "ideal-gas") return IdealGas{v("gamma"), v("specific_heat")};
  if (name == "quadratic-gas") return QuadraticGas{v("coefficient")};
  if (name == "isentropic-gas") return IsentropicGas{v("constant"), v("gamma")};
  if (name == "tait") return Tait{v("reference_density"), v("sound_speed"), v("gamma"), v("background_pressure")};
  if (name == "stiffened-gas") return StiffenedGas{v("gamma"), v("stiffness"), v("specific_heat")};
  if (name == "van-der-waals") return VanDerWaals{v("a"), v("b"), v("k_over_m"), v("degrees_of_freedom")};
  return PressureTable(choice.points);
}

BoundMaterial bind(detail::EquationOfState const& state, MaterialChoice const& choice, Matter matter, int dimension) {
  auto const flux = [&](std::string_view key) { return number(choice.fluxes, key, flux_parameters()); };
  detail::FluxNumbers const fluxes{flux("shear_viscosity"), flux("bulk_viscosity"), flux("conductivity")};
  if (matter == Matter::fluid) return detail::bind_fluid(state, fluxes, dimension);
  auto const elastic = [&](std::string_view key) { return number(choice.elastic, key, elastic_parameters()); };
  return detail::bind_solid(
      state, fluxes, {elastic("shear_modulus"), elastic("yield_stress"), elastic("tensile_strength")}, dimension);
}

}  // namespace

std::vector<MaterialInfo> const& material_catalogue() {
  static std::vector<MaterialInfo> const all = {
      {"ideal-gas",
       "the ideal gas",
       "P = (gamma - 1) rho e, T = e / specific_heat",
       false,
       false,
       "boltzmann/laws/materials/ideal_gas.hpp",
       "IdealGas",
       {gamma_parameter(), specific_heat_parameter()}},
      {"quadratic-gas",
       "a gas whose smooth particles are atoms with their weight as potential; the isentrope of the ideal gas in 2D",
       "P = coefficient rho^2, e = coefficient rho",
       true,
       false,
       "boltzmann/laws/materials/isentropic_gas.hpp",
       "QuadraticGas",
       {{"coefficient", by_density2, "pressure by the square of the density", positive, 0.5, false}}},
      {"isentropic-gas",
       "an ideal gas whose entropy is the same everywhere and always",
       "P = constant rho^gamma, e = constant rho^(gamma - 1) / (gamma - 1)",
       true,
       false,
       "boltzmann/laws/materials/isentropic_gas.hpp",
       "IsentropicGas",
       {{"constant", none, "pressure / density^gamma, a number in the base's units", positive}, gamma_parameter()}},
      {"tait",
       "a liquid that is hard to compress",
       "P = B [(rho / reference_density)^gamma - 1] + background_pressure, B = reference_density sound_speed^2 / gamma",
       true,
       false,
       "boltzmann/laws/materials/tait.hpp",
       "Tait",
       {{"reference_density", density, "where the pressure is the background", positive},
        {"sound_speed", velocity, "at the reference density", positive},
        {"gamma", none, "7 for water; 1: pressure linear in the density", positive, 7.0},
        {"background_pressure", pressure, "added everywhere", any_number, 0.0}}},
      {"stiffened-gas",
       "liquids and solids under strong shocks, with heat",
       "P = (gamma - 1) rho e - gamma stiffness, e = specific_heat T + stiffness / rho",
       false,
       false,
       "boltzmann/laws/materials/stiffened_gas.hpp",
       "StiffenedGas",
       {gamma_parameter(),
        {"stiffness", pressure, "a pressure; 0: the ideal gas", not_negative},
        specific_heat_parameter()}},
      {"van-der-waals",
       "gas and liquid in one equation",
       "P = rho k T / (1 - b rho) - a rho^2, e = (f/2) k T - a rho; k = k_over_m, f = degrees_of_freedom",
       false,
       false,
       "boltzmann/laws/materials/van_der_waals.hpp",
       "VanDerWaals",
       {{"a", by_density2, "attraction: pressure by the square of the density", not_negative},
        {"b", by_density, "volume that molecules take, by mass", not_negative},
        {"k_over_m", specific_heat, "Boltzmann's constant by the mass of a molecule", positive},
        {"degrees_of_freedom", none, "f, of a molecule", positive}}},
      {"table",
       "pressures that are known at some densities; a smooth curve goes through them",
       "P(rho) through points = [[density, pressure], ...], or those of a text file: file = \"iron.txt\"",
       true,
       true,
       "boltzmann/laws/materials/pressure_table.hpp",
       "PressureTable",
       {}},
  };
  return all;
}

MaterialInfo const* find_material(std::string_view name) {
  for (auto const& material : material_catalogue())
    if (material.name == name) return &material;
  return nullptr;
}

std::vector<MaterialParameter> const& flux_parameters() {
  static std::vector<MaterialParameter> const all = {
      {"shear_viscosity", viscosity, "against shear", not_negative, 0.0},
      {"bulk_viscosity", viscosity, "against compression", not_negative, 0.0},
      {"conductivity", heat_conductivity, "of heat; needs a material with a temperature", not_negative, 0.0}};
  return all;
}

std::vector<MaterialParameter> const& elastic_parameters() {
  constexpr double unlimited = std::numeric_limits<double>::infinity();
  static std::vector<MaterialParameter> const all = {
      {"shear_modulus", pressure, "stress by strain, in shear", positive},
      {"yield_stress", pressure, "the tension at which a rod begins to flow", positive, unlimited},
      {"tensile_strength", pressure, "the tension at which it breaks", positive, unlimited}};
  return all;
}

std::optional<double> usual_value(MaterialParameter const& parameter, bool reduced_base) {
  return parameter.usual_with_units || reduced_base ? parameter.usual : std::nullopt;
}

BoundMaterial bind_material(MaterialChoice const& choice, Matter matter, int dimension) {
  return bind(state_of(choice), choice, matter, dimension);
}

BoundMaterial bind_table(PressureTable const& table, MaterialChoice const& choice, Matter matter, int dimension) {
  return bind(table, choice, matter, dimension);
}

}  // namespace boltzmann
