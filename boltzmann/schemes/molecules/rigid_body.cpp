// Rotations of rigid bodies.
#include <boltzmann/schemes/molecules/rigid_body.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double straight = 1e-4;

/// Solves matrix x = b for x by Cramer's rule; the matrix is given by columns.
Vector<3> solved(std::array<Vector<3>, 3> const& column, Vector<3> const& b) {
  auto const across = cross(column[1], column[2]);
  double const scale = 1 / dot(column[0], across);
  return {dot(b, across) * scale, dot(column[0], cross(b, column[2])) * scale,
          dot(column[0], cross(column[1], b)) * scale};
}

/// Axes of a frame with the first of these vectors along x, and the second in the plane of x and y.
std::array<Vector<3>, 3> frame_along(Vector<3> const& first, Vector<3> const& second) {
  Vector<3> const x = first * (1 / magnitude(first)), across = second - x * dot(x, second);
  Vector<3> const y = across * (1 / magnitude(across));
  return {x, y, cross(x, y)};
}

/// A fixed choice of a direction perpendicular to this one, for the frame of a line.
Vector<3> any_across(Vector<3> const& line) {
  std::size_t least = 0;
  for (std::size_t a = 1; a < 3; ++a)
    if (std::abs(line[a]) < std::abs(line[least])) least = a;
  Vector<3> axis{0, 0, 0};
  axis[least] = 1;
  return axis;
}

/// The frame spanned by three particles of a body. In two dimensions the third axis is the normal of the plane.
std::array<Vector<3>, 3> frame_of(RigidShape const& shape, std::span<Vector<3> const> places, int dimension) {
  Vector<3> const first = places[shape.along] - places[0];
  if (shape.line) return frame_along(first, any_across(first));
  if (dimension == 2) return frame_along(first, cross(Vector<3>{0, 0, 1}, first));
  return frame_along(first, places[shape.beside] - places[0]);
}

}  // namespace

Vector<3> product(SymmetricMatrix const& m, Vector<3> const& x) {
  return {m[0] * x[0] + m[3] * x[1] + m[4] * x[2], m[3] * x[0] + m[1] * x[1] + m[5] * x[2],
          m[4] * x[0] + m[5] * x[1] + m[2] * x[2]};
}

int freedom_of_body(int dimension, bool line) { return dimension == 3 ? (line ? 5 : 6) : dimension == 2 ? 3 : 1; }

RigidShape shape_of(std::span<Vector<3> const> places, int dimension) {
  RigidShape shape;
  auto const farthest = [&](auto const& distance) {
    std::size_t best = 1;
    for (std::size_t i = 2; i < places.size(); ++i)
      if (distance(i) > distance(best)) best = i;
    return best;
  };
  auto const from_first = [&](std::size_t i) { return places[i] - places[0]; };
  shape.along = farthest([&](std::size_t i) { return magnitude(from_first(i)); });
  Vector<3> const line = from_first(shape.along);
  auto const off_line = [&](std::size_t i) { return magnitude(cross(line, from_first(i))) / dot(line, line); };
  shape.beside = farthest(off_line);
  shape.line = !(off_line(shape.beside) > straight);
  auto const frame = frame_of(shape, places, dimension);
  for (std::size_t i = 0; i < places.size(); ++i) {
    Vector<3> in_frame{0, 0, 0};
    for (std::size_t a = 0; a < (shape.line ? 1U : 3U); ++a) in_frame[a] = dot(frame[a], from_first(i));
    shape.places.push_back(in_frame);
  }
  return shape;
}

void turn_as(RigidShape const& shape, std::span<Vector<3> const> places, std::span<double const> masses, int dimension,
             std::span<Vector<3>> arms) {
  auto const frame = frame_of(shape, places, dimension);
  Vector<3> centre{0, 0, 0};
  double mass = 0;
  for (std::size_t i = 0; i < arms.size(); ++i) {
    Vector<3> const& at = shape.places[i];
    arms[i] = frame[0] * at[0] + frame[1] * at[1] + frame[2] * at[2];
    centre += arms[i] * masses[i];
    mass += masses[i];
  }
  centre *= 1 / mass;
  for (auto& arm : arms) arm -= centre;
}

