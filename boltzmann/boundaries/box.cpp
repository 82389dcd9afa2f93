// Wrapping, reflecting and mirroring; positions of moving walls; errors for particles at invalid positions.
#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/boundaries/far_from_box.hpp>
#include <boltzmann/boundaries/flow_images.hpp>
#include <boltzmann/boundaries/images.hpp>
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/exact_sum.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/particles/division.hpp>
#include <boltzmann/particles/ensemble.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <atomic>
#include <cmath>
#include <limits>
#include <vector>

namespace boltzmann {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();
constexpr std::size_t grain = 2048;  // particles

std::string who(AnyEnsemble const& particles, std::size_t i) {
  return fmt::format("particle {} of '{}'", i, particles.name());
}

bool inside(Region const& region, int dimension, double const* x) {
  for (int a = 0; a < dimension; ++a)
    if (!(x[a] >= region.low[a] && x[a] <= region.high[a])) return false;
  return true;
}

bool strictly_inside(Region const& region, int dimension, double const* x) {
  for (int a = 0; a < dimension; ++a)
    if (!(x[a] > region.low[a] && x[a] < region.high[a])) return false;
  return true;
}

void reflect(double wall, double* x, double* v) {
  *x = 2 * wall - *x;
  if (v) *v = -*v;
}

constexpr std::array<Box::End, 2> both_ends{Box::End::low, Box::End::high};
char const* word(Box::End end) { return end == Box::End::low ? "low" : "high"; }

}  // namespace

Words<Boundary> const& boundary_words() {
  static Words<Boundary> const all{
      "boundary",
      {{Boundary::open, "open", "particles leave freely"},
       {Boundary::reflecting, "reflecting", "elastic walls"},
       {Boundary::periodic, "periodic", "particles that leave on one side enter on the other"},
       {Boundary::mirror, "mirror", "mirror images beyond each wall: walls of smooth particles and of vortices"}}};
  return all;
}
std::string to_string(Boundary boundary) { return boundary_words().name(boundary); }

Box::Box(int dimension, std::array<double, 3> low, std::array<double, 3> high, std::array<Boundary, 3> boundaries)
    : dimension_(dimension),
      low_(low),
      high_(high),
      first_low_(low),
      first_high_(high),
      boundaries_(boundaries),
      all_open_(true) {
  if (dimension < 1 || dimension > 3) throw Error(fmt::format("a box has 1, 2 or 3 dimensions, not {}", dimension));
  for (int a = 0; a < dimension; ++a) {
    if (!std::isfinite(low[a]) || !std::isfinite(high[a]) || !(low[a] < high[a]))
      throw Error(
          fmt::format("box: on axis {} the low edge {} is not below the high edge {}", "xyz"[a], low[a], high[a]));
    if (boundaries[a] != Boundary::open) all_open_ = false;
    bool const mirror = boundaries[a] == Boundary::mirror;
    if (mirror) any_wall_ = true;
    if (mirror || boundaries[a] == Boundary::reflecting) walled_[a] = {true, true};
  }
}

bool Box::any_periodic() const {
  for (int a = 0; a < dimension_; ++a)
    if (periodic(a)) return true;
  return false;
}

Box::Edges Box::edges() const {
  Edges edges{};
  std::copy_n(low_.begin(), dimension_, edges.begin());
  std::copy_n(high_.begin(), dimension_, edges.begin() + 3);
  return edges;
}

void Box::edges(Edges const& edges) {
  for (int a = 0; a < dimension_; ++a) {
    double const low = edges[a], high = edges[3 + a];
    if (low == low_[a] && high == high_[a]) continue;
    if (!std::isfinite(low) || !std::isfinite(high) || !(low < high))
      throw Error(fmt::format("box: on axis {} the low edge {} is not below the high edge {}", "xyz"[a], low, high));
    if (walls_move_ && !periodic(a)) throw Error("box: an axis whose walls move is not stretched");
    if (sheared()) throw Error("box: one that is sheared is not stretched");
    low_[a] = first_low_[a] = low;
    high_[a] = first_high_[a] = high;
    revision_ = new_revision();
  }
}

