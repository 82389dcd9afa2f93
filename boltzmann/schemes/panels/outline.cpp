// Corners of shapes.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/laws/two_columns.hpp>
#include <boltzmann/schemes/panels/outline.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <utility>

namespace boltzmann {
namespace {

constexpr std::size_t max_corners = 4000;

double area(std::vector<Vector<2>> const& corners) {
  double twice = 0;
  for (std::size_t i = 0; i < corners.size(); ++i) {
    auto const &a = corners[i], &b = corners[(i + 1) % corners.size()];
    twice += a[0] * b[1] - a[1] * b[0];
  }
  return twice / 2;
}

double turn(Vector<2> const& a, Vector<2> const& b, Vector<2> const& c) {
  return (b[0] - a[0]) * (c[1] - a[1]) - (b[1] - a[1]) * (c[0] - a[0]);
}

/// Two sides of a polygon that meet other than at their common corner, by the numbers of their first corners.
std::optional<std::array<std::size_t, 2>> crossing_sides(std::vector<Vector<2>> const& points) {
  std::size_t const count = points.size();
  for (std::size_t i = 0; i < count; ++i) {
    std::size_t const next = (i + 1) % count;
    auto const &a = points[i], &b = points[next], &beyond = points[(i + 2) % count];
    if (turn(a, b, beyond) == 0 && dot(b - a, beyond - b) < 0) return std::array{i, next};  // it reverses direction
    for (std::size_t j = i + 2; j < count; ++j) {
      if (i == 0 && j + 1 == count) continue;
      auto const &c = points[j], &d = points[(j + 1) % count];
      if (turn(a, b, c) * turn(a, b, d) <= 0 && turn(c, d, a) * turn(c, d, b) <= 0) return std::array{i, j};
    }
  }
  return std::nullopt;
}

}  // namespace

void check(Outline const& outline) {
  auto const& corners = outline.corners;
  if (corners.size() < 3) throw Error(fmt::format("an outline needs 3 or more panels, not {}", corners.size()));
  if (corners.size() > max_corners)
    throw Error(fmt::format("an outline of {} panels: at most {} can be solved for", corners.size(), max_corners));
  for (std::size_t i = 0; i < corners.size(); ++i) {
    auto const& next = corners[(i + 1) % corners.size()];
    if (!std::isfinite(corners[i][0]) || !std::isfinite(corners[i][1]))
      throw Error(fmt::format("corner {} of an outline is not finite", i));
    if (corners[i][0] == next[0] && corners[i][1] == next[1])
      throw Error(fmt::format("corners {} and {} of an outline are at one place", i, (i + 1) % corners.size()));
  }
  if (!(area(corners) > 0)) throw Error("an outline runs counterclockwise around its body");
}

Outline ellipse_outline(Vector<2> const& centre, double a, double b, double angle, std::size_t panels) {
  Outline outline;
  double const c = std::cos(angle), s = std::sin(angle);
  for (std::size_t i = 0; i < panels; ++i) {
    double const at = 2 * pi * static_cast<double>(i) / static_cast<double>(panels);
    double const x = a * std::cos(at), y = b * std::sin(at);
    outline.corners.push_back({centre[0] + c * x - s * y, centre[1] + s * x + c * y});
  }
  check(outline);
  return outline;
}

Outline circle_outline(Vector<2> const& centre, double radius, std::size_t panels) {
  return ellipse_outline(centre, radius, radius, 0, panels);
}

Outline naca_outline(std::string const& digits, Vector<2> const& centre, double chord, double attack,
                     std::size_t panels) {
  bool const four =
      digits.size() == 4 && std::all_of(digits.begin(), digits.end(), [](char c) { return c >= '0' && c <= '9'; });
  if (!four) throw Error(fmt::format("naca: four digits are needed, \"0012\" or \"2412\", not '{}'", digits));
  double const camber = (digits[0] - '0') / 100.0, at = (digits[1] - '0') / 10.0;
  double const thickness = ((digits[2] - '0') * 10 + (digits[3] - '0')) / 100.0;
  if (thickness == 0) throw Error(fmt::format("naca: '{}' has no thickness; its last two digits are per cent", digits));
  if ((camber > 0) != (at > 0))
    throw Error(fmt::format("naca: '{}' has a camber without a place, or a place without a camber", digits));
  if (panels < 8) throw Error(fmt::format("an aerofoil needs 8 or more panels, not {}", panels));
  std::size_t const half = panels / 2;
  Outline outline;
  outline.sharp = true;
  double const c = std::cos(attack), s = std::sin(attack);
  for (std::size_t i = 0; i < 2 * half; ++i) {
    double const around = pi * static_cast<double>(i) / static_cast<double>(half), side = i <= half ? 1 : -1;
    double const x = 0.5 * (1 + std::cos(around));
    double const thick =
        5 * thickness * (0.2969 * std::sqrt(x) + x * (-0.1260 + x * (-0.3516 + x * (0.2843 + x * -0.1036))));
    double line = 0, slope = 0;
    if (camber > 0 && x < at)
      line = camber / (at * at) * x * (2 * at - x), slope = 2 * camber / (at * at) * (at - x);
    else if (camber > 0)
      line = camber / ((1 - at) * (1 - at)) * (1 - 2 * at + x * (2 * at - x)),
      slope = 2 * camber / ((1 - at) * (1 - at)) * (at - x);
    double const root = 1 / std::sqrt(1 + slope * slope);
    double const px = chord * (x - side * thick * slope * root - 0.25), py = chord * (line + side * thick * root);
    outline.corners.push_back({centre[0] + c * px + s * py, centre[1] - s * px + c * py});
  }
  check(outline);
  return outline;
}

Outline polygon_outline(std::vector<Vector<2>> points, std::size_t panels, bool sharp) {
  if (points.size() < 3) throw Error(fmt::format("a polygon needs 3 or more points, not {}", points.size()));
  if (area(points) < 0) std::reverse(points.begin() + 1, points.end());
  if (crossing_sides(points)) throw Error("the sides of the polygon cross each other");
  double around = 0;
  for (std::size_t i = 0; i < points.size(); ++i) around += magnitude(points[(i + 1) % points.size()] - points[i]);
  Outline outline;
  outline.sharp = sharp;
  for (std::size_t i = 0; i < points.size(); ++i) {
    auto const &from = points[i], &to = points[(i + 1) % points.size()];
    double const share = magnitude(to - from) / around * static_cast<double>(panels);
    auto const parts = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(share)));
    for (std::size_t k = 0; k < parts; ++k)
      outline.corners.push_back(from + (to - from) * (static_cast<double>(k) / static_cast<double>(parts)));
  }
  check(outline);
  return outline;
}

