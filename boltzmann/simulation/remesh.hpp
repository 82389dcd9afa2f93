// Remeshing: vortices that the flow has carried apart or together are replaced by others on the nodes of a lattice.
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

/// How the vorticity of a particle is shared among the nodes around it: by products of one function along each axis.
enum class RemeshKernel {
  m4,  ///< M4' of J. J. Monaghan, J. Comput. Phys. 60, 253 (1985): 4 nodes an axis, keeps the moments 0 to 2
  m6,  ///< M6* of M. Bergdorf and P. Koumoutsakos, Multiscale Model. Simul. 5, 980 (2006): 6 nodes, moments 0 to 4
};
Words<RemeshKernel> const& remesh_kernel_words();

/// The weights of the 2 n nodes around a place that is `fraction` of a spacing above a node, from node 1 - n (counted
/// from that one) to node n; n is returned.
int remesh_weights(RemeshKernel kernel, double fraction, std::array<double, 6>& weights);

/// How vortices are remeshed.
struct Remeshing {
  /// Of the nodes, which stand at low + (n + 1/2) spacing of the box, as those of fill_load do.
  double spacing = 0;
  RemeshKernel kernel = RemeshKernel::m4;
  double core = 0;         ///< of the new vortices; 0: one and a half of the spacing
  double threshold = 0;    ///< nodes with less than this part of the greatest vorticity are weak, and left out,
  double max_loss = 1e-4;  ///< unless these make more than this part of the sum of all magnitudes
  int margin = 0;          ///< but not those so many nodes around others: vorticity can spread to them
  /// Where nodes may stand, beside the limits of the box; empty: everywhere.
  std::function<bool(std::array<double, 3> const&)> allowed = {};

  /// Error if it can't be done.
  void check() const;
};

struct Remeshed {
  std::size_t removed = 0;           ///< nodes that were left out although they had vorticity
  Vector<3> vorticity_lost{};        ///< the sum of that; in 2D the third number
  double magnitudes_lost = 0;        ///< and of its magnitudes
  Vector<3> impulse_lost{};          ///< sum Gamma (y, -x) of that; 1/2 sum x x alpha
  std::size_t left_as_they_are = 0;  ///< vortices in corners with no place for nodes
};

/// Replaces the vortices of an ensemble by others on nodes, in the order x fastest, then y, then z. The sum of vorticity
/// and its first and second moments (circulation, linear and angular impulse) stay to rounding, but for what is left
/// out. Positions, `vorticity`, `core` and, where the class has it, `volume` (that of a cell) are new; other fields are
/// those of the particle that gave the node most. Along periodic axes nodes repeat. Beyond reflecting ends and walls, in
/// regions that keep out, and where it is not allowed, there are no nodes: vortices near these are shared among the
/// nearest block of 3 nodes an axis by quadratic polynomials, which keep the same moments. Influences become zero. The
/// result depends on the particles alone. Error as by check(), and if there would be too many nodes.
Remeshed remesh(AnyEnsemble& ensemble, Box const& box, Remeshing const& remeshing);
/// Error if the ensemble, whatever its state, can't be remeshed so in this box.
void check(AnyEnsemble const& ensemble, Box const& box, Remeshing const& remeshing);

/// [[remesh]] of a scenario; on whom is read by code.
struct RemeshOptions {
  std::int64_t every = 1;
  Remeshing how;
};
OptionTable const& remesh_options();

}  // namespace boltzmann
