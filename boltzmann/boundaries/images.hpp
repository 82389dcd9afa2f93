// Images: where particles are seen again, beyond periodic ends and beyond the walls of mirror axes, and what they carry
// there. Every image is composed here: those of sorted copies and of smooth fields, and what a mirror puts back.
#pragma once

#include <boltzmann/boundaries/box.hpp>

#include <algorithm>
#include <array>
#include <cmath>

namespace boltzmann {

/// Which image: by how many lengths it is moved along a periodic axis; along a mirror axis -1 and 1 for the wall at the
/// low and the high end. All 0: the particle itself. Turns along the gradient of a sheared box also slide along its flow.
using Turns = std::array<int, 3>;

/// What a number of a particle is in an image: sign * x + shift; as it stands, a zero's sign included, unless said
/// otherwise.
struct ImageMap {
  double sign = 1, shift = -0.0;
  double operator()(double x) const { return sign * x + shift; }
};

/// How a number of a particle is found in its image beyond a wall. Along a periodic axis images differ in `position`
/// alone, along the gradient of a sheared box in `position` and `velocity`.
enum class ImageRule : unsigned char {
  same,           ///< as it is: mass, density, the temperature's history, ...
  position,       ///< reflected about the wall
  velocity,       ///< as the wall says (Wall::slips, Wall::velocity)
  displacement,   ///< that of a particle which the wall reflects so: as `velocity` at a wall at rest
  temperature,    ///< as the wall says (Wall::temperature)
  normal_vector,  ///< a reflected vector: its component along the wall's normal changes sign (grad of what is `same`)
  heat_flux,  ///< of such a temperature: at an insulated wall as normal_vector; at a wall of given temperature, about
              ///< which the image's is odd, the components along the wall change sign
  tensor,     ///< pressure or stress of such velocities: reflected at a wall that slips; even, as it is, at one that
              ///< does not
};
/// The rule for one number of a row, and which component of a vector, or which two of a tensor, it is.
struct ImageComponent {
  ImageRule rule = ImageRule::same;
  int axis = 0, axis2 = 0;
};

/// What this number is in that image, for walls as they are now. Beyond several walls the images are composed; where
/// these walls differ, so that the order would matter, it is the mean of all orders.
ImageMap image_map(Box const& box, ImageComponent component, Turns const& turns);
/// The same for turns along the flow of a sheared box that were counted when so much of its slide was whole lengths
/// (Box::whole_slide()).
ImageMap image_map(Box const& box, ImageComponent component, Turns const& turns, double whole_slide);

/// Where the images of positions are, for ends and walls that stand, or stood, at these edges, and images that slide, or
/// slid, by so much (Box::slide_in_lattice()).
class Images {
 public:
  explicit Images(Box const& box) : Images(box, box.edges(), box.slide_in_lattice()) {}
  Images(Box const& box, Box::Edges const& edges, double slide) : box_(&box), edges_(edges), slide_(slide) {}

  /// The most turns along this axis of images within `reach` of the box.
  int most(int axis, double reach) const;
  /// Whether there can be such an image within `reach` of the box; there is none beyond a wall that was opened.
  bool exists(Turns const& turns, double reach) const;
  /// From which turns to which along this axis images of a coordinate, inside if it is periodic, are within `reach` of
  /// the box: most have none. Not of a sheared box.
  struct Range {
    int first = 0, last = 0;
  };
  Range turns_within(int axis, double reach, double x) const {
    bool const inside = x > edges_[axis] + reach && x < edges_[3 + axis] - reach;
    return inside ? Range{} : turns_near_end(axis, reach, x);
  }
  /// The coordinate of an image, by the turns along this axis alone.
  double at(int axis, int turns, double x) const;
  /// And by all turns.
  double at(int axis, Turns const& turns, double x) const {
    double const plain = at(axis, turns[axis], x);
    Shear const& shear = box_->shear();
    return slide_ != 0 && axis == shear.flow ? plain + turns[shear.gradient] * slide_ : plain;
  }
  /// Calls function(turns, position) for every image of x, itself included, within reach of the box; x is inside
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
  if (box_->periodic(axis) && length > 2.1 * reach) {  // one image at most, whatever is rounded
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

/// The gradient before the flow, along which images begin where the slide has brought them.
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