double Box::volume() const {
  double product = 1;
  for (int a = 0; a < dimension_; ++a) product *= length(a);
  return product;
}

void Box::check_has_walls(int axis) const {
  if (axis < 0 || axis >= dimension_)
    throw Error(fmt::format("wall: a box of {} dimensions has no axis number {}", dimension_, axis));
  if (boundaries_[axis] != Boundary::mirror && boundaries_[axis] != Boundary::reflecting)
    throw Error(fmt::format("wall: axis {} is {}; only reflecting and mirror axes have walls", "xyz"[axis],
                            to_string(boundaries_[axis])));
}

Wall const& Box::wall(int axis, End end) const {
  check_has_walls(axis);
  if (!walled(axis, end))
    throw Error(fmt::format("wall: the {} end of axis {} is open, there is no wall", word(end), "xyz"[axis]));
  return walls_[axis][static_cast<int>(end)];
}

void Box::wall(int axis, End end, Wall const& wall) {
  check_has_walls(axis);
  for (double const u : wall.velocity)
    if (!std::isfinite(u))
      throw Error(
          fmt::format("wall: the velocity of the {} wall of axis {} is not finite: {}", word(end), "xyz"[axis], u));
  if (std::isinf(wall.temperature))
    throw Error(fmt::format("wall: the temperature of the {} wall of axis {} is not finite: {}", word(end), "xyz"[axis],
                            wall.temperature));
  if (boundaries_[axis] == Boundary::reflecting) {
    auto const refused = [&](char const* what) {
      return Error(
          fmt::format("wall: the {} wall of axis {} {}: on a reflecting axis walls slip and are insulated; what "
                      "drags or heats is the wall of a mirror axis",
                      word(end), "xyz"[axis], what));
    };
    if (!wall.slips) throw refused("does not slip");
    if (!std::isnan(wall.temperature)) throw refused("has a temperature");
    for (int a = 0; a < 3; ++a)
      if (a != axis && wall.velocity[a] != 0) throw refused("moves along itself");
  }
  walls_[axis][static_cast<int>(end)] = wall;
  walled_[axis][static_cast<int>(end)] = true;
  find_moving_walls();
}

void Box::open_end(int axis, End end) {
  check_has_walls(axis);
  auto& walled = walled_[axis];
  if (!walled[end == End::low ? 1 : 0])
    throw Error(fmt::format("wall: no wall would be left on axis {}; make the axis open", "xyz"[axis]));
  walled[static_cast<int>(end)] = false;
  find_moving_walls();
}

std::uint64_t Box::new_revision() {
  static std::atomic<std::uint64_t> last = 0;
  return last.fetch_add(1, std::memory_order_relaxed) + 1;
}

void Box::find_moving_walls() {
  revision_ = new_revision();
  walls_move_ = false;
  for (int a = 0; a < dimension_; ++a)
    for (End const end : both_ends)
      if (walled(a, end) && walls_[a][static_cast<int>(end)].velocity[a] != 0) walls_move_ = true;
}

