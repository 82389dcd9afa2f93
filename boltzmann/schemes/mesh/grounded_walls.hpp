// Grounded walls: the field at Dirichlet ends, where the charge in the half cell beside a wall counts.
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
/// not count. For the potential that is right. The field at the wall then lacks that charge: by Gauss' law over the half
/// cell beside it, E(0) = -phi(h)/h - (C h/2) rho(0), and the opposite sign at a high end.
///
/// A particle in the first cell meets the node on the wall, whose charge is partly its own. Such a charge feels the mean
/// of the fields on both sides of itself, E(0) + (C h/4) rho(0): the image force of a lone charge is then that of its
/// images (exact in one dimension). Charge that is spread out evenly is not at the wall but in all of the half cell, and
/// E at its outer side is E(0) again. So that much is taken off for the density at a node that no particle of the first
/// cell meets: E = E(0) + (C h/4) (rho(0) - rho(far)). Both are of second order.
class GroundedWalls {
 public:
  GroundedWalls() = default;
  /// `grid` and `ends` of the solver; `order` of the assignment.
  GroundedWalls(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form, int order);

  /// Whether there are any.
  bool any() const { return !walls_.empty(); }
  /// Whether the solver needs another density (spectral form): then every rank must know all of the density.
  bool lifts() const { return any() && form_ == PoissonForm::spectral; }

  /// Keeps what the walls need of a density. With a team each rank knows only some planes [first, last) of it, and gets
  /// the rest from the others.
  void take(std::vector<double> const& density, std::pair<std::size_t, std::size_t> planes, Team* team);
  /// The density that the solver is given.
  std::vector<double> const& source(std::vector<double> const& density);
  /// From the field of the solver to that at and beside the walls. `background` is the part of the density that did not
  /// come from particles. Does nothing before the first take().
  void correct(std::vector<std::vector<double>>& field, double constant, double background) const;
  /// From the field at the walls to that which acts on particles.
  void for_particles(std::vector<std::vector<double>>& field, double constant, double background) const;

  std::size_t bytes() const { return source_.capacity() * sizeof(double); }

 private:
  struct Wall {
    int axis = 0;
    bool high = false;
    std::vector<double> at, far;  ///< densities on its nodes, and those far enough inside
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
