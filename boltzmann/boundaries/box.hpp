// The space of a simulation: a box with a boundary kind per axis, mirror walls (which may move), sheared periodic
// images, and regions installed inside it (sections 4.1, 4.2).
#pragma once

#include <boltzmann/core/unit_system.hpp>
#include <boltzmann/core/vector.hpp>
#include <boltzmann/core/words.hpp>

#include <array>
#include <cstdint>
#include <limits>
#include <string>
#include <type_traits>
#include <vector>

namespace boltzmann {

class AnyEnsemble;
class Division;

/// The treatment of the two ends of an axis.
enum class Boundary {
  open,        ///< particles leave freely
  reflecting,  ///< elastic reflection
  periodic,    ///< what leaves on one side enters on the other
  mirror,      ///< every particle has an image beyond its walls (see Wall)
};

Words<Boundary> const& boundary_words();
std::string to_string(Boundary boundary);

/// A wall at one end of an axis. On a mirror axis it defines the image beyond the wall of a particle with velocity v
/// and temperature T. On a reflecting axis it defines the particle after its reflection. Such walls slip and are
/// insulated, so that only the velocity along the normal matters (a piston, or a momentum mirror).
struct Wall {
  /// The image's velocity is 2 u - v along the wall's normal, where u is the velocity of the wall. Along the wall it is
  /// v if particles slip, else also 2 u - v: then matter at the wall moves with it.
  bool slips = true;
  /// Velocity of the wall. Its component along the normal makes a piston: the wall is at edge + velocity * time.
  std::array<double, 3> velocity{};
  /// Temperature of the wall: the image has 2 temperature - T. NaN: an insulated wall, the image has T.
  double temperature = std::numeric_limits<double>::quiet_NaN();
};

/// Plane Couette flow without walls. Along the gradient the images of a periodic box slide past each other: a particle
/// that leaves at one end enters at the other with the velocity of the flow there (A. W. Lees and S. F. Edwards, J.
/// Phys. C 5, 1921 (1972)). The flow is rate * (y - y0) along `flow`, y along `gradient` and y0 the box's middle.
struct Shear {
  double rate = 0;  ///< per time; 0: none
  int flow = 0, gradient = 1;
  /// If true, every particle gets at the start of a run the local velocity of the flow on top of its own (after
  /// Simulation::equilibrate). If false, the images start to move and accelerate the flow. In both cases the common
  /// velocity of all particles along flow and gradient is subtracted before.
  bool established = true;
};

/// An axis-aligned block inside the space whose faces reflect particles elastically.
struct Region {
  enum class Side { keep_out, keep_in };
  std::array<double, 3> low, high;
  Side side;
};

class Box {
 public:
  enum class End { low, high };
  /// Low x y z, high x y z.
  using Edges = std::array<double, 6>;

  /// A box from `low` to `high` with the same boundary kind on every axis, or one kind per axis:
  ///   Box({0, 0}, {side, side}, Boundary::periodic)
  /// Error if low is not below high on some axis, or an edge is not finite.
  template <std::size_t D>
  Box(double const (&low)[D], double const (&high)[D], Boundary boundary = Boundary::open)
      : Box(D, widen(std::to_array(low)), widen(std::to_array(high)), {boundary, boundary, boundary}) {}
  template <std::size_t D>
  Box(double const (&low)[D], double const (&high)[D], std::type_identity_t<std::array<Boundary, D>> const& boundaries)
      : Box(D, widen(std::to_array(low)), widen(std::to_array(high)), widen(boundaries, Boundary::open)) {}
  /// The same for code that is generic in the dimension.
  template <int D>
  Box(Vector<D> const& low, Vector<D> const& high, Boundary boundary = Boundary::open)
      : Box(D, widen(low), widen(high), {boundary, boundary, boundary}) {}
  template <int D>
  Box(Vector<D> const& low, Vector<D> const& high, std::type_identity_t<std::array<Boundary, D>> const& boundaries)
      : Box(D, widen(low), widen(high), widen(boundaries, Boundary::open)) {}
  Box(int dimension, std::array<double, 3> low, std::array<double, 3> high, std::array<Boundary, 3> boundaries);