void Box::shear(Shear const& shear) {
  auto const axis = [&](int a) { return a >= 0 && a < dimension_ ? std::string(1, "xyz"[a]) : std::to_string(a); };
  if (dimension_ < 2) throw Error("shear: a box of one dimension has no gradient of a flow across it");
  if (!std::isfinite(shear.rate)) throw Error(fmt::format("shear: the rate is a finite number, not {}", shear.rate));
  for (int const a : {shear.flow, shear.gradient}) {
    if (a < 0 || a >= dimension_)
      throw Error(fmt::format("shear: a box of {} dimensions has no axis number {}", dimension_, a));
    if (!periodic(a))
      throw Error(fmt::format("shear: axis {} is {}; flow and gradient of a sheared box are along periodic axes",
                              axis(a), to_string(boundaries_[a])));
  }
  if (shear.flow == shear.gradient)
    throw Error(
        fmt::format("shear: flow and gradient are both along {}; they are along different axes", axis(shear.flow)));
  for (int a = 0; a < dimension_; ++a)
    if (boundaries_[a] == Boundary::mirror)
      throw Error(fmt::format(
          "shear: axis {} is a mirror, whose images would not flow; use reflecting, periodic or open", axis(a)));
  if (!regions_.empty())
    throw Error("shear: regions do not move, but the images of a sheared box do; leave out one of them");
  shear_ = shear;
  slide_ = shear.rate * length(shear.gradient) * time_;
  revision_ = new_revision();
}

double Box::whole_slide(double slide) const {
  double const along = length(shear_.flow);
  return along * std::nearbyint(slide / along);
}

void Box::move_walls(double time) {
  if (held_) return;
  if (sheared()) {
    if (time != time_) revision_ = new_revision();
    slide_ = shear_.rate * length(shear_.gradient) * time;
    if (!walls_move_) time_ = time;
  }
  if (!walls_move_) return;
  auto low = first_low_, high = first_high_;
  for (int a = 0; a < dimension_; ++a) {
    if (walled(a, End::low)) low[a] += walls_[a][0].velocity[a] * time;
    if (walled(a, End::high)) high[a] += walls_[a][1].velocity[a] * time;
    if (!(low[a] < high[a]))
      throw PhysicsFailure(
          fmt::format("the walls of axis {} have met: at time {} the low end is at {} and the high end at {}", "xyz"[a],
                      time, low[a], high[a]));
  }
  low_ = low;
  high_ = high;
  if (time == time_) return;
  backwards_ = time < time_;
  time_ = time;
  revision_ = new_revision();
}

void Box::check_dimension(int of_region) const {
  if (of_region != dimension_)
    throw Error(fmt::format("region: it has {} dimensions, the box has {}", of_region, dimension_));
}

void Box::install(Region const& region) {
  if (sheared()) throw Error("region: regions do not move, but the images of a sheared box do; leave out one of them");
  for (int a = 0; a < dimension_; ++a)
    if (!(region.low[a] < region.high[a]) || !std::isfinite(region.low[a]) || !std::isfinite(region.high[a]))
      throw Error(fmt::format("region: on axis {} the low edge {} is not below the high edge {}", "xyz"[a],
                              region.low[a], region.high[a]));
  regions_.push_back(region);
  revision_ = new_revision();
}

void Box::check(AnyEnsemble const& particles) const {
  if (particles.dimension() != dimension_)
    throw Error(fmt::format("ensemble '{}' has {} dimensions, its box has {}", particles.name(), particles.dimension(),
                            dimension_));
  for (std::size_t i = 0; i < particles.size(); ++i) {
    double const* x = particles.row(i);
    for (std::size_t k = 0; k < particles.doubles(); ++k)
      if (!std::isfinite(x[k])) {
        for (auto const& field : particles.fields())
          if (static_cast<int>(k) >= field.offset && static_cast<int>(k) < field.offset + field.components)
            throw Error(fmt::format("{} has a {} that is not finite: {}", who(particles, i), field.name, x[k]));
        throw Error(fmt::format("{} has a field that is not finite: {}", who(particles, i), x[k]));
      }
    for (int a = 0; a < dimension_; ++a)
      if (far_from_box(*this, x[a], a))
        throw Error(fmt::format(
            "{} is too far from the box: {} = {}, more than 2^53 lengths of the periodic axis ({} to {}) away, so that "
            "rounding hides where in the box that is",
            who(particles, i), "xyz"[a], x[a], low_[a], high_[a]));
    for (int a = 0; a < dimension_; ++a)
      if ((walled(a, End::low) && x[a] < low_[a]) || (walled(a, End::high) && x[a] > high_[a]))
        throw Error(fmt::format("{} is outside the box: {} = {}, the {} axis goes from {} to {}", who(particles, i),
                                "xyz"[a], x[a], to_string(boundary(a)), low_[a], high_[a]));
    for (auto const& region : regions_) {
      if (region.side == Region::Side::keep_out && strictly_inside(region, dimension_, x))
        throw Error(fmt::format("{} is inside a region that keeps particles out", who(particles, i)));
      if (region.side == Region::Side::keep_in && !inside(region, dimension_, x))
        throw Error(fmt::format("{} is outside the region that keeps particles in", who(particles, i)));
    }
  }
}

