// Ghost nodes: nodes beyond the ends of a mesh, which the particles near an end also meet, and what they stand for.
#pragma once

#include <boltzmann/schemes/mesh/poisson.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// The nodes that particles in a box meet with an order of assignment: those of the mesh with some more at both ends of
/// each axis. Node j of the box's own is number j + before.
class Ghosts {
 public:
  /// `cells` and `ends` of the box; open axes have no ghosts: there the mesh itself is made wider.
  Ghosts(int dimension, std::array<std::size_t, 3> const& cells, std::array<FieldEnds, 3> const& ends, int order);

  int dimension() const { return dimension_; }
  int order() const { return order_; }
  int before() const { return before_; }
  /// Cells of the box along an axis.
  std::size_t cells(int axis) const { return cells_[axis]; }
  /// Nodes along an axis, ghosts included: cells + order.
  std::size_t nodes(int axis) const { return to_[axis].size(); }
  std::size_t size() const { return nodes(0) * nodes(1) * nodes(2); }

  /// What node g of an axis stands for: a node of the mesh.
  std::uint32_t mesh_node(int axis, std::size_t g) const { return to_[axis][g]; }
  /// +1 or -1: how the potential continues there.
  double parity(int axis, std::size_t g) const { return parity_[axis][g]; }
  /// The same for component c of the field: the one along the axis continues the other way round.
  double field_parity(int axis, std::size_t g, int c) const {
    return is_image_[axis][g] && c == axis ? -parity_[axis][g] : parity_[axis][g];
  }

  /// Where node j of the mesh stands among those of an axis.
  std::size_t place(int axis, std::size_t j) const {
    return j + (has_ghosts(axis) ? static_cast<std::size_t>(before_) : 0);
  }
  /// Nodes with one place along the last axis.
  std::size_t plane() const { return dimension_ == 3 ? nodes(0) * nodes(1) : dimension_ == 2 ? nodes(0) : 1; }

  /// Adds what stands on ghosts to the nodes that they stand for, in place, and gives the counts on the mesh times
  /// `unit`. (The sums are of integers.) At a plane of symmetry the images of particles count as well.
  void fold(std::int64_t* counts, double unit, std::vector<double>& density, int threads) const;
  /// The same in two steps: planes beyond the ends of the last axis; then what stands in planes [first, last) of the mesh.
  void fold_planes(std::int64_t* counts) const;
  void fold_in_planes(std::int64_t* counts, double unit, std::vector<double>& density, int threads, std::size_t first,
                      std::size_t last) const;

 private:
  bool has_ghosts(int axis) const { return axis < dimension_ && ends_[axis].low != FieldBoundary::open; }
  /// Whether a node is one of the mesh itself.
  bool own(int axis, std::size_t g) const {
    return !has_ghosts(axis) || (g >= place(axis, 0) && g < place(axis, mesh_nodes_[axis]));
  }

  int dimension_, order_, before_;
  std::array<std::size_t, 3> cells_, mesh_nodes_;
  std::array<std::vector<std::uint32_t>, 3> to_;
  std::array<std::vector<double>, 3> parity_;
  std::array<std::vector<std::uint8_t>, 3> is_image_;
  std::array<FieldEnds, 3> ends_;
};

}  // namespace boltzmann
