// Field measures: functions of a mesh's density, potential and field.
#pragma once

#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <array>
#include <complex>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// The quantities of a mesh, one number on each node: "density", "potential", "field.x", "field.y", ...
std::vector<std::string> mesh_quantities(std::span<MeshField const* const> fields);

/// One of them.
struct MeshQuantity {
  MeshField const* field;
  std::size_t component;
  std::string label;  ///< "field x"

  MeshGrid const& grid() const { return field->grid; }
  std::vector<double> const& values() const { return field->components[component]; }
  Dimension dimension() const { return field->dimension; }
};

/// The quantity of that name. Error with the existing names, or if there is no mesh.
MeshQuantity mesh_quantity(std::span<MeshField const* const> fields, std::string_view name);

/// (1/2) integral of rho phi dV: the energy of the field. It equals (1/2 C) integral of E^2 dV with div E = C rho if
/// the box is periodic, its walls are conductors at zero, or the distant field vanishes. Nodes on the walls of axes
/// that are not periodic have half weight. Error if the mesh has no density or no potential.
double field_energy(std::span<MeshField const* const> fields);

/// The wave with this number of periods along each axis (negative: in the opposite direction): c such that the
/// quantity's part is Re(c exp(i k x)), x from the low edge. A cosine of amplitude A gives c = A, a sine -i A. Mode
/// zero along all axes is the mean. Error if a mode is not zero along an axis that is not periodic, or beyond half the
/// number of nodes.
std::complex<double> field_mode(MeshQuantity const& quantity, std::array<int, 3> const& mode);

/// The mean of a quantity over all other axes, at each node of one axis.
std::vector<double> profile(MeshQuantity const& quantity, int axis);

}  // namespace boltzmann