double Box::wrapped(double x, int axis) const {
  double const low = low_[axis], high = high_[axis];
  if (x >= low && x < high) return x;
  x -= length(axis) * std::floor((x - low) / length(axis));
  return x >= low && x < high ? x : low;  // beyond the end by a rounding error
}

void Box::wrap(AnyEnsemble& particles) const {
  if (sheared()) wrap_gradient(particles);
  for (int a = 0; a < dimension_; ++a) {
    if (!periodic(a)) continue;
    for (std::size_t i = 0; i < particles.size(); ++i) {
      double& x = particles.row(i)[a];
      x = wrapped(x, a);
    }
  }
}

void Box::wrap_gradient(AnyEnsemble& particles) const {
  Field const* velocity = particles.find_field("velocity");
  if (velocity && velocity->components != dimension_) velocity = nullptr;
  int const g = shear_.gradient, f = shear_.flow;
  for (std::size_t i = 0; i < particles.size(); ++i) {
    double* const x = particles.row(i);
    double const before = x[g];
    x[g] = wrapped(before, g);
    double const turns = std::nearbyint((x[g] - before) / length(g));
    if (turns == 0) continue;
    x[f] += turns * slide_in_lattice();
    if (velocity) x[velocity->offset + f] += turns * slide_velocity();
  }
}

/// Brings back the particles of one ensemble that have left.
class Box::Reflection {
 public:
  Reflection(Box const& box, AnyEnsemble& particles)
      : box_(box), particles_(particles), low_(box.low_), high_(box.high_) {
    Field const* velocity = particles.find_field("velocity");
    if (velocity && velocity->components == box.dimension_)
      velocity_ = velocity;  // else the field belongs to a user's class and has another meaning
    Field const* vorticity = particles.find_field("vorticity");
    if (vorticity && is_vorticity(*vorticity, box.dimension_)) vorticity_ = vorticity;
    Field const* mass = particles.find_field("mass");
    if (mass && mass->components == 1) mass_ = mass;
    for (int a = 0; a < box.dimension_; ++a) {
      if (box.periodic(a)) continue;
      if (!box.walled(a, End::low)) low_[a] = -infinity;
      if (!box.walled(a, End::high)) high_[a] = infinity;
    }
  }

  /// Through the ends of a sheared box's gradient: a particle that has left is replaced by its image, which may be
  /// anywhere along the flow.
  void across_the_gradient(std::size_t begin, std::size_t end) const {
    int const g = box_.shear().gradient, f = box_.shear().flow;
    double const length = box_.length(f), slide = box_.slide_in_lattice();
    for (std::size_t i = begin; i < end; ++i) {
      double* const x = particles_.row(i);
      if (x[g] >= low_[g] && x[g] < high_[g]) continue;
      double const turns = x[g] < low_[g] ? 1 : -1;
      if (turns > 0 && x[g] + box_.length(g) >= high_[g]) {  // within a rounding error of the edge
        x[g] = low_[g];
        continue;
      }
      Turns none{};
      bring_back(i, g, none);
      if (!(x[f] >= low_[f] - length && x[f] < high_[f] + length)) fail(i, f, x[f], "box", low_[f], high_[f]);
      x[f] += turns * slide;
      x[f] -= length * std::floor((x[f] - low_[f]) / length);
      if (velocity_) x[velocity_->offset + f] += turns * box_.slide_velocity();
    }
  }

