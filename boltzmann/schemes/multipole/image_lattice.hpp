// ImageLattice: the images of a periodic box, along one or several axes. Nearby images interact individually. All
// others act together on the expansion of the box, by lattice sums that converge like Ewald sums. Private to this
// module.
#pragma once

#include <boltzmann/schemes/multipole/expansion_tables.hpp>

#include <array>
#include <cmath>
#include <cstddef>
#include <vector>

namespace boltzmann {

inline double distance_of(std::array<double, 3> const& place) {
  return std::sqrt(place[0] * place[0] + place[1] * place[1] + place[2] * place[2]);
}

/// The largest number of individual images.
inline constexpr std::size_t most_images = 80'000;

struct ImageLattice {
  std::array<double, 3> edges{0, 0, 0};  ///< of the periodic axes; 0: open

  int periodic_axes() const { return (edges[0] > 0) + (edges[1] > 0) + (edges[2] > 0); }
  /// True if an image touches the box, or is the box itself.
  bool beside(std::array<double, 3> const& place) const {
    for (int a = 0; a < 3; ++a)
      if (std::abs(place[static_cast<std::size_t>(a)]) > 1.5 * edges[static_cast<std::size_t>(a)]) return false;
    return true;
  }
  /// A distance within which all of these are.
  double furthest_beside() const { return 1.0001 * distance_of(edges); }
  /// The positions of the images within this distance, in ascending distance from the box itself on. Throws
  /// PhysicsFailure if the block around them has more than most_images.
  std::vector<std::array<double, 3>> within(double distance) const;
  /// The distance of the nearest image that is further than this.
  double next_after(double distance) const;
};

/// The effect on the box of all images beyond a distance, to an order of expansions.
class FarImages {
 public:
  /// `distance` must be between those of two images.
  FarImages(int dimension, ImageLattice const& lattice, double distance, int order);

  int order() const { return order_; }
  double distance() const { return distance_; }

  /// Adds the effect of the box's moments in all these images to its local expansion (M2L). Both are about this centre,
  /// with this radius.
  void add(ExpansionView const& tables, double const* moments, double radius, double* local) const;

 private:
  double sum(int n, int m) const { return sums_[static_cast<std::size_t>(n / 2 * (order_ + 1) + m / 2)]; }
  void add_plane(ExpansionView const& tables, double const* moments, double radius, double* local) const;
  void add_solid(ExpansionView const& tables, double const* moments, double radius, double* local) const;

  int dimension_, order_;
  double distance_, unit_;
  /// For even n up to 2 order and even m, over powers of the unit: in 3D of the normalised T_n^m, in 2D of Re z^-n (and
  /// for n = 0 of -ln r). Boxes have mirror symmetry, so all others vanish.
  std::vector<double> sums_;
  std::vector<double> binomials_;
};

}  // namespace boltzmann
