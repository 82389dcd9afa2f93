// Random places: random sequential addition, up to saturation. Private to this module.
#pragma once

#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <array>
#include <cstddef>
#include <functional>
#include <vector>

namespace boltzmann {

/// The particles placed so far, in cells at least as wide as the minimum distance.
class PlacedParticles {
 public:
  PlacedParticles(AnyEnsemble const& ensemble, Box const& box, double distance);

  /// True if no particle is nearer than the distance.
  bool free(double const* x) const;
  /// True if one particle is nearer than the distance to every point of a block around x.
  bool covers(double const* x, std::array<double, 3> const& half_edges) const;
  void add(std::size_t i);

 private:
  static constexpr std::size_t nobody = ~std::size_t{0};

  template <class F>
  bool any_near(double const* x, F const& f) const;
  std::size_t cell(int a, double x) const;
  /// The squared distance from y to the furthest corner of a block around x.
  double furthest2(double const* x, double const* y, std::array<double, 3> const& half_edges) const;

  AnyEnsemble const& ensemble_;
  Box const& box_;
  double distance2_;
  std::array<std::size_t, 3> cells_{1, 1, 1};
  std::vector<std::size_t> first_, next_;
};

/// The blocks of a box in which there may still be a free place. They are refined, and blocks that a particle covers
/// are removed. A free place drawn in them has a uniform distribution over all free places (J.-S. Wang, Int. J. Mod.
/// Phys. C 5, 707 (1994)).
class FreeBlocks {
 public:
  FreeBlocks(Box const& box, PlacedParticles const& placed, double distance, std::size_t particles);

  /// A free place for which `there` is true; false: there is none left, or none was found among very many blocks.
  bool draw(Stream& stream, std::function<bool(double const*)> const& there, double* x);

 private:
  using Block = std::array<double, 3>;  // its middle
  void halve();

  Box const& box_;
  PlacedParticles const& placed_;
  std::array<double, 3> half_edges_{0, 0, 0};
  std::size_t max_blocks_;
  std::vector<Block> blocks_;
  std::size_t missed_ = 0;  // since the last refinement
};

/// The saturation of random sequential addition of rods, discs or spheres, as a fraction of space: 0.7476 (A. Renyi,
/// 1958), 0.547 and 0.384 (S. Torquato, O. U. Uche and F. H. Stillinger, Phys. Rev. E 74, 061308 (2006)).
double saturation(int dimension);
/// Length, area or volume of a rod, a disc or a sphere of this diameter.
double ball_volume(int dimension, double diameter);

}  // namespace boltzmann
