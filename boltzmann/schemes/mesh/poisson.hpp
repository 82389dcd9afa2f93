// Poisson's equation on a mesh by fast Fourier transforms: from a density to the potential to the field.
#pragma once

#include <boltzmann/core/words.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

class Team;

/// The boundary condition of the potential at an end of an axis.
enum class FieldBoundary {
  periodic,   ///< (both ends)
  dirichlet,  ///< zero potential: a grounded conductor
  neumann,    ///< no normal field: a plane of symmetry, an insulator
  open,       ///< (both ends) empty space outside
};

Words<FieldBoundary> const& field_boundary_words();
std::string to_string(FieldBoundary boundary);

/// The discretisation of derivatives along an axis. Along open axes both forms have the spectral potential; only the
/// field differs.
enum class PoissonForm {
  finite_difference,  ///< three-point Laplacian, central differences (section 4.4 of the 1990 thesis)
  /// k^2 and i k. Exact for smooth densities. The field of single particles rings at the shortest waves (in 3D by 11 %
  /// with cloud in cell, 5 % triangular, 2 % of order 4), which finite differences damp. So use a high order for
  /// particles.
  spectral,
};
Words<PoissonForm> const& poisson_form_words();

struct FieldEnds {
  FieldBoundary low = FieldBoundary::periodic, high = FieldBoundary::periodic;
};

/// Green's function in place of 1/k^2, for periodic boxes only. Its argument is the wave vector (2 pi m / L for each
/// axis, -pi/h <= k < pi/h; 0 beyond the dimension). It must be even, G(-k) = G(k). It is not called for k = 0.
using GreensFunction = std::function<double(std::array<double, 3> const& k)>;

/// Ranks of a team that solve together.
struct SolvingRanks {
  Team* team = nullptr;
  /// For each rank and plane (all nodes with the same index on the last axis): true if the rank reads the solution
  /// there; empty: all ranks read all planes.
  std::vector<std::vector<char>> reads;

  /// The planes [begin, end) that a rank solves, out of this number. The rank needs the density of these planes only.
  std::pair<std::size_t, std::size_t> part(std::size_t rank, std::size_t planes) const;
};

/// Solves laplacian phi = -constant rho, E = -grad phi on the nodes of a mesh. Densities and potentials are arrays of
/// grid.size() numbers, x fastest; a field is one such array for each axis. Along each axis:
/// - periodic: modes exp(i k x). The slope of the Nyquist mode of an even number of cells is zero.
/// - Dirichlet: phi = 0 on the edge nodes, where the density is ignored. Modes sin; in finite differences the normal
///   field on the edge comes from the odd continuation, E = -phi(h)/h at the low end.
/// - Neumann: modes cos; the normal field on the edge is zero. The density of an edge node is that of its half cell and
///   the mirror image together (twice what lies inside, divided by the volume of a full cell).
/// - open: the density is convolved with the Green function of empty space (schemes/mesh/open_kernel.hpp), in modes
///   along the other axes: -(C/2)|x|, -(C/2 pi) ln r, (C/4 pi)/r for a charge of 1 with one, two, three open axes. The
///   field in spectral form is the convolution with the kernel's slope; in finite differences it is a central
///   difference, one-sided of second order at the edges.
/// If all axes are periodic or Neumann, the mean of the density (k = 0) is dropped and the mean potential is zero.
/// Results have the same bits for any number of threads and ranks. Not thread-safe.
class PoissonSolver {
 public:
  /// Throws Error if one end of an axis is periodic or open and the other is not; if the mesh and `ends` differ in
  /// which axes are periodic; if an axis has too few cells (2 between two Dirichlet ends, else 1); if `green` is given
  /// for a mesh with an axis that isn't periodic, or isn't finite for some k.
  PoissonSolver(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form, int threads = 1,
                GreensFunction const& green = {});
  ~PoissonSolver();
  PoissonSolver(PoissonSolver const&) = delete;
  PoissonSolver& operator=(PoissonSolver const&) = delete;

  /// Solves laplacian phi = -constant rho and resizes `potential`. Throws Error if `density` has not grid.size()
  /// numbers.
  void potential(std::vector<double> const& density, double constant, std::vector<double>& potential);
  /// E = -grad phi, one array for each axis. Along open axes always by differences, because the potential outside is
  /// unknown. Throws Error if `potential` has not grid.size() numbers.
  void field(std::vector<double> const& potential, std::vector<std::vector<double>>& field);
  /// Computes both without an extra transform in between; `potential` may be null. Throws Error as potential(). With
  /// `ranks` (in two or three dimensions) the call is collective: each rank solves a part, and sends the others what
  /// they read. Elsewhere the results of a rank are undefined.
  void solve(std::vector<double> const& density, double constant, std::vector<double>* potential,
             std::vector<std::vector<double>>& field, SolvingRanks const* ranks = nullptr);

  /// Sets the number of threads of later solutions.
  void threads(int count);

  /// The memory that this solver holds between calls.
  std::size_t bytes() const;
  /// The peak memory of a solver for such a mesh, during construction or solution, without the caller's arrays. Throws
  /// Error as the constructor does.
  static std::size_t bytes_needed(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends,
                                  PoissonForm form = PoissonForm::spectral, int threads = 1, bool green = false);

 private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

}  // namespace boltzmann
