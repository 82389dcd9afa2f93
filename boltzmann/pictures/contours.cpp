// Marching squares; the segments are joined to lines.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/contours.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <limits>

namespace boltzmann {
namespace {

/// Segments of one level, each from an edge between two nodes to another. Node n has two edges: 2 n along x, 2 n + 1
/// along y.
class Marching {
 public:
  Marching(MeshGrid const& grid, std::span<double const> values, double level)
      : grid_(grid), values_(values), level_(level), next_(2 * grid.size(), none), entered_(2 * grid.size(), 0) {
    for (std::size_t j = 0; j < grid.cells(1); ++j)
      for (std::size_t i = 0; i < grid.cells(0); ++i) march(i, j);
  }

  /// Appends the lines: first those that begin at a wall, then closed ones.
  void join(std::vector<ContourLine>& lines) {
    for (std::size_t edge = 0; edge < next_.size(); ++edge)
      if (next_[edge] != none && entered_[edge] == 0) lines.push_back(followed(edge));
    for (std::size_t edge = 0; edge < next_.size(); ++edge)
      if (next_[edge] != none) lines.push_back(followed(edge));
  }

 private:
  static constexpr std::size_t none = std::numeric_limits<std::size_t>::max();

  // Visits a cell: corners and edges anticlockwise, from the low corner and the lower edge on.
  void march(std::size_t i, std::size_t j) {
    std::size_t const right = (i + 1) % grid_.nodes[0], upper = (j + 1) % grid_.nodes[1];
    std::array<std::size_t, 4> const node{grid_.index(i, j), grid_.index(right, j), grid_.index(right, upper),
                                          grid_.index(i, upper)};
    std::array<std::size_t, 4> const edge{2 * node[0], 2 * node[1] + 1, 2 * node[3], 2 * node[0] + 1};
    std::array<bool, 4> above;
    double mean = 0;
    int count = 0;
    for (std::size_t c = 0; c < 4; ++c) {
      mean += values_[node[c]] / 4;
      above[c] = values_[node[c]] >= level_;
      count += above[c];
    }
    if (!std::isfinite(mean) || count == 0 || count == 4) return;
    // Larger values are on the left, so a segment begins where above changes to below in anticlockwise order.
    bool const saddle = above[0] == above[2] && above[1] == above[3];
    if (saddle) {
      // Corners on the same side of the level as the middle are connected; the two others are cut off.
      bool const cut_off = !(mean >= level_);
      for (std::size_t c = 0; c < 4; ++c) {
        if (above[c] != cut_off) continue;
        std::size_t const before = edge[(c + 3) % 4], after = edge[c];
        if (cut_off)
          add(after, before);
        else
          add(before, after);
      }
      return;
    }
    std::size_t from = none, to = none;
    for (std::size_t c = 0; c < 4; ++c) {
      bool const next = above[(c + 1) % 4];
      if (above[c] && !next) from = edge[c];
      if (!above[c] && next) to = edge[c];
    }
    add(from, to);
  }

  void add(std::size_t from, std::size_t to) {
    next_[from] = to;
    entered_[to] = 1;
  }

  struct Point {
    double x, y;
  };
  Point crossing(std::size_t edge) const {
    std::size_t const node = edge / 2, along = edge % 2;
    std::size_t const i = node % grid_.nodes[0], j = node / grid_.nodes[0];
    std::size_t const other =
        along == 0 ? grid_.index((i + 1) % grid_.nodes[0], j) : grid_.index(i, (j + 1) % grid_.nodes[1]);
    double const t = std::clamp((level_ - values_[node]) / (values_[other] - values_[node]), 0.0, 1.0);
    return {grid_.position(0, i) + (along == 0 ? t * grid_.spacing[0] : 0),
            grid_.position(1, j) + (along == 1 ? t * grid_.spacing[1] : 0)};
  }

  // Follows the segments from an edge on, and removes them.
  ContourLine followed(std::size_t const first) {
    ContourLine line{level_, false, {}, {}};
    for (std::size_t edge = first; edge != none;) {
      Point point = crossing(edge);
      if (!line.x.empty()) {
        point.x = near(point.x, line.x.back(), 0);
        point.y = near(point.y, line.y.back(), 1);
      }
      line.x.push_back(point.x);
      line.y.push_back(point.y);
      std::size_t const next = next_[edge];
      next_[edge] = none;
      line.closed = edge == first && line.x.size() > 1;
      edge = next;
    }
    return line;
  }
  double near(double x, double last, int axis) const {
    if (!grid_.periodic[axis]) return x;
    double const length = static_cast<double>(grid_.nodes[axis]) * grid_.spacing[axis];
    return x - length * std::round((x - last) / length);
  }

  MeshGrid const& grid_;
  std::span<double const> values_;
  double level_;
  std::vector<std::size_t> next_;
  std::vector<std::uint8_t> entered_;
};

}  // namespace

std::vector<ContourLine> contour_lines(MeshGrid const& grid, std::span<double const> values,
                                       std::span<double const> levels) {
  if (grid.dimension != 2)
    throw Error(fmt::format("contours are lines on a grid of 2 dimensions, not of {}", grid.dimension));
  if (values.size() != grid.size())
    throw Error(fmt::format("contours on {} nodes can't be made of {} values", grid.size(), values.size()));
  std::vector<ContourLine> lines;
  for (double const level : levels) Marching(grid, values, level).join(lines);
  return lines;
}

std::vector<double> even_levels(std::span<double const> values, std::size_t count) {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (double const v : values)
    if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  std::vector<double> levels;
  if (!(low < high)) return levels;
  for (std::size_t k = 1; k <= count; ++k)
    levels.push_back(low + (high - low) * static_cast<double>(k) / static_cast<double>(count + 1));
  return levels;
}

double mean_value(std::span<double const> values) {
  double sum = 0;
  std::size_t count = 0;
  for (double const v : values)
    if (std::isfinite(v)) sum += v, ++count;
  return sum / static_cast<double>(count);
}

std::vector<ContourLine> inside_box(ContourLine const& line, MeshGrid const& grid) {
  auto const shift = [&](double middle, int axis) {
    double const length = static_cast<double>(grid.nodes[axis]) * grid.spacing[axis];
    return grid.periodic[axis] ? length * std::floor((middle - grid.low[axis]) / length) : 0.0;
  };
  std::vector<ContourLine> parts;
  double last_x = 0, last_y = 0;
  for (std::size_t k = 0; k + 1 < line.x.size(); ++k) {
    // Every segment is inside one cell, and so on one side of every wall.
    double const dx = shift((line.x[k] + line.x[k + 1]) / 2, 0), dy = shift((line.y[k] + line.y[k + 1]) / 2, 1);
    if (parts.empty() || dx != last_x || dy != last_y)
      parts.push_back({line.level, false, {line.x[k] - dx}, {line.y[k] - dy}});
    parts.back().x.push_back(line.x[k + 1] - dx);
    parts.back().y.push_back(line.y[k + 1] - dy);
    last_x = dx, last_y = dy;
  }
  if (parts.size() == 1) parts.front().closed = line.closed;
  return parts;
}

}  // namespace boltzmann
