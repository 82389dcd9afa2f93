// Sums over the nodes of a mesh.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/diagnoses/field_measures.hpp>

#include <fmt/format.h>

#include <cmath>
#include <cstdlib>
#include <numbers>

namespace boltzmann {
namespace {

/// Calls f(node's number, i, j, k) for every node.
template <class F>
void each_node(MeshGrid const& grid, F const& f) {
  std::size_t node = 0;
  for (std::size_t k = 0; k < grid.nodes[2]; ++k)
    for (std::size_t j = 0; j < grid.nodes[1]; ++j)
      for (std::size_t i = 0; i < grid.nodes[0]; ++i) f(node++, i, j, k);
}

/// The weight of each node of an axis in an integral: half a cell for the ends of axes that are not periodic.
std::vector<double> shares(MeshGrid const& grid, int axis) {
  std::vector<double> shares(grid.nodes[axis], 1.0);
  if (axis < grid.dimension && !grid.periodic[axis] && shares.size() > 1) shares.front() = shares.back() = 0.5;
  return shares;
}

MeshField const& named(std::span<MeshField const* const> fields, std::string_view name) {
  for (auto const* field : fields)
    if (field->name == name) return *field;
  throw Error(fields.empty() ? "there is no mesh in this simulation"
                             : fmt::format("the mesh has no {}, only {}", name, join(mesh_quantities(fields))));
}

}  // namespace

std::vector<std::string> mesh_quantities(std::span<MeshField const* const> fields) {
  std::vector<std::string> names;
  for (auto const* field : fields)
    for (std::size_t c = 0; c < field->components.size(); ++c)
      names.push_back(field->components.size() == 1 && field->name != "field" ? field->name
                                                                              : field->name + '.' + "xyz"[c]);
  return names;
}

MeshQuantity mesh_quantity(std::span<MeshField const* const> fields, std::string_view name) {
  auto const names = mesh_quantities(fields);
  std::size_t k = 0;
  for (auto const* field : fields)
    for (std::size_t c = 0; c < field->components.size(); ++c, ++k) {
      if (names[k] != name) continue;
      std::string label(name);
      if (auto const dot = label.rfind('.'); dot != std::string::npos) label[dot] = ' ';
      return {field, c, label};
    }
  if (fields.empty()) throw Error("there is no mesh in this simulation");
  throw Error(fmt::format("the mesh has no '{}'{}", name, choices(std::string(name), names, "it has")));
}

double field_energy(std::span<MeshField const* const> fields) {
  MeshField const &density = named(fields, "density"), &potential = named(fields, "potential");
  MeshGrid const& grid = density.grid;
  auto const x = shares(grid, 0), y = shares(grid, 1), z = shares(grid, 2);
  ExactSum sum;
  each_node(grid, [&](std::size_t node, std::size_t i, std::size_t j, std::size_t k) {
    sum += x[i] * y[j] * z[k] * density.components[0][node] * potential.components[0][node];
  });
  return 0.5 * sum.value() * grid.cell_volume();
}

std::complex<double> field_mode(MeshQuantity const& quantity, std::array<int, 3> const& mode) {
  MeshGrid const& grid = quantity.grid();
  std::array<std::vector<std::complex<double>>, 3> wave;
  double weight = 1;
  bool real = true;  // the wave equals its own conjugate
  for (int a = 0; a < 3; ++a) {
    auto const n = static_cast<std::int64_t>(grid.nodes[a]);
    if (mode[a] != 0 && (a >= grid.dimension || !grid.periodic[a]))
      throw Error(a >= grid.dimension
                      ? fmt::format("mode {} along {}: the mesh has no such axis", mode[a], "xyz"[a])
                      : fmt::format("mode {} along {}: the axis is not periodic; only mode 0 is possible there",
                                    mode[a], "xyz"[a]));
    if (2 * std::abs(static_cast<std::int64_t>(mode[a])) > n)
      throw Error(fmt::format("mode {} along {}: the mesh has {} node{} there, which show{} modes up to {}", mode[a],
                              "xyz"[a], n, n == 1 ? "" : "s", n == 1 ? "s" : "", n / 2));
    real = real && (mode[a] == 0 || 2 * std::abs(static_cast<std::int64_t>(mode[a])) == n);
    auto const share = shares(grid, a);
    double total = 0;
    for (std::int64_t j = 0; j < n; ++j) {
      // The angle from an integer, so that it is exact for any node.
      double const turn = static_cast<double>((mode[a] * j) % n) / static_cast<double>(n);
      wave[a].push_back(share[static_cast<std::size_t>(j)] * std::polar(1.0, -2 * std::numbers::pi * turn));
      total += share[static_cast<std::size_t>(j)];
    }
    weight /= total;
  }
  std::complex<double> sum = 0;
  auto const& values = quantity.values();
  std::size_t node = 0;
  for (auto const& z : wave[2])
    for (auto const& y : wave[1]) {
      std::complex<double> line = 0;
      for (auto const& x : wave[0]) line += x * values[node++];
      sum += z * y * line;
    }
  return (real ? 1.0 : 2.0) * weight * sum;
}

std::vector<double> profile(MeshQuantity const& quantity, int axis) {
  MeshGrid const& grid = quantity.grid();
  if (axis < 0 || axis >= grid.dimension)
    throw Error(fmt::format("the mesh has no axis {}, it has {} of them, from 0 on", axis, grid.dimension));
  std::array<std::vector<double>, 3> share{shares(grid, 0), shares(grid, 1), shares(grid, 2)};
  double total = 1;
  for (int a = 0; a < 3; ++a) {
    if (a == axis) share[a].assign(grid.nodes[a], 1.0);
    double sum = 0;
    for (double const s : share[a]) sum += s;
    if (a != axis) total *= sum;
  }
  std::vector<double> mean(grid.nodes[axis], 0.0);
  each_node(grid, [&](std::size_t node, std::size_t i, std::size_t j, std::size_t k) {
    mean[axis == 0   ? i
         : axis == 1 ? j
                     : k] += share[0][i] * share[1][j] * share[2][k] * quantity.values()[node] / total;
  });
  return mean;
}

}  // namespace boltzmann
