// Ghost nodes: nodes beyond the ends of a mesh, in the range of particles near an end, and the nodes that they
// represent.
#pragma once

#include <boltzmann/schemes/mesh/poisson.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// The nodes in the range of particles in a box, for an order of assignment: those of the mesh and some more at both
/// ends of each axis. Node j of the box has the number j + before.
class Ghosts {
 public:
  /// `cells` and `ends` of the box. Open axes have no ghosts; there the mesh itself is extended.
  Ghosts(int dimension, std::array<std::size_t, 3> const& cells, std::array<FieldEnds, 3> const& ends, int order);

  int dimension() const { return dimension_; }
  int order() const { return order_; }
  int before() const { return before_; }
  /// Cells of the box along an axis.
  std::size_t cells(int axis) const { return cells_[axis]; }
  /// Nodes along an axis, ghosts included: cells + order.
  std::size_t nodes(int axis) const { return terms_[axis].size(); }
  std::size_t size() const { return nodes(0) * nodes(1) * nodes(2); }

  /// A value beyond the ends: factor times the value on a node of the mesh, plus low (high) times that on the first
  /// (last) one.
  struct Term {
    std::uint32_t node = 0;
    double factor = 1, low = 0, high = 0;
  };
  /// For counts, a potential, and tangential components of a field. Beyond a Neumann end the mirror image has the same
  /// sign. Beyond a Dirichlet end the value is extrapolated, v(-x) = 2 v(0) - v(x). For counts this conserves their sum
  /// and their dipole moment.
  Term const& term(int axis, std::size_t g) const { return terms_[axis][g]; }
  /// For the normal component of a field: it changes sign beyond a Neumann end.
  Term const& normal_term(int axis, std::size_t g) const { return normal_terms_[axis][g]; }
  /// The node of the mesh that node g of an axis represents.
  std::uint32_t mesh_node(int axis, std::size_t g) const { return terms_[axis][g].node; }

  /// Computes row (j, k), nodes(0) numbers, of component `c` of a field, or of a potential (c = -1). `line` has one
  /// number per node of the mesh along x.
  void row(double const* values, int c, std::size_t j, std::size_t k, double* line, double* to) const;

  /// The index of node j of the mesh among all nodes of an axis.
  std::size_t place(int axis, std::size_t j) const {
    return j + (has_ghosts(axis) ? static_cast<std::size_t>(before_) : 0);
  }
  /// The number of nodes with the same index along the last axis.
  std::size_t plane() const { return dimension_ == 3 ? nodes(0) * nodes(1) : dimension_ == 2 ? nodes(0) : 1; }

  /// Adds the counts on ghosts to the nodes that they represent, in place, and returns the counts on the mesh times
  /// `unit`. (The sums are of integers.) The cell of a node on a wall has half the size of others, so its counts are
  /// doubled.
  void fold(std::int64_t* counts, double unit, std::vector<double>& density, int threads) const;
  /// The density at Dirichlet ends computed as at mirrors, which is exact for a uniform density. (fold() conserves the
  /// dipole moment of every particle, and so smears charge across the end if clouds are wider than two cells.)
  void fold_mirrored(std::int64_t* counts, double unit, std::vector<double>& density, int threads) const;
  /// True if the two differ.
  bool smears() const;
  /// fold() in two steps: planes beyond the ends of the last axis; then planes [first, last) of the mesh.
  void fold_planes(std::int64_t* counts) const;
  void fold_in_planes(std::int64_t* counts, double unit, std::vector<double>& density, int threads, std::size_t first,
                      std::size_t last) const;

 private:
  bool has_ghosts(int axis) const { return axis < dimension_ && ends_[axis].low != FieldBoundary::open; }
  /// True if a node of the mesh is on a wall.
  bool is_wall(int axis, std::size_t node) const {
    return has_ghosts(axis) && ends_[axis].low != FieldBoundary::periodic &&
           (node == 0 || node == mesh_nodes_[axis] - 1);
  }
  /// True if a node is part of the mesh itself.
  bool own(int axis, std::size_t g) const {
    return !has_ghosts(axis) || (g >= place(axis, 0) && g < place(axis, mesh_nodes_[axis]));
  }

  using Terms = std::array<std::vector<Term>, 3>;
  void fold_planes(std::int64_t* counts, Terms const& terms) const;
  void fold_in_planes(std::int64_t* counts, double unit, std::vector<double>& density, int threads, std::size_t first,
                      std::size_t last, Terms const& terms) const;

  int dimension_, order_, before_;
  std::array<std::size_t, 3> cells_, mesh_nodes_;
  Terms terms_, normal_terms_, mirrored_;
  std::array<FieldEnds, 3> ends_;
};

}  // namespace boltzmann
