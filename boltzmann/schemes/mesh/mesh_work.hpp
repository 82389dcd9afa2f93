// What a mesh scheme works with: the solver, and arrays on its nodes. Private to this room.
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

  /// Asks the class for all strengths as they are now.
  void refresh(int threads);
  /// The same for this rank's share. Whether one is another than before.
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
  std::vector<double> inside;                  ///< the share of each node's cell that is in the box, when wanted
  std::vector<std::vector<double>> padded;     ///< the field (and the potential last) with ghosts, when wanted
  SolvingRanks ranks;                          ///< of a divided run, at the last solution
  std::pair<std::size_t, std::size_t> planes;  ///< of nodes, those whose density this rank knows; others if
  Team* others = nullptr;                      ///< there are any
  std::vector<std::int64_t>
      unfolded;                ///< counts of the last deposit, where observers see another density than the solver
  bool density_shown = false;  ///< whether `density` is that of observers

  Work(Ghosts ghosts, MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form, int threads,
       GreensFunction const& green);
  std::size_t bytes() const;
  /// The uniform density that no particle has.
  double background(MeshScheme const& scheme) const;
  /// From the density that was solved for to that which observers see: without what clouds smear across walls, and
  /// extrapolated to them. (It keeps the sign that all nodes have.)
  void show_density(MeshScheme const& scheme);
  static std::vector<std::string> warn_of_open_axes(MeshScheme const& scheme, double step_size);
};

/// Counts per unit of strength so that neither a deposit (below 2^48) nor the sum of all (below 2^62) is too large, as
/// a power of two.
double counts_per_strength(double greatest, std::size_t particles);

/// The components of a field, or a potential, with what stands on ghosts; if `ranks` are given, where this one reads them.
void pad(Ghosts const& ghosts, MeshField const& field, bool potential, std::vector<std::vector<double>>& padded,
         int threads, SolvingRanks const* ranks = nullptr);

/// Particles of one range of a loop.
inline constexpr std::size_t mesh_grain = 1U << 14U;

/// A particle as one number: ensembles in the order in which they were loaded, particles in that of their numbers.
inline constexpr std::int64_t no_particle = std::numeric_limits<std::int64_t>::max();
inline std::int64_t loaded_particle(std::size_t loaded, std::size_t i) {
  return static_cast<std::int64_t>(loaded << 40U | i);
}

}  // namespace boltzmann