  /// At the ends of the box. `work`, unless null, accumulates the work of moving walls.
  void at_ends(std::size_t begin, std::size_t end, ExactSum* work) const {
    for (std::size_t i = begin; i < end; ++i) {
      double const* x = particles_.row(i);
      Turns mirrored{};
      for (int a = 0; a < box_.dimension_; ++a)
        if (!(x[a] >= low_[a] && x[a] < high_[a]) && box_.boundary(a) != Boundary::open)
          if (double const done = bring_back(i, a, mirrored); work) *work += done;
      if (!box_.any_wall_ || mirrored == Turns{}) continue;
      double* const v = velocity_ ? particles_.row(i) + velocity_->offset : nullptr;
      for (int c = 0; v && c < box_.dimension_; ++c) v[c] = image_map(box_, {ImageRule::velocity, c}, mirrored)(v[c]);
      double* const w = vorticity_ ? particles_.row(i) + vorticity_->offset : nullptr;
      for (int c = 0; w && c < vorticity_->components; ++c) w[c] *= vorticity_sign(box_, c, mirrored);
    }
  }

  void at_region(Region const& region, std::size_t begin, std::size_t end) const {
    for (std::size_t i = begin; i < end; ++i) {
      double* x = particles_.row(i);
      double* v = velocity_ ? x + velocity_->offset : nullptr;
      if (region.side == Region::Side::keep_in)
        keep_in(region, i, x, v);
      else if (strictly_inside(region, box_.dimension_, x))
        keep_out(region, x, v);
    }
  }

 private:
  /// `kept_in`: the box, or a region.
  [[noreturn]] void fail(std::size_t i, int a, double x, char const* kept_in, double low, double high) const {
    if (!std::isfinite(x))
      throw PhysicsFailure(fmt::format("{} has a position that is not finite", who(particles_, i)));
    Dimension const unit = particles_.fields().front().dimension;  // of the coordinate: a length, an angle
    auto const told = [&](double place) { return box_.units_.text(place, unit); };
    throw PhysicsFailure(
        fmt::format("{} escaped: {} = {} is further out of the {}, {} to {}, than one step should bring it",
                    who(particles_, i), "xyz"[a], told(x), kept_in, told(low), told(high)));
  }

  /// Returns the work done on the particle; in the frame of the wall the reflection is elastic.
  double push_off(std::size_t i, int a, End end) const {
    double const u = box_.wall_velocity(a, end, a);
    reflect(end == End::low ? box_.low_[a] : box_.high_[a], particles_.row(i) + a, nullptr);
    if (!velocity_) return 0.0;
    double& v = particles_.row(i)[velocity_->offset + a];
    double const before = v;
    if (u == 0)
      v = -v;
    else if (((end == End::low) != box_.backwards_) ? v < u : v > u)
      v = 2 * u - v;
    return u != 0 && mass_ ? 0.5 * particles_.row(i)[mass_->offset] * (v - before) * (v + before) : 0;
  }

  double bring_back(std::size_t i, int a, Turns& mirrored) const {
    double const low = box_.low_[a], high = box_.high_[a], length = high - low;
    double* x = particles_.row(i) + a;
    double const before = *x;
    double work = 0;
    if (box_.boundary(a) == Boundary::periodic) {
      // Within a rounding error of an edge the sum may be on or beyond the other edge; the coordinate is then `low`.
      if (*x < low) {
        *x += length;
        if (*x >= high) *x = low;
      } else if (*x >= high) {
        *x -= length;
        if (*x < low) *x = low;
      }
    } else if (box_.boundary(a) == Boundary::mirror) {
      if (*x != high) {
        mirrored[a] = *x < low ? -1 : 1;
        *x = Images(box_).at(a, mirrored[a], *x);
      }
    } else if (*x != high) {
      work = push_off(i, a, *x < low ? End::low : End::high);
    }
    if (!(*x >= low && *x <= high)) fail(i, a, before, "box", low, high);
    return work;
  }

