// ImageLattice: the images of a periodic box, one axis or several. Those nearby are met one by one, all others act
// together on the expansion of the box, by sums over the lattice that converge as Ewald's do. Private to this room.
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

/// No more images than this are met.
inline constexpr std::size_t most_images = 80'000;

struct ImageLattice {
  std::array<double, 3> edges{0, 0, 0};  ///< of the periodic axes; 0: open

  int periodic_axes() const { return (edges[0] > 0) + (edges[1] > 0) + (edges[2] > 0); }
  /// Whether an image touches the box, or is it.
  bool beside(std::array<double, 3> const& place) const {
    for (int a = 0; a < 3; ++a)
      if (std::abs(place[static_cast<std::size_t>(a)]) > 1.5 * edges[static_cast<std::size_t>(a)]) return false;
    return true;
  }
  /// A distance within which all of these are.
  double furthest_beside() const { return 1.0001 * distance_of(edges); }
  /// The places of the images no further than this, that of the box itself first, in ascending distance.
  /// PhysicsFailure if the block around them has more than most_images.
  std::vector<std::array<double, 3>> within(double distance) const;
  /// The distance of the nearest image that is further than this.
  double next_after(double distance) const;
};

/// What all images further than a distance do to the box, to an order of expansions.
class FarImages {
 public:
  /// `distance` lies between those of two images.
  FarImages(int dimension, ImageLattice const& lattice, double distance, int order);

  int order() const { return order_; }
  double distance() const { return distance_; }

  /// Adds to the local expansion of the box about a centre, with a radius, what its moments about the same centre make
  /// in all these images (M2L).
  void add(ExpansionView const& tables, double const* moments, double radius, double* local) const;

 private:
  double sum(int n, int m) const { return sums_[static_cast<std::size_t>(n / 2 * (order_ + 1) + m / 2)]; }
  void add_plane(ExpansionView const& tables, double const* moments, double radius, double* local) const;
  void add_solid(ExpansionView const& tables, double const* moments, double radius, double* local) const;

  int dimension_, order_;
  double distance_, unit_;
  /// Of even n up to 2 order and even m, over powers of the unit: in 3D of the normalised T_n^m, in 2D of Re z^-n (and
  /// for n = 0 of -ln r). Boxes are the same seen in mirrors, and all others vanish.
  std::vector<double> sums_;
  std::vector<double> binomials_;
};

}  // namespace boltzmann
