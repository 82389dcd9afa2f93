// Each line provides seeds for its neighbours.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/streamlines.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <deque>
#include <optional>

namespace boltzmann {
namespace {

struct Spot {
  double x, y;
};

double distance(Spot const& a, Spot const& b) { return std::hypot(a.x - b.x, a.y - b.y); }

/// The points of lines, in bins with the size of the separation.
class Occupied {
 public:
  Occupied(Spot low, Spot high, double separation)
      : low_(low),
        size_(separation),
        columns_(static_cast<std::size_t>(std::ceil((high.x - low.x) / size_)) + 1),
        rows_(static_cast<std::size_t>(std::ceil((high.y - low.y) / size_)) + 1),
        squares_(columns_ * rows_) {}

  void add(Spot const& at) { squares_[row(at.y) * columns_ + column(at.x)].push_back(at); }
  bool nearer(Spot const& at, double limit) const {
    std::size_t const i = column(at.x), j = row(at.y);
    for (std::size_t b = j == 0 ? 0 : j - 1; b < std::min(rows_, j + 2); ++b)
      for (std::size_t a = i == 0 ? 0 : i - 1; a < std::min(columns_, i + 2); ++a)
        for (Spot const& other : squares_[b * columns_ + a])
          if (distance(at, other) < limit) return true;
    return false;
  }

 private:
  static std::size_t clamped(double place, std::size_t count) {
    return static_cast<std::size_t>(std::clamp(place, 0.0, static_cast<double>(count - 1)));
  }
  std::size_t column(double x) const { return clamped(std::floor((x - low_.x) / size_), columns_); }
  std::size_t row(double y) const { return clamped(std::floor((y - low_.y) / size_), rows_); }

  Spot low_;
  double size_;
  std::size_t columns_, rows_;
  std::vector<std::vector<Spot>> squares_;
};

class LineDrawing {
 public:
  LineDrawing(MeshGrid const& grid, std::span<double const> u, std::span<double const> v, double separation)
      : grid_(grid),
        u_(u),
        v_(v),
        separation_(separation),
        low_{grid.low[0], grid.low[1]},
        high_{grid.position(0, grid.nodes[0] - 1), grid.position(1, grid.nodes[1] - 1)},
        step_(std::min(0.3 * std::min(grid.spacing[0], grid.spacing[1]), 0.1 * separation)),
        occupied_(low_, high_, separation) {
    for (std::size_t k = 0; k < u.size(); ++k)
      if (double const speed = std::hypot(u[k], v[k]); std::isfinite(speed)) fastest_ = std::max(fastest_, speed);
  }

  std::vector<Streamline> all() {
    std::vector<Streamline> lines;
    if (!(fastest_ > 0)) return lines;
    // Start in the middle, then wherever there is space.
    std::deque<Spot> seeds{{0.5 * (low_.x + high_.x), 0.5 * (low_.y + high_.y)}};
    auto const columns = static_cast<int>((high_.x - low_.x) / separation_) + 1,
               rows = static_cast<int>((high_.y - low_.y) / separation_) + 1;
    int next = 0;
    while (true) {
      while (!seeds.empty()) {
        Spot const seed = seeds.front();
        seeds.pop_front();
        if (!direction(seed) || occupied_.nearer(seed, separation_)) continue;
        Streamline line = through(seed);
        std::size_t const points = line.x.size();
        if (points < 2) continue;
        for (std::size_t k = 0; k < points; ++k) occupied_.add({line.x[k], line.y[k]});
        auto const apart = static_cast<std::size_t>(separation_ / step_) + 1;
        for (std::size_t k = 0; k < points; k += apart)
          if (auto const along = direction({line.x[k], line.y[k]}))
            for (double const side : {1.001, -1.001})
              seeds.push_back({line.x[k] - side * separation_ * along->y, line.y[k] + side * separation_ * along->x});
        if (length(line) > 2 * separation_) lines.push_back(std::move(line));
      }
      if (next == columns * rows) return lines;
      seeds.push_back({low_.x + (next % columns + 0.5) * separation_, low_.y + (next / columns + 0.5) * separation_});
      ++next;
    }
  }

 private:
  static double length(Streamline const& line) {
    double sum = 0;
    for (std::size_t k = 1; k < line.x.size(); ++k)
      sum += std::hypot(line.x[k] - line.x[k - 1], line.y[k] - line.y[k - 1]);
    return sum;
  }

