// Grounded walls: the field at Dirichlet ends, including the charge in the half cell beside a wall.
#pragma once

#include <boltzmann/schemes/mesh/poisson.hpp>
#include <boltzmann/schemes/mesh/wall_clouds.hpp>

#include <array>
#include <cstddef>
#include <utility>
#include <vector>

namespace boltzmann {

class Ghosts;
class Team;

/// The solver continues density and potential as odd functions beyond a Dirichlet end, so the charge on its nodes does
/// not contribute. This is correct for the potential, but the field at the wall lacks that charge. By Gauss' law over
/// the half cell beside it, E(0) = -phi(h)/h - (C h/2) rho(0), and the opposite sign at a high end.
/// A particle in the first cell contributes to the charge on the wall node. Such a charge feels the mean of the fields
/// on both sides of itself, E(0) + (C h/4) rho(0). The image force of a single charge is then that of its images (exact
/// in one dimension). Uniform charge is not at the wall but in all of the half cell, and E at its outer side is E(0)
/// again. So the density at a node out of range of the first cell's particles is subtracted: E = E(0) + (C h/4) (rho(0)
/// - rho(far)). Both are of second order.
class GroundedWalls {
 public:
  GroundedWalls() = default;
  /// `grid` and `ends` of the solver; `order` of the assignment.
  GroundedWalls(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form, int order);

  /// True if there are any.
  bool any() const { return !walls_.empty(); }
  /// True if the solver needs a modified density (spectral form): then every rank must have all of the density.
  bool lifts() const { return any() && form_ == PoissonForm::spectral; }

  /// Stores the densities that the walls need. With a team, each rank has only planes [first, last) of the density, and
  /// receives the rest from the others.
  void take(std::vector<double> const& density, std::pair<std::size_t, std::size_t> planes, Team* team);
  /// The density for the solver.
  std::vector<double> const& source(std::vector<double> const& density);
  /// Converts the field of the solver to that at and beside the walls. `background` is the part of the density that
  /// does not come from particles. No-op before the first take().
  void correct(std::vector<std::vector<double>>& field, double constant, double background) const;
  /// Converts the field at the walls to that which acts on particles.
  void for_particles(std::vector<std::vector<double>>& field, double constant, double background) const;

  std::size_t bytes() const { return source_.capacity() * sizeof(double); }

 private:
  struct Wall {
    int axis = 0;
    bool high = false;
    std::vector<double> at, far;  ///< densities on its nodes, and on nodes sufficiently far inside
    std::vector<double> lift, rest, smeared;
  };

  template <class Function>
  void for_nodes(Wall const& wall, std::size_t inward, Function const& function) const;
  std::size_t far_node(int axis) const;

  MeshGrid grid_;
  std::array<FieldEnds, 3> ends_;
  PoissonForm form_ = PoissonForm::finite_difference;
  int order_ = 2;
  bool taken_ = false;
  std::vector<Wall> walls_;
  WallClouds clouds_;
  std::vector<double> source_;
};

}  // namespace boltzmann
