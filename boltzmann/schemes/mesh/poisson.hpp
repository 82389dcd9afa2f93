// Poisson's equation on a mesh, by fast Fourier transforms: from a density to the potential to the field.
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

/// What the potential does at an end of an axis.
enum class FieldBoundary {
  periodic,   ///< (both ends)
  dirichlet,  ///< zero: a grounded conductor
  neumann,    ///< no normal field: a plane of symmetry, an insulator
  open,       ///< (both ends) empty space outside
};

Words<FieldBoundary> const& field_boundary_words();
std::string to_string(FieldBoundary boundary);

/// How derivatives along an axis are taken. Along open axes the potential is the spectral one in both forms; only the
/// field differs.
enum class PoissonForm {
  finite_difference,  ///< three-point Laplacian, central differences (section 4.4 of the 1990 thesis)
  /// k^2 and i k. Exact for smooth densities; but the field of single particles rings at the shortest waves (in 3D by
  /// 11 % with cloud in cell, 5 % triangular, 2 % of order 4), which finite differences damp: for particles take a high
  /// order.
  spectral,
};
Words<PoissonForm> const& poisson_form_words();

struct FieldEnds {
  FieldBoundary low = FieldBoundary::periodic, high = FieldBoundary::periodic;
};

/// Green's function in place of 1/k^2, given the wave vector (2 pi m / L for each axis, -pi/h <= k < pi/h; 0 beyond the
/// dimension): for periodic boxes only. It must be even, G(-k) = G(k). Not asked at k = 0.
using GreensFunction = std::function<double(std::array<double, 3> const& k)>;

/// Ranks of a team that solve together.
struct SolvingRanks {
  Team* team = nullptr;
  /// For each rank, of each plane (all nodes with one place along the last axis), whether it reads the solution there;
  /// empty: everybody reads all of it.
  std::vector<std::vector<char>> reads;

  /// A rank solves for planes [begin, end) of so many, of which alone it has to know the density.
  std::pair<std::size_t, std::size_t> part(std::size_t rank, std::size_t planes) const;
};

/// Solves laplacian phi = -constant rho, E = -grad phi on the nodes of a mesh. Densities and potentials are arrays of
/// grid.size() numbers, x fastest; a field is one such array for each axis. Along each axis:
/// - periodic: modes exp(i k x). The slope of the Nyquist mode of an even number of cells is zero.
/// - Dirichlet: phi = 0 on the edge nodes, the density there is ignored. Modes sin; in finite differences the normal
///   field on the edge comes from the odd continuation, E = -phi(h)/h at the low end.
/// - Neumann: modes cos; the normal field on the edge is zero. The density of an edge node is that of its half cell and
///   the mirror image together (twice what lies inside, divided by the volume of a full cell).
/// - open: the density is convolved with the Green function of empty space (schemes/mesh/open_kernel.hpp), in modes
///   along the other axes: -(C/2)|x|, -(C/2 pi) ln r, (C/4 pi)/r for a charge of 1 with one, two, three open axes.
///   The field in spectral form is the convolution with the kernel's slope; in finite differences it is a central
///   difference, one-sided of second order at the edges.
/// Where all axes are periodic or Neumann, the mean of the density (k = 0) is dropped and the mean potential is zero.
/// Results have the same bits for any number of threads and ranks. One solver serves one caller at a time.
class PoissonSolver {
 public:
  /// Error if: an end is periodic or open and the other end of the axis is not; a periodic axis of the mesh is not
  /// periodic here, or the other way around; an axis has too few cells (2 between two Dirichlet ends, else 1); `green`
  /// is given for a mesh with an axis that isn't periodic, or isn't finite for some k.
  PoissonSolver(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends, PoissonForm form, int threads = 1,
                GreensFunction const& green = {});
  ~PoissonSolver();
  PoissonSolver(PoissonSolver const&) = delete;
  PoissonSolver& operator=(PoissonSolver const&) = delete;

  /// laplacian phi = -constant rho. Error if `density` has not grid.size() numbers; `potential` gets its size here.
  void potential(std::vector<double> const& density, double constant, std::vector<double>& potential);
  /// E = -grad phi, one array for each axis. Along open axes always by differences: a potential alone says nothing
  /// about the outside. Error if `potential` has not grid.size() numbers.
  void field(std::vector<double> const& potential, std::vector<std::vector<double>>& field);
  /// Both, without a way back in between; `potential` may be null. Error as in potential(). With `ranks` for all of them,
  /// in two or three dimensions: each does a part, and tells the others what they read. Elsewhere a rank finds anything.
  void solve(std::vector<double> const& density, double constant, std::vector<double>* potential,
             std::vector<std::vector<double>>& field, SolvingRanks const* ranks = nullptr);

  /// For the solutions to come.
  void threads(int count);

  /// What this solver holds between calls.
  std::size_t bytes() const;
  /// The most that a solver for such a mesh will hold while it is made or solves, before it is made; without the
  /// caller's arrays. Error as the constructor's.
  static std::size_t bytes_needed(MeshGrid const& grid, std::array<FieldEnds, 3> const& ends,
                                  PoissonForm form = PoissonForm::spectral, int threads = 1, bool green = false);

 private:
  struct Plans;
  std::unique_ptr<Plans> plans_;
};

}  // namespace boltzmann