  int dimension() const { return dimension_; }
  double low(int axis) const { return low_[axis]; }
  double high(int axis) const { return high_[axis]; }
  double length(int axis) const { return high_[axis] - low_[axis]; }
  /// Edges at the current positions of walls; 0 for axes beyond the box's dimension.
  Edges edges() const;
  /// Sets the edges, to stretch the box. Error if low is not below high, an edge is not finite, or a wall on such an
  /// axis moves.
  void edges(Edges const& edges);
  Boundary boundary(int axis) const { return boundaries_[axis]; }
  bool periodic(int axis) const { return boundaries_[axis] == Boundary::periodic; }
  bool any_periodic() const;
  bool all_open() const { return all_open_; }
  /// Length, area or volume of the box (at the current positions of walls).
  double volume() const;

  /// True if there is a wall at this end: at both ends of a mirror or reflecting axis, unless one was opened.
  bool walled(int axis, End end) const { return walled_[axis][static_cast<int>(end)]; }
  using Walled = std::array<std::array<bool, 2>, 3>;  ///< at the low and at the high end of each axis
  Walled const& walled() const { return walled_; }
  /// True if some wall has images beyond it (that of a mirror axis).
  bool any_wall() const { return any_wall_; }
  /// The wall at this end. Error if there is none.
  Wall const& wall(int axis, End end) const;
  /// Sets this wall (and closes the end if it was open). Before, a wall slips, is at rest and is insulated. Error if
  /// the axis is neither mirror nor reflecting, or the wall's velocity or temperature is infinite (or its velocity
  /// NaN), or a wall of a reflecting axis does not slip, has a temperature or moves along itself.
  void wall(int axis, End end, Wall const& wall);
  /// Removes the wall: particles leave freely at this end, and have no images beyond it. Error if the axis is neither
  /// mirror nor reflecting, or no wall would be left.
  void open_end(int axis, End end);
  /// True if some wall moves along its normal.
  bool walls_move() const { return walls_move_; }
  /// Moves walls to their positions at this time since the start of the run, edge + velocity * time, and the images of
  /// a sheared box likewise. low(), high(), length() and volume() follow. Does nothing while walls are held.
  /// PhysicsFailure if a wall meets the other end of its axis.
  void move_walls(double time);

  /// Shears the box from now on. Error unless it has two or three dimensions, both axes are different periodic ones, no
  /// axis is a mirror, there are no regions, and the rate is finite.
  void shear(Shear const& shear);
  Shear const& shear() const { return shear_; }
  bool sheared() const { return shear_.rate != 0; }
  /// Displacement along the flow of an image one length up the gradient, not reduced to the cell: rate * length * time.
  double slide() const { return slide_; }
  /// The same, reduced by whole lengths of the flow's axis to at most half a length.
  double slide_in_lattice() const { return slide_ - whole_slide(); }
  /// These whole lengths, of the current slide or of a given one.
  double whole_slide() const { return whole_slide(slide_); }
  double whole_slide(double slide) const;
  /// The velocity of that image relative to its particle, along the flow: rate * length; 0 while the box is held.
  double slide_velocity() const { return held_ ? 0 : shear_.rate * length(shear_.gradient); }
  /// The velocity of the flow at a position, along Shear::flow; 0 while the box is held.
  double flow_velocity(double const* position) const {
    int const g = shear_.gradient;
    return held_ ? 0 : shear_.rate * (position[g] - 0.5 * (low_[g] + high_[g]));
  }

  /// True if any property of the box depends on time.
  bool moves() const { return walls_move_ || sheared(); }
  /// While held, walls and images are at rest, and walls reflect as walls at rest. Used to bring a body to a
  /// temperature before its run.
  void hold_walls(bool held) {
    held_ = held;
    revision_ = new_revision();
  }
  /// Identifies the current state of the box: it differs after each change, and between boxes that are no copies.
  std::uint64_t revision() const { return revision_; }

