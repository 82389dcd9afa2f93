// The space of a simulation: a box with a boundary kind per axis, and regions installed inside it (sections 4.1, 4.2).
#pragma once

#include <boltzmann/core/vector.hpp>

#include <array>
#include <string>
#include <type_traits>
#include <vector>

namespace boltzmann {

class AnyEnsemble;

/// What happens at the two ends of an axis.
enum class Boundary {
  open,      ///< particles leave freely
  bounded,   ///< elastic reflection
  periodic,  ///< what leaves on one side enters on the other
};

std::string to_string(Boundary boundary);

/// An axis-aligned block inside the space whose faces reflect particles elastically.
struct Region {
  enum class Side { keep_out, keep_in };
  std::array<double, 3> low, high;
  Side side;
};

class Box {
 public:
  /// A box from `low` to `high` with the same boundary kind on every axis, or one kind per axis.
  /// Error if low is not below high on some axis, or an edge is not finite.
  template <int D>
  Box(Vector<D> const& low, Vector<D> const& high, Boundary boundary = Boundary::open)
      : Box(D, widen(low), widen(high), {boundary, boundary, boundary}) {}
  template <int D>
  Box(Vector<D> const& low, Vector<D> const& high, std::type_identity_t<std::array<Boundary, D>> const& boundaries)
      : Box(D, widen(low), widen(high), widen(boundaries)) {}
  Box(int dimension, std::array<double, 3> low, std::array<double, 3> high, std::array<Boundary, 3> boundaries);

  int dimension() const { return dimension_; }
  double low(int axis) const { return low_[axis]; }
  double high(int axis) const { return high_[axis]; }
  double length(int axis) const { return high_[axis] - low_[axis]; }
  Boundary boundary(int axis) const { return boundaries_[axis]; }
  bool periodic(int axis) const { return boundaries_[axis] == Boundary::periodic; }
  bool any_periodic() const;
  bool all_open() const { return all_open_; }
  /// Length, area or volume of the box.
  double volume() const;

  /// Installs a region. Error if it is not a block of this space.
  void install(Region const& region);
  template <int D>
  void install(Vector<D> const& low, Vector<D> const& high, Region::Side side) {
    check_dimension(D);
    install(Region{widen(low), widen(high), side});
  }
  std::vector<Region> const& regions() const { return regions_; }

  /// Throws Error for the first particle that is not finite, is outside a bounded axis, or on the wrong side of a
  /// region.
  void check(AnyEnsemble const& particles) const;

  /// The coordinate moved by whole lengths of a periodic axis to where low <= x < high.
  double wrapped(double x, int axis) const;
  /// Puts every particle into the box along periodic axes, however far outside it is: the start of a run.
  void wrap(AnyEnsemble& particles) const;

  /// Brings every particle that has left back: periodic axes wrap, bounded axes and regions reflect position and
  /// velocity. PhysicsFailure if a particle has moved so far that one reflection does not bring it back, or is not
  /// finite.
  void apply(AnyEnsemble& particles, int threads = 1) const;

  /// Rounds every edge to a multiple of `quantum`, for the fixed-point grid of the reversible leap-frog.
  void on_grid(double quantum);

  /// The shortest vector between periodic images, in place: `d` has dimension() components.
  void nearest_image(double* d) const;

 private:
  template <int D>
  static std::array<double, 3> widen(Vector<D> const& a) {
    std::array<double, 3> wide{0, 0, 0};
    for (int i = 0; i < D; ++i) wide[i] = a[i];
    return wide;
  }
  template <std::size_t D>
  static std::array<Boundary, 3> widen(std::array<Boundary, D> const& a) {
    std::array<Boundary, 3> wide{Boundary::open, Boundary::open, Boundary::open};
    for (std::size_t i = 0; i < D; ++i) wide[i] = a[i];
    return wide;
  }

  void check_dimension(int of_region) const;

  int dimension_;
  std::array<double, 3> low_, high_;
  std::array<Boundary, 3> boundaries_;
  bool all_open_;
  std::vector<Region> regions_;
};

}  // namespace boltzmann
