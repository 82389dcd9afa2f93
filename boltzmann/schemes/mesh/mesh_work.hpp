// The working data of a mesh scheme: the solver, and arrays on its nodes. Private to this module.
#pragma once

#include <boltzmann/schemes/mesh/assign_task.hpp>
#include <boltzmann/schemes/mesh/ghosts.hpp>
#include <boltzmann/schemes/mesh/grounded_walls.hpp>
#include <boltzmann/schemes/mesh/mesh_scheme.hpp>
#include <boltzmann/schemes/mesh/tallies.hpp>

#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

namespace boltzmann {

struct MeshScheme::Loaded {
  AnyEnsemble* ensemble;
  SourceKind kind;
  std::vector<double> strengths;

  /// Updates the strengths of all particles.
  void refresh(int threads);
  /// Updates the strengths of this rank's particles. Returns true if any has changed.
  bool refresh_share(int threads);
};

struct MeshScheme::Work {
  Ghosts ghosts;
  MeshGrid grid;  ///< of the solver
  PoissonSolver solver;
  GroundedWalls walls;
  MeshField density, potential, field;
  Tallies tallies;                             ///< with ghosts
  double total_strength = 0;                   ///< at the last deposit
  double per_strength = 1;                     ///< counts, at the last deposit of a divided run
  std::vector<double> inside;                  ///< fraction of each node's cell that is in the box, if needed
  std::vector<std::vector<double>> padded;     ///< the field (and the potential last) with ghosts, if needed
  SolvingRanks ranks;                          ///< of a divided run, at the last solution
  std::pair<std::size_t, std::size_t> planes;  ///< planes of nodes whose density this rank has;
  Team* others = nullptr;                      ///< the other ranks, if there are any
  std::vector<std::int64_t> unfolded;  ///< counts of the last deposit, if observers see another density than the solver
  bool density_shown = false;          ///< true if `density` is that for observers

  Work(Ghosts ghosts, MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form, int threads,
       GreensFunction const& green);
  std::size_t bytes() const;
  /// The uniform background density.
  double background(MeshScheme const& scheme) const;
  /// Converts the density for the solver to that for observers: without the part that clouds smear across walls, and
  /// extrapolated to walls. (It keeps the common sign of the nodes.)
  void show_density(MeshScheme const& scheme);
  static std::vector<std::string> warn_of_open_axes(MeshScheme const& scheme, double step_size);
};

/// Counts per unit of strength, as a power of two such that neither a deposit (below 2^48) nor the total (below 2^62)
/// overflows.
double counts_per_strength(double greatest, std::size_t particles);

/// Copies the components of a field, or a potential, and adds ghost values; if `ranks` are given, only where this rank
/// reads them.
void pad(Ghosts const& ghosts, MeshField const& field, bool potential, std::vector<std::vector<double>>& padded,
         int threads, SolvingRanks const* ranks = nullptr);

/// Particles per range of a loop.
inline constexpr std::size_t mesh_grain = 1U << 14U;

/// A particle as one number: ensembles in the order in which they were added, particles in that of their numbers.
inline constexpr std::int64_t no_particle = std::numeric_limits<std::int64_t>::max();
inline std::int64_t loaded_particle(std::size_t loaded, std::size_t i) {
  return static_cast<std::int64_t>(loaded << 40U | i);
}

}  // namespace boltzmann