  /// A component of the wall's velocity; 0 while walls are held.
  double wall_velocity(int axis, End end, int component) const {
    return held_ ? 0 : walls_[axis][static_cast<int>(end)].velocity[component];
  }

  /// Units used in error messages; before, messages have plain numbers.
  void speak_in(UnitSystem const& units) { units_ = units; }
  UnitSystem const& spoken_units() const { return units_; }

  /// Installs a region. Error if it is not a block of this space.
  void install(Region const& region);
  template <int D>
  void install(Vector<D> const& low, Vector<D> const& high, Region::Side side) {
    check_dimension(D);
    install(Region{widen(low), widen(high), side});
  }
  std::vector<Region> const& regions() const { return regions_; }

  /// Throws Error for the first particle that is not finite, outside a reflecting axis, beyond a wall, or on the wrong
  /// side of a region.
  void check(AnyEnsemble const& particles) const;

  /// The coordinate moved by whole lengths of a periodic axis to where low <= x < high.
  double wrapped(double x, int axis) const;
  /// Wraps every particle into the box along periodic axes, however far outside it is; for the start of a run. A
  /// particle beyond an end of a sheared box's gradient is replaced by its image, velocity included.
  void wrap(AnyEnsemble& particles) const;

  /// Brings every particle that has left the box back. Periodic axes wrap (a sheared one as in Shear), reflecting axes
  /// and regions reflect position and velocity. Beyond a mirror's wall a particle is replaced by its image (position
  /// and velocity). A moving wall of a reflecting axis reflects in its own frame: x -> 2 X - x and v -> 2 u - v, X its
  /// current position. A particle that already moves away from the wall keeps its velocity. PhysicsFailure if a
  /// particle has moved so far that one reflection does not bring it back, or is not finite. Returns the work that
  /// moving walls of reflecting axes have done on the particles (zero for classes without mass), the same bits for any
  /// number of threads. In a run that is divided over ranks only this rank's particles are moved; the work is that on
  /// all.
  double apply(AnyEnsemble& particles, int threads = 1, Division* division = nullptr) const;

  /// Rounds every edge to a multiple of `quantum`, for the fixed-point grid of the reversible leap-frog. Error if walls
  /// move.
  void on_grid(double quantum);

  /// The shortest vector between periodic images, in place: `d` has dimension() components. In a sheared box it is the
  /// shortest only if it is shorter than half of both axes' lengths; else a vector between some images.
  void nearest_image(double* d) const;

 private:
  class Reflection;

  UnitSystem units_ = UnitSystem::reduced();

  template <int D>
  static std::array<double, 3> widen(Vector<D> const& a) {
    return widen(std::to_array(a.component));
  }
  template <class T, std::size_t D>
  static std::array<T, 3> widen(std::array<T, D> const& a, T rest = {}) {
    static_assert(D <= 3, "a box has one, two or three dimensions");
    std::array<T, 3> wide{rest, rest, rest};
    for (std::size_t i = 0; i < D; ++i) wide[i] = a[i];
    return wide;
  }

  void check_dimension(int of_region) const;
  void check_has_walls(int axis) const;
  void find_moving_walls();
  void wrap_gradient(AnyEnsemble& particles) const;
  static std::uint64_t new_revision();

  int dimension_;
  std::array<double, 3> low_, high_;
  std::array<double, 3> first_low_, first_high_;  // at time 0
  std::array<Boundary, 3> boundaries_;
  bool all_open_, any_wall_ = false, walls_move_ = false, held_ = false;
  double time_ = 0;  // for which walls and images were last moved
  Shear shear_;
  double slide_ = 0;
  bool backwards_ = false;  // time went backwards then
  Walled walled_{};
  std::array<std::array<Wall, 2>, 3> walls_{};
  std::vector<Region> regions_;
  std::uint64_t revision_ = new_revision();
};

}  // namespace boltzmann