  void keep_in(Region const& region, std::size_t i, double* x, double* v) const {
    for (int a = 0; a < box_.dimension_; ++a) {
      double const before = x[a];
      if (before < region.low[a])
        reflect(region.low[a], x + a, v ? v + a : nullptr);
      else if (before > region.high[a])
        reflect(region.high[a], x + a, v ? v + a : nullptr);
      if (!(x[a] >= region.low[a] && x[a] <= region.high[a]))
        fail(i, a, before, "region", region.low[a], region.high[a]);
    }
  }

  /// Reflects the particle at the face through which it has entered: the nearest one that it moves away from.
  void keep_out(Region const& region, double* x, double* v) const {
    int axis = -1;
    double wall = 0, depth = 0;
    for (int a = 0; a < box_.dimension_; ++a)
      for (double const face : {region.low[a], region.high[a]}) {
        bool const inward = v == nullptr || (face == region.low[a] ? v[a] > 0 : v[a] < 0);
        double const distance = std::abs(x[a] - face);
        if (inward && (axis < 0 || distance < depth)) axis = a, wall = face, depth = distance;
      }
    if (axis >= 0) reflect(wall, x + axis, v ? v + axis : nullptr);
  }

  Box const& box_;
  AnyEnsemble& particles_;
  Field const *velocity_ = nullptr, *vorticity_ = nullptr, *mass_ = nullptr;
  std::array<double, 3> low_, high_;  ///< limits beyond which a particle has left
};

double Box::apply(AnyEnsemble& particles, int threads, Division* division) const {
  if (all_open_ && regions_.empty()) return 0;
  Reflection const reflection(*this, particles);
  bool const walls_work = walls_move_ && !held_;
  SharedSum work;
  int const used = threads_for(particles.size(), 1, threads);
  if (sheared())
    for_share(particles, grain, used,
              [&](std::size_t begin, std::size_t end) { reflection.across_the_gradient(begin, end); });
  for_share(particles, grain, used, [&](std::size_t begin, std::size_t end) {
    if (!walls_work) return reflection.at_ends(begin, end, nullptr);
    ExactSum own;
    reflection.at_ends(begin, end, &own);
    work.add(own);
  });
  for (auto const& region : regions_)
    for_share(particles, grain, used,
              [&](std::size_t begin, std::size_t end) { reflection.at_region(region, begin, end); });
  if (division && walls_work) division->sum(work.total());
  return walls_work ? work.value() : 0;
}

void Box::on_grid(double quantum) {
  if (walls_move_)
    throw Error(
        "walls that move are not on the grid of positions of the reversible leap-frog; use leap-frog, or let them "
        "rest");
  revision_ = new_revision();
  auto const rounded = [&](double x) { return quantum * std::nearbyint(x / quantum); };
  for (int a = 0; a < dimension_; ++a) {
    for (double* edge : {&low_[a], &high_[a], &first_low_[a], &first_high_[a]}) *edge = rounded(*edge);
    for (auto& region : regions_) {
      region.low[a] = rounded(region.low[a]);
      region.high[a] = rounded(region.high[a]);
    }
  }
}

void Box::nearest_image(double* d) const {
  if (sheared()) {
    int const g = shear_.gradient;
    double const turns = std::nearbyint(d[g] / length(g));
    d[g] -= length(g) * turns;
    d[shear_.flow] -= slide_in_lattice() * turns;
  }
  for (int a = 0; a < dimension_; ++a)
    if (periodic(a)) d[a] -= length(a) * std::nearbyint(d[a] / length(a));
}

}  // namespace boltzmann
