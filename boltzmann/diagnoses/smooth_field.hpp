// Smooth fields: numbers of particles as twice differentiable functions of space (Eq 4, 5 and 9 of Hoover and Hoover's
// SPAM). For any class of particles, including atoms.
#pragma once

#include <boltzmann/boundaries/images.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/diagnoses/derived.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/laws/weight.hpp>
#include <boltzmann/neighbours/cells.hpp>
#include <boltzmann/schemes/mesh/mesh_field.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

/// The smoothing of particles.
struct Smoothing {
  WeightShape shape = WeightShape::lucy;
  double range = 0;  ///< of every particle; 0: each particle's own, the field "range" of its class
};

/// A range for particles that have none: 3 spacings in 1D, 2.5 in 2D, 2 in 3D (6, 20 and 34 particles in it), where the
/// spacing is that of the same number of particles spread evenly over the box. Error if there are no particles.
double fitting_range(Ensembles of, Box const& box);

/// The derivatives of a field to compute besides its value.
enum class Derivatives { none, first, second };

/// A field at points: one value for each, and the requested derivatives.
struct FieldValues {
  std::vector<double> value;
  std::vector<double> gradient;  ///< D numbers for each point
  std::vector<double> hessian;   ///< D x D for each point, row by row; symmetric
};

/// One number for each particle, the input of a field.
struct SmoothColumn {
  std::vector<double> values;  ///< ensemble after ensemble
  /// The number of a particle's image beyond these walls, as a function of the particle's own number. Null: the same.
  std::function<double(double own, std::size_t particle, Turns const& walls)> image = {};
};

/// The particles of an ensemble, or of several, spread over space by a weight w: with their masses m (1 each in a class
/// without mass)
///   density  rho(r) = Sum m_j w(|r - r_j|)                    (Eq 4)
///   value    f(r)   = Sum m_j f_j w(|r - r_j|) / rho(r)       (Eq 5)
/// and their exact first and second derivatives. Where no particle is near, the density is 0 and every other field NaN.
/// All images along periodic axes are included. So are those beyond mirror walls, with the velocity and the temperature
/// that the wall gives them (Wall); at points beyond walls there is nothing. Particles whose position is not finite are
/// ignored.
///
/// Points are D coordinates each, one point after the other. Fields are sums over the neighbours of a point in a fixed
/// order: the same bits for any number of threads.
class SmoothField {
 public:
  /// The current particles. Error if a range is not positive, a class without range should provide its own, a range is
  /// longer than an axis with walls, or the ranges are so large that there are more than 10^9 images.
  SmoothField(Ensembles of, Box const& box, Smoothing const& smoothing = {}, int threads = default_threads());

  int dimension() const { return box_.dimension(); }
  Box const& box() const { return box_; }
  /// The number of particles, and their mean range.
  std::size_t size() const { return size_; }
  double mean_range() const { return mean_range_; }

  FieldValues density(std::span<double const> points, Derivatives derivatives = Derivatives::none) const;
  /// Error if there is not one number for each particle.
  FieldValues value(std::span<double const> points, SmoothColumn const& column,
                    Derivatives derivatives = Derivatives::none) const;
  /// For a quantity by name, "density" (Eq 4) or one that quantity() accepts for every ensemble, with current values.
  /// The ensembles must still exist.
  FieldValues value(std::span<double const> points, std::string_view quantity,
                    Derivatives derivatives = Derivatives::none) const;
  /// The density and then each column, in one pass over the neighbours.
  std::vector<FieldValues> values(std::span<double const> points, std::span<SmoothColumn const> columns,
                                  Derivatives derivatives = Derivatives::none) const;

  /// A quantity on the nodes of a grid (make_grid), for drawings, field_waves and write_vti. "density", a name for
  /// quantity(), or a field with several components ("velocity").
  MeshField on_grid(MeshGrid const& grid, std::string_view quantity) const;
  /// The same for your own numbers.
  MeshField on_grid(MeshGrid const& grid, SmoothColumn const& column, std::string name, Dimension dimension) const;

  /// The meaning of a quantity's name: "density" is the mass (number, in a class without mass) per volume, others as in
  /// quantity_meaning(). Error with the existing names.
  QuantityMeaning meaning(std::string_view quantity) const;
  /// A quantity of every particle, and its values beyond walls: velocities, quantities derived from them, and
  /// temperatures as the wall defines, other vectors and tensors mirrored. Error with the existing names.
  SmoothColumn column(std::string_view quantity) const;
  /// The positions of the particles as points, for fields at the particles themselves (Eq 8).
  std::vector<double> positions() const;

 private:
  /// A particle or an image of one.
  struct Source {
    std::array<double, 3> position;
    double mass, range, inverse_range;
  };
  /// The particle of an image, and the walls that it is beyond.
  struct Origin {
    std::uint32_t particle;
    std::array<signed char, 3> walls;
  };

  template <class Shape, int D>
  void sum(double const* point, double const* const* columns, std::size_t count, Derivatives derivatives,
           double* sums) const;
  using Sum = void (SmoothField::*)(double const* point, double const* const* columns, std::size_t count,
                                    Derivatives derivatives, double* sums) const;
  Sum sum_of_weight() const;
  void collect_sources(double common_range);
  std::vector<double> of_sources(SmoothColumn const& column) const;

  Box box_;
  WeightShape shape_;
  int threads_;
  std::vector<AnyEnsemble const*> ensembles_;
  std::size_t size_ = 0;
  double largest_range_ = 0, mean_range_ = 0;
  // In the order of the cells.
  std::vector<Source> sources_;
  std::vector<Origin> origins_;
  Cells cells_;
};

/// `count` evenly spaced points from one point to another, both included; a single point is in the middle. Error for
/// less than one.
template <int D>
std::vector<double> points_on_line(Vector<D> const& from, Vector<D> const& to, std::size_t count) {
  std::vector<double> points;
  points.reserve(count * D);
  for (std::size_t i = 0; i < count; ++i)
    for (int a = 0; a < D; ++a) {
      double const t = count == 1 ? 0.5 : static_cast<double>(i) / static_cast<double>(count - 1);
      points.push_back(from[a] + t * (to[a] - from[a]));
    }
  return points;
}
/// The nodes of a grid, in their order in memory.
std::vector<double> points_on_grid(MeshGrid const& grid);

/// The integral over the box by the trapezoidal rule: nodes on the ends of axes that are not periodic have half weight.
double integral(MeshField const& field, std::size_t component = 0);

/// The least and the greatest density on a perfect lattice, one particle of mass one in each unit cell (study 3).
struct DensityExtremes {
  double least, greatest;
};
/// In 1 to 3 dimensions for a square (cubic) lattice of spacing 1. Error if the range is not above 0 and at most 20.
DensityExtremes lattice_density_extremes(int dimension, WeightShape shape, double range);

}  // namespace boltzmann