Outline outline_from_file(std::string const& path, std::size_t panels, OutlinePlace const& place, bool sharp) {
  auto lines = read_pairs(path, "x", "y");
  if (lines.size() > 1 && lines.front().numbers == lines.back().numbers) lines.pop_back();  // it is closed
  if (lines.size() < 3) throw Error(fmt::format("{}: {} points; an outline needs 3 or more", path, lines.size()));
  if (lines.size() > max_corners)
    throw Error(fmt::format("{}: {} points; an outline has at most {}", path, lines.size(), max_corners));
  double const c = std::cos(place.angle), s = std::sin(place.angle);
  std::vector<Vector<2>> points;
  for (auto const& [numbers, line] : lines) {
    double const x = place.length * numbers[0], y = place.length * numbers[1];
    points.push_back({place.centre[0] + c * x - s * y, place.centre[1] + s * x + c * y});
  }
  for (std::size_t i = 0; i < points.size(); ++i)
    if (points[i] == points[(i + 1) % points.size()])
      throw Error(fmt::format("{}:{}: the point is that of line {} again", path, lines[(i + 1) % points.size()].line,
                              lines[i].line));
  if (auto const sides = crossing_sides(points))
    throw Error(fmt::format("{}:{}: the side from here to the next point meets that from line {}", path,
                            lines[(*sides)[1]].line, lines[(*sides)[0]].line));
  return polygon_outline(std::move(points), panels, sharp);
}

}  // namespace boltzmann
