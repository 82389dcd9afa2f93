// The flow of vortices as a field: velocity, its slopes, vorticity at any place; what is measured of it as a whole.
//
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

/// Those of these schemes, each once. Error if one acts by several laws.
std::vector<VortexSource> vortex_sources(std::vector<Scheme*> const& schemes);

/// Over the density of the fluid, in open space.
struct FlowMeasures {
  /// 2D: Hamilton's function 1/2 sum Gamma_i Gamma_j G(r_ij), G = -ln r / (2 pi) outside of cores, with one core of the
  /// mean square of both; i = j is in it. It is what stays while equal cores carry each other, and the kinetic energy but
  /// for what is the same as long as circulation and cores are. Its zero belongs to the unit of length.
  /// 3D: the kinetic energy of the flow, without what has a divergence in the vorticity; exact for Gaussian cores, for
  /// others with one core instead of two on each other, as in 2D.
  double energy = 0;
  /// The integral of the square of the vorticity, exact and otherwise as the energy in 3D.
  double enstrophy = 0;
  double largest_vorticity = 0;  ///< at an element
  /// 3D: how far the vorticity of the elements is from the curl of their velocity, which has no divergence: the square
  /// root of sum |alpha| |difference|^2 / sum |alpha| |curl|^2 over them. 2D: 0.
  double divergence = 0;
};

class VortexFlow {
 public:
  /// As the vortices stand now. Error if there are none, if they act by different laws, or if space is not of 2 or 3
  /// dimensions.
  VortexFlow(std::vector<VortexSource> const& sources, Box const& box, int threads = default_threads());
  ~VortexFlow();
  VortexFlow(VortexFlow&&) noexcept;

  int dimension() const { return dimension_; }
  std::size_t size() const { return size_; }

  /// Sums over all pairs, about 10 ns each for Gaussian cores in 3D on one core of a processor, a few for others. Error
  /// if an axis is periodic.
  FlowMeasures measure() const;
  /// Error unless the energy of vortices is known in this box.
  static void refuse_images(Box const& box);
  /// Whether vortices have images without end: along periodic axes, and between two walls.
  static bool repeats(Box const& box);

  /// Numbers at each place: in 2D velocity x, y and vorticity; in 3D velocity x, y, z and the gradients of these, one
  /// after the other. By pairs, or, in 3D where there are more than 2e9 of these, and where an axis is periodic, by
  /// multipoles of the tolerance of the sources (1e-4 if that is 0).
  std::vector<double> at(std::span<double const> places) const;
  /// However many there are.
  std::vector<double> at_by_pairs(std::span<double const> places) const;
  static constexpr std::size_t width(int dimension) { return dimension == 2 ? 3 : 12; }

 private:
  struct Elements;
  /// And those that are beside the box.
  std::unique_ptr<AnyEnsemble> with_images() const;
  /// Null: of the elements.
  std::vector<double> sums_at(std::span<double const> places, std::unique_ptr<AnyEnsemble> sources) const;
  VortexLaw law_;
  Box const box_;
  int dimension_, threads_;
  double tolerance_ = 0;
  bool background_ = false;
  std::size_t size_ = 0;
  std::unique_ptr<Elements> elements_;
};

/// Where vorticity and core stand in the rows of vortices whose class is known at run time only.
SourceKind vortex_kind(AnyEnsemble const& ensemble);
/// The curl of its own flow in the middle of an element in 3D, over its vorticity.
double own_turning(VortexLaw const& law, double core);
/// The curl of the flow in numbers that at() gives for a place in 3D.
Vector<3> curl_of(double const* flow);
/// Q = -1/2 sum d_a v_b d_b v_a, above 0 where a flow turns more than it strains (J. C. R. Hunt and others 1988).
double q_of(double const* flow);

}  // namespace boltzmann