  /// A unit vector; nothing outside, and where the flow is zero or unknown.
  std::optional<Spot> direction(Spot const& at) const {
    double const x = (at.x - low_.x) / grid_.spacing[0], y = (at.y - low_.y) / grid_.spacing[1];
    if (!(x >= 0 && y >= 0 && at.x <= high_.x && at.y <= high_.y)) return std::nullopt;
    std::size_t const i = std::min(static_cast<std::size_t>(x), grid_.nodes[0] - 2),
                      j = std::min(static_cast<std::size_t>(y), grid_.nodes[1] - 2);
    double const s = x - static_cast<double>(i), t = y - static_cast<double>(j);
    auto const between = [&](std::span<double const> values) {
      return (1 - t) * ((1 - s) * values[grid_.index(i, j)] + s * values[grid_.index(i + 1, j)]) +
             t * ((1 - s) * values[grid_.index(i, j + 1)] + s * values[grid_.index(i + 1, j + 1)]);
    };
    double const u = between(u_), v = between(v_), speed = std::hypot(u, v);
    if (!(speed > 1e-9 * fastest_)) return std::nullopt;
    return Spot{u / speed, v / speed};
  }

  /// A fourth-order Runge-Kutta step along the line.
  std::optional<Spot> stepped(Spot const& from, double step) const {
    auto const a = direction(from);
    if (!a) return std::nullopt;
    auto const b = direction({from.x + step / 2 * a->x, from.y + step / 2 * a->y});
    if (!b) return std::nullopt;
    auto const c = direction({from.x + step / 2 * b->x, from.y + step / 2 * b->y});
    if (!c) return std::nullopt;
    auto const d = direction({from.x + step * c->x, from.y + step * c->y});
    if (!d) return std::nullopt;
    return Spot{from.x + step / 6 * (a->x + 2 * b->x + 2 * c->x + d->x),
                from.y + step / 6 * (a->y + 2 * b->y + 2 * c->y + d->y)};
  }

  Streamline through(Spot const& seed) const {
    std::vector<Spot> forwards, backwards;
    bool const closed = follow(seed, step_, forwards);
    if (!closed) follow(seed, -step_, backwards);
    Streamline line{closed, {}, {}};
    auto const add = [&](Spot const& at) { line.x.push_back(at.x), line.y.push_back(at.y); };
    for (std::size_t k = backwards.size(); k-- > 0;) add(backwards[k]);
    add(seed);
    for (Spot const& at : forwards) add(at);
    if (closed) add(seed);
    return line;
  }

  /// True if it returns to the seed.
  bool follow(Spot const& seed, double step, std::vector<Spot>& points) const {
    double const whole = 20 * ((high_.x - low_.x) + (high_.y - low_.y));
    auto const most = static_cast<std::size_t>(whole / step_);
    bool left = false;
    Occupied own(low_, high_, separation_);  // its own points, except the most recent
    auto const behind = static_cast<std::size_t>(separation_ / step_);
    for (Spot at = seed; points.size() < most;) {
      auto const next = stepped(at, step);
      if (!next) return false;
      at = *next;
      double const from_seed = distance(at, seed);
      left = left || from_seed > 3 * step_;
      if (left && from_seed < 0.8 * step_) return true;
      if (occupied_.nearer(at, separation_ / 2)) return false;
      if (points.size() > behind) {
        own.add(points[points.size() - behind - 1]);
        // A circle that does not quite close because of the grid counts as closed; a spiral ends.
        if (points.size() > 2 * behind && own.nearer(at, separation_ / 4))
          return from_seed < separation_ / 2 && step > 0;
      }
      points.push_back(at);
    }
    return false;
  }

  MeshGrid const& grid_;
  std::span<double const> u_, v_;
  double separation_;
  Spot low_, high_;
  double step_, fastest_ = 0;
  Occupied occupied_;
};

}  // namespace

std::vector<Streamline> streamlines(MeshGrid const& grid, std::span<double const> along_x,
                                    std::span<double const> along_y, double separation) {
  if (grid.dimension != 2)
    throw Error(fmt::format("streamlines are on a grid of 2 dimensions, not of {}", grid.dimension));
  if (along_x.size() != grid.size() || along_y.size() != grid.size() || grid.nodes[0] < 2 || grid.nodes[1] < 2)
    throw Error(fmt::format("streamlines on {} nodes can't be made of {} and {} values", grid.size(), along_x.size(),
                            along_y.size()));
  double const longest = std::max(static_cast<double>(grid.nodes[0]) * grid.spacing[0],
                                  static_cast<double>(grid.nodes[1]) * grid.spacing[1]);
  if (!(separation > 1e-3 * longest))
    throw Error(fmt::format("streamlines: a separation of {} on a grid {} long is too small", separation, longest));
  return LineDrawing(grid, along_x, along_y, separation).all();
}

}  // namespace boltzmann
