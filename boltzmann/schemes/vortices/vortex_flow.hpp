// The flow of vortices as a field: velocity, its gradient and vorticity at any place; global measures.
//   VortexFlow flow(vortex_sources(simulation.schemes()), box);
//   flow.measure().energy
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/scheme.hpp>
#include <boltzmann/schemes/source_kind.hpp>
#include <boltzmann/schemes/vortices/vortex_source.hpp>

#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace boltzmann {

class MultipoleScheme;

/// The sources of these schemes, each once. Throws Error if one acts by several laws.
std::vector<VortexSource> vortex_sources(std::vector<Scheme*> const& schemes);

/// Per density of the fluid, in open space.
struct FlowMeasures {
  /// 2D: Hamilton's function 1/2 sum Gamma_i Gamma_j G(r_ij), G = -ln r / (2 pi) outside of cores, with one core of the
  /// mean square of both, including i = j. It is conserved while vortices with equal cores advect each other, and is
  /// the kinetic energy up to a constant of circulation and cores. Its zero depends on the unit of length. 3D: the
  /// kinetic energy of the flow, without the divergent part of the vorticity. Exact for Gaussian cores; for others with
  /// one core instead of the convolution of two, as in 2D.
  double energy = 0;
  /// The integral of the squared vorticity. Exact or approximate as the energy in 3D.
  double enstrophy = 0;
  double largest_vorticity = 0;  ///< at an element
  /// 3D: the difference between the vorticity of the elements and the curl of their velocity, which is divergence-free:
  /// the square root of sum |alpha| |difference|^2 / sum |alpha| |curl|^2 over them. 2D: 0.
  double divergence = 0;
};

class VortexFlow {
 public:
  /// The flow of the current vortices. Throws Error if there are none, if they act by different laws, or if space is
  /// not of 2 or 3 dimensions.
  VortexFlow(std::vector<VortexSource> const& sources, Box const& box, int threads = default_threads());
  ~VortexFlow();
  VortexFlow(VortexFlow&&) noexcept;

  int dimension() const { return dimension_; }
  std::size_t size() const { return size_; }

  /// Sums over all pairs, about 10 ns each for Gaussian cores in 3D on one core of a processor, a few for others.
  /// Throws Error if an axis is periodic.
  FlowMeasures measure() const;
  /// Throws Error unless the energy of vortices is defined in this box.
  static void refuse_images(Box const& box);
  /// True if vortices have infinitely many images: along periodic axes, and between two walls.
  static bool repeats(Box const& box);

  /// Values at each place: in 2D velocity x, y and vorticity; in 3D velocity x, y, z and their gradients, one after the
  /// other. Computed by pairs, or by multipoles with the tolerance of the sources (1e-4 if that is 0) in 3D with more
  /// than 2e9 pairs and if an axis is periodic.
  std::vector<double> at(std::span<double const> places) const;
  /// By pairs for any number of them.
  std::vector<double> at_by_pairs(std::span<double const> places) const;
  static constexpr std::size_t width(int dimension) { return dimension == 2 ? 3 : 12; }

 private:
  struct Elements;
  /// The vortices and their images beside the box.
  std::unique_ptr<AnyEnsemble> with_images() const;
  /// Null: at the elements.
  std::vector<double> sums_at(std::span<double const> places, std::unique_ptr<AnyEnsemble> sources) const;
  VortexLaw law_;
  Box const box_;
  int dimension_, threads_;
  double tolerance_ = 0;
  bool background_ = false;
  std::size_t size_ = 0;
  std::unique_ptr<Elements> elements_;
};

/// Offsets of vorticity and core in the rows of vortices whose class is selected at run time.
SourceKind vortex_kind(AnyEnsemble const& ensemble);
/// The curl of its own flow at the centre of an element in 3D, over its vorticity.
double own_turning(VortexLaw const& law, double core);
/// The curl of the flow, from the numbers of at() for a place in 3D.
Vector<3> curl_of(double const* flow);
/// Q = -1/2 sum d_a v_b d_b v_a, positive where rotation exceeds strain (J. C. R. Hunt and others 1988).
double q_of(double const* flow);

}  // namespace boltzmann
