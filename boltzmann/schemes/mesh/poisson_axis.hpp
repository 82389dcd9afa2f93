// Axes of Poisson's equation: the modes in which the Laplacian is a factor, and differences on the nodes. Private to
// the solver.
#pragma once

#include <boltzmann/schemes/mesh/poisson.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <vector>

namespace boltzmann::poisson {

enum class Kind { single, periodic, dirichlet, neumann, dirichlet_neumann, neumann_dirichlet, open };

/// The mesh has three slots: rows along x, planes of rows, and the last axis, which counts planes. In 2D, y is the last
/// axis and a plane is a single row.
struct Axis {
  Kind kind = Kind::single;
  std::size_t nodes = 1, cells = 1;
  std::size_t first = 0, samples = 1;  ///< the transformed nodes
  std::size_t modes = 1;               ///< also the length of the transform
  double spacing = 1;
  double scale = 1;                ///< inverse of the factor of a transform and its inverse
  std::vector<double> eigenvalue;  ///< of -d^2/dx^2, for each mode
  std::vector<double> slope;       ///< of -d/dx: see Lines::slope

  bool complex() const { return kind == Kind::periodic || kind == Kind::open; }
  /// The number of the positive mode, for two modes that differ only in sign.
  std::size_t folded(std::size_t mode) const { return complex() ? std::min(mode, modes - mode) : mode; }
  std::size_t folded_modes() const { return complex() ? modes / 2 + 1 : modes; }
};

/// The axis without its tables. Throws Error as the constructor of PoissonSolver does.
Axis make_axis(MeshGrid const& grid, FieldEnds const& ends, int a);
void fill_tables(Axis& axis, PoissonForm form);

/// E at a node from at most three nodes of its line.
struct Difference {
  std::array<std::size_t, 3> node{};
  std::array<double, 3> weight{};
  int terms = 2;
};
Difference difference_at(Axis const& axis, std::size_t j);

}  // namespace boltzmann::poisson
