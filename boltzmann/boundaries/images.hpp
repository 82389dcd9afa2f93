// Images: the positions of particles beyond periodic ends and beyond walls of mirror axes, and the numbers that they
// carry there. All images are composed here: those of sorted copies and of smooth fields, and the particles that a
// mirror replaces.
#pragma once

#include <boltzmann/boundaries/box.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {

/// Image index: the number of lengths by which an image is shifted along a periodic axis; along a mirror axis -1 and 1
/// for the wall at the low and the high end. All 0: the particle itself. A shift along the gradient of a sheared box
/// also slides the image along its flow.
using Turns = std::array<int, 3>;

/// The value of a number in an image: sign * x + shift. By default the number itself, including the sign of zero.
struct ImageMap {
  double sign = 1, shift = -0.0;
  double operator()(double x) const { return sign * x + shift; }
};

/// The transformation of a number in the image beyond a wall. Along a periodic axis only `position` changes, along the
/// gradient of a sheared box `position` and `velocity`.
enum class ImageRule : unsigned char {
  same,           ///< unchanged: mass, density, the temperature's history, ...
  position,       ///< reflected about the wall
  velocity,       ///< as defined by the wall (Wall::slips, Wall::velocity)
  displacement,   ///< of a particle with such an image: as `velocity` at a wall at rest
  temperature,    ///< as defined by the wall (Wall::temperature)
  normal_vector,  ///< a reflected vector: its component along the wall's normal changes sign (the gradient of a `same`
                  ///< number)
  heat_flux,  ///< of such a temperature: at an insulated wall as normal_vector; at a wall of given temperature, about
              ///< which temperature is odd, the components along the wall change sign
  tensor,     ///< pressure or stress of such velocities: reflected at a wall that slips, unchanged at one that does not
};
/// The rule of one number of a row, and its component of a vector, or its two indices of a tensor.
struct ImageComponent {
  ImageRule rule = ImageRule::same;
  int axis = 0, axis2 = 0;
};

/// The map of this number to an image, for the current walls. Beyond several walls the images are composed. If these
/// walls differ, so that the order matters, it is the mean over all orders.
ImageMap image_map(Box const& box, ImageComponent component, Turns const& turns);
/// The same, for turns along the flow of a sheared box that were counted at a slide with these whole lengths
/// (Box::whole_slide()).
ImageMap image_map(Box const& box, ImageComponent component, Turns const& turns, double whole_slide);

/// The positions of images, for given edges of ends and walls and a given slide (Box::slide_in_lattice()), which may be
/// those of an earlier time.
class Images {
 public:
  explicit Images(Box const& box) : Images(box, box.edges(), box.slide_in_lattice()) {}
  Images(Box const& box, Box::Edges const& edges, double slide) : box_(&box), edges_(edges), slide_(slide) {}

  /// The largest image index along this axis within `reach` of the box.
  int most(int axis, double reach) const;
  /// True if there can be such an image within `reach` of the box; there is none beyond an end that was opened.
  bool exists(Turns const& turns, double reach) const;
  /// The range of image indices along this axis for which the image of a coordinate, inside if the axis is periodic, is
  /// within `reach` of the box; mostly empty. Not for a sheared box.
  struct Range {
    int first = 0, last = 0;
  };
  Range turns_within(int axis, double reach, double x) const {
    bool const inside = x > edges_[axis] + reach && x < edges_[3 + axis] - reach;
    return inside ? Range{} : turns_near_end(axis, reach, x);
  }
  /// The coordinate of an image by its index along this axis alone.
  double at(int axis, int turns, double x) const;
  /// The coordinate by all indices.
  double at(int axis, Turns const& turns, double x) const {
    double const plain = at(axis, turns[axis], x);
    Shear const& shear = box_->shear();
    return slide_ != 0 && axis == shear.flow ? plain + turns[shear.gradient] * slide_ : plain;
  }
  /// Calls function(turns, position) for every image of x within reach of the box, including x itself; x must be inside
  /// periodic axes.
  template <class Function>
  void each(double const* x, double reach, Function const& function) const;

 private:
  bool mirrors(int axis, Box::End end) const {
    return box_->boundary(axis) == Boundary::mirror && box_->walled(axis, end);
  }

