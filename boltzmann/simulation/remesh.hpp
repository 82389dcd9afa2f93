// Remeshing: replaces vortices that the flow has spread or clustered by others on the nodes of a lattice.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/options.hpp>
#include <boltzmann/core/words.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>

namespace boltzmann {

/// The kernel that distributes the vorticity of a particle to the nodes around it: a product of one function along each
/// axis.
enum class RemeshKernel {
  m4,  ///< M4' of J. J. Monaghan, J. Comput. Phys. 60, 253 (1985): 4 nodes an axis, conserves the moments 0 to 2
  m6,  ///< M6* of M. Bergdorf and P. Koumoutsakos, Multiscale Model. Simul. 5, 980 (2006): 6 nodes, moments 0 to 4
};
Words<RemeshKernel> const& remesh_kernel_words();

/// The weights of the 2 n nodes around a point that is `fraction` of a spacing above a node, from node 1 - n (counted
/// from that one) to node n; returns n.
int remesh_weights(RemeshKernel kernel, double fraction, std::array<double, 6>& weights);

/// Options of remeshing.
struct Remeshing {
  /// Distance of nodes, which are at low + (n + 1/2) spacing of the box, like those of fill_load.
  double spacing = 0;
  RemeshKernel kernel = RemeshKernel::m4;
  double core = 0;         ///< of the new vortices; 0: one and a half of the spacing
  double threshold = 0;    ///< nodes with less than this part of the greatest vorticity are weak, and are removed,
  double max_loss = 1e-4;  ///< unless they have more than this part of the sum of all magnitudes
  int margin = 0;          ///< weak nodes within this number of nodes of others are kept: vorticity can spread to them
  /// True where nodes are allowed, inside the limits of the box; empty: everywhere.
  std::function<bool(std::array<double, 3> const&)> allowed = {};

  /// Error if an option is invalid.
  void check() const;
};

struct Remeshed {
  std::size_t removed = 0;           ///< removed nodes that had vorticity
  Vector<3> vorticity_lost{};        ///< its sum; in 2D the third number
  double magnitudes_lost = 0;        ///< the sum of its magnitudes
  Vector<3> impulse_lost{};          ///< its sum Gamma (y, -x); 1/2 sum x x alpha
  std::size_t left_as_they_are = 0;  ///< vortices in corners that have no place for nodes
};

/// Replaces the vortices of an ensemble by others on nodes, in the order x fastest, then y, then z. The sum of
/// vorticity and its first and second moments (circulation, linear and angular impulse) are conserved to rounding,
/// except for removed nodes. Positions, `vorticity`, `core` and, if the class has it, `volume` (that of a cell) are
/// new; other fields are those of the particle that contributed most to the node. Along periodic axes nodes repeat.
/// There are no nodes beyond reflecting ends and walls, in regions that keep particles out, and where they are not
/// allowed. Vortices near these are distributed to the nearest block of 3 nodes an axis by quadratic polynomials, which
/// conserve the same moments. Influences become zero. The result depends on the particles only. Error as by check(),
/// and if there would be too many nodes.
Remeshed remesh(AnyEnsemble& ensemble, Box const& box, Remeshing const& remeshing);
/// Error if the ensemble, independent of its state, can't be remeshed like this in this box.
void check(AnyEnsemble const& ensemble, Box const& box, Remeshing const& remeshing);

/// [[remesh]] of a scenario; the ensemble is read by other code.
struct RemeshOptions {
  std::int64_t every = 1;
  Remeshing how;
};
OptionTable const& remesh_options();

}  // namespace boltzmann