SymmetricMatrix inertia_of(std::span<Vector<3> const> arms, std::span<double const> masses) {
  SymmetricMatrix all{};
  for (std::size_t i = 0; i < arms.size(); ++i) {
    Vector<3> const &q = arms[i], mq = q * masses[i];
    double const square = dot(q, mq);
    for (std::size_t a = 0; a < 3; ++a) all[a] += square - q[a] * mq[a];
    all[3] -= q[0] * mq[1];
    all[4] -= q[0] * mq[2];
    all[5] -= q[1] * mq[2];
  }
  return all;
}

Vector<3> solved(SymmetricMatrix const& inertia, bool line, Vector<3> const& b) {
  if (line) return b * (2 / (inertia[0] + inertia[1] + inertia[2]));  // its trace is twice the inertia across the line
  return solved({Vector<3>{inertia[0], inertia[3], inertia[4]}, Vector<3>{inertia[3], inertia[1], inertia[5]},
                 Vector<3>{inertia[4], inertia[5], inertia[2]}},
                b);
}

namespace {

/// For a line along u with the inertia J: finds u' with J u x u' = torque. Only the torque across the line acts.
bool turn_line(Vector<3> const& torque, double inertia, std::span<Vector<3> const> arms, std::span<Vector<3>> ways) {
  Vector<3> const* longest = &arms[0];
  for (auto const& arm : arms)
    if (dot(arm, arm) > dot(*longest, *longest)) longest = &arm;
  Vector<3> const u = *longest * (1 / magnitude(*longest)), w = cross(torque, u) * (1 / inertia);
  double const square = dot(w, w);
  if (!(square < 1)) return false;
  Vector<3> const way = w - u * (square / (1 + std::sqrt(1 - square)));  // u' - u
  for (std::size_t i = 0; i < arms.size(); ++i) ways[i] = way * dot(arms[i], u);
  return true;
}

/// The vector part p of the unit quaternion (p0, p) of the rotation: p0 I p + p x I p = torque / 2, by Newton's method.
std::optional<Vector<3>> half_rotation(SymmetricMatrix const& inertia, Vector<3> const& torque) {
  constexpr int max_turns = 30;
  constexpr double largest = 0.5;  // squared sine of half a right angle
  Vector<3> const half = torque * 0.5;
  double const scale = std::sqrt(dot(half, half));
  Vector<3> p = solved(inertia, false, half);
  for (int turn = 0; turn < max_turns; ++turn) {
    double const square = dot(p, p);
    if (!(square < largest)) return {};
    double const p0 = std::sqrt(1 - square);
    Vector<3> const ip = product(inertia, p), off = ip * p0 + cross(p, ip) - half;
    std::array<Vector<3>, 3> column;  // of the derivative
    for (std::size_t a = 0; a < 3; ++a) {
      Vector<3> unit{0, 0, 0};
      unit[a] = 1;
      Vector<3> const i_unit = product(inertia, unit);
      column[a] = i_unit * p0 - ip * (p[a] / p0) + cross(unit, ip) + cross(p, i_unit);
    }
    Vector<3> const change = solved(column, off);
    p -= change;
    if (!(dot(change, change) > 1e-28 * dot(p, p)) || !(magnitude(off) > 4e-16 * scale))
      return dot(p, p) < largest ? std::optional(p) : std::nullopt;
  }
  return {};
}

}  // namespace

bool turn_by(Vector<3> const& torque, bool line, std::span<double const> masses, std::span<Vector<3> const> arms,
             std::span<Vector<3>> ways) {
  SymmetricMatrix const inertia = inertia_of(arms, masses);
  if (line) return turn_line(torque, 0.5 * (inertia[0] + inertia[1] + inertia[2]), arms, ways);
  auto const p = half_rotation(inertia, torque);
  if (!p) return false;
  double const p0 = std::sqrt(1 - dot(*p, *p));
  for (std::size_t i = 0; i < arms.size(); ++i) {
    Vector<3> const across = cross(*p, arms[i]) * 2.0;
    ways[i] = across * p0 + cross(*p, across);
  }
  return true;
}

}  // namespace boltzmann