  Range turns_near_end(int axis, double reach, double x) const;
  template <class Function>
  void each_sheared(double const* x, double reach, Function const& function) const;

  Box const* box_;
  Box::Edges edges_;
  double slide_;
};

inline double Images::at(int axis, int turns, double x) const {
  double const low = edges_[axis], high = edges_[3 + axis];
  if (turns == 0) return x;
  return box_->periodic(axis) ? x + turns * (high - low) : 2 * (turns < 0 ? low : high) - x;
}

inline Images::Range Images::turns_near_end(int axis, double reach, double x) const {
  double const low = edges_[axis], high = edges_[3 + axis];
  double const length = high - low, least = low - reach, greatest = high + reach;
  auto const is_near = [&](int n) {
    double const there = at(axis, n, x);
    return there >= least && there <= greatest;
  };
  Range range;
  if (box_->periodic(axis) && length > 2.1 * reach) {  // at most one image, for any rounding
    if (x - length >= least) return {-1, 0};
    if (x + length <= greatest) return {0, 1};
  } else if (box_->periodic(axis)) {
    auto const may_be = [&](int turns) { return turns == 1 || turns <= most(axis, reach); };
    while (is_near(range.first - 1) && may_be(1 - range.first)) --range.first;
    while (is_near(range.last + 1) && may_be(1 + range.last)) ++range.last;
  } else {
    if (x <= low + reach && mirrors(axis, Box::End::low) && is_near(-1)) range.first = -1;
    if (x >= high - reach && mirrors(axis, Box::End::high) && is_near(1)) range.last = 1;
  }
  return range;
}

template <class Function>
void Images::each(double const* x, double reach, Function const& function) const {
  if (box_->sheared()) return each_sheared(x, reach, function);
  std::array<Range, 3> ranges;
  Turns turns{};
  std::array<double, 3> position{};
  int const dimension = box_->dimension();
  bool any = false;
  for (int a = 0; a < dimension; ++a) {
    position[a] = x[a];
    ranges[a] = turns_within(a, reach, x[a]);
    any = any || ranges[a].first != ranges[a].last;
  }
  if (!any) return function(turns, position);
  auto const turn = [&](int a, int n) {
    turns[a] = n;
    if (a < dimension) position[a] = at(a, n, x[a]);
  };
  for (int k = ranges[2].first; k <= ranges[2].last; ++k) {
    turn(2, k);
    for (int j = ranges[1].first; j <= ranges[1].last; ++j) {
      turn(1, j);
      for (int i = ranges[0].first; i <= ranges[0].last; ++i) {
        turn(0, i);
        function(turns, position);
      }
    }
  }
}

/// The gradient before the flow, as the slide shifts the images along the flow.
template <class Function>
void Images::each_sheared(double const* x, double reach, Function const& function) const {
  int const g = box_->shear().gradient, f = box_->shear().flow, other = 3 - g - f;
  auto const range = [&](int a, double from) {
    double const low = edges_[a], high = edges_[3 + a];
    if (a >= box_->dimension() || !box_->periodic(a)) return std::array{0, 0};
    int const most = this->most(a, reach);
    return std::array{std::max(-most, static_cast<int>(std::ceil((low - reach - from) / (high - low)))),
                      std::min(most, static_cast<int>(std::floor((high + reach - from) / (high - low))))};
  };
  Turns turns{};
  std::array<double, 3> position{};
  auto const [first, last] = range(g, x[g]);
  auto const [first_other, last_other] = range(other, box_->dimension() == 3 ? x[other] : 0);
  for (turns[g] = first; turns[g] <= last; ++turns[g]) {
    position[g] = at(g, turns[g], x[g]);
    auto const [first_along, last_along] = range(f, x[f] + turns[g] * slide_);
    for (turns[other] = first_other; turns[other] <= last_other; ++turns[other]) {
      if (box_->dimension() == 3) position[other] = at(other, turns[other], x[other]);
      for (turns[f] = first_along; turns[f] <= last_along; ++turns[f]) {
        position[f] = at(f, turns, x[f]);
        function(turns, position);
      }
    }
  }
}

}  // namespace boltzmann
