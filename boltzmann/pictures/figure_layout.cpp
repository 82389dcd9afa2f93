// Automatic ranges of axes.
#include <boltzmann/pictures/figure_layout.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

constexpr double padding = 0.03;
constexpr double huge = 8e307;  // the difference of two such numbers is still finite

struct Extent {
  double low = std::numeric_limits<double>::infinity(), high = -low;
  bool positive_only = false;

  void add(double v) {
    if (!std::isfinite(v) || (positive_only && v <= 0)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  void add_between(double v, double reach) {
    if (positive_only && v - reach <= 0) {
      add(v);
    } else {
      add(v - reach);
    }
    add(v + reach);
  }
  bool empty() const { return low > high; }
};

// True if a particle at this position is drawn.
bool is_drawn(double x, double y) { return std::isfinite(x) && std::isfinite(y); }

// Calls with (x, y, radius) for every particle of a cloud.
template <class Visit>
void each_place(Canvas::Cloud const& cloud, Visit visit) {
  auto const dimension = static_cast<std::size_t>(cloud.dimension);
  for (std::size_t i = 0; i < cloud.count(); ++i) {
    double const x = cloud.origin[0] + cloud.scale[0] * static_cast<double>(cloud.position[i * dimension]);
    double const y = cloud.origin[1] + cloud.scale[1] * static_cast<double>(cloud.position[i * dimension + 1]);
    double const diameter = cloud.diameter.empty() ? cloud.common_diameter : static_cast<double>(cloud.diameter[i]);
    if (is_drawn(x, y)) visit(x, y, std::isfinite(diameter) ? std::abs(diameter) / 2 : 0.0);
  }
}

// Calls for the corners of a cloud whose particles have one size: the same result, and much faster.
template <class Visit>
void corners(Canvas::Cloud const& cloud, Visit visit) {
  constexpr float infinity = std::numeric_limits<float>::infinity();
  auto const dimension = static_cast<std::size_t>(cloud.dimension);
  std::array<float, 2> low{infinity, infinity}, high{-infinity, -infinity};
  for (std::size_t i = 0; i < cloud.position.size(); i += dimension) {
    float const x = cloud.position[i], y = cloud.position[i + 1];
    bool const whole = x - x == 0 && y - y == 0;
    low = {whole && x < low[0] ? x : low[0], whole && y < low[1] ? y : low[1]};
    high = {whole && x > high[0] ? x : high[0], whole && y > high[1] ? y : high[1]};
  }
  if (low[0] > high[0]) return;
  for (auto const& corner : {low, high})
    visit(cloud.origin[0] + cloud.scale[0] * static_cast<double>(corner[0]),
          cloud.origin[1] + cloud.scale[1] * static_cast<double>(corner[1]), std::abs(cloud.common_diameter) / 2);
}

// Calls with (x, y, radius) for every position on the canvas; for clouds only their corners if these suffice.
template <class Visit>
void each_place(Canvas const& canvas, Visit visit) {
  bool const logarithmic = canvas.x_axis().logarithmic || canvas.y_axis().logarithmic;
  for (auto const& cloud : canvas.clouds()) {
    if (logarithmic || !cloud.diameter.empty())
      each_place(cloud, visit);
    else
      corners(cloud, visit);
  }
  for (auto const& c : canvas.circles()) visit(c.x, c.y, c.radius);
  for (auto const& p : canvas.points()) visit(p.x, p.y, 0.0);
  for (auto const& l : canvas.lines()) visit(l.x0, l.y0, 0.0), visit(l.x1, l.y1, 0.0);
  for (auto const& a : canvas.arrows()) visit(a.x0, a.y0, 0.0), visit(a.x1, a.y1, 0.0);
  for (auto const& t : canvas.texts()) visit(t.x, t.y, 0.0);
  for (auto const& i : canvas.images()) visit(i.x0, i.y0, 0.0), visit(i.x1, i.y1, 0.0);
  for (auto const& c : canvas.curves())
    for (std::size_t i = 0; i < c.x.size(); ++i)
      if (std::isfinite(c.x[i]) && std::isfinite(c.y[i])) visit(c.x[i], c.y[i], 0.0);
}

AxisRange linear_range(Axis const& axis, Extent const& extent) {
  AxisRange range{extent.empty() ? 0 : std::max(extent.low, -huge), extent.empty() ? 1 : std::min(extent.high, huge),
                  false};
  bool const fixed_low = std::isfinite(axis.low), fixed_high = std::isfinite(axis.high);
  double const largest = std::max(std::abs(range.low), std::abs(range.high));
  double const shown = (fixed_high ? std::min(axis.high, range.high) : range.high) -
                       (fixed_low ? std::max(axis.low, range.low) : range.low);
  double const width = shown > 0 ? shown : range.high - range.low;
  if (extent.empty()) {
  } else if (width <= 1e-13 * largest || width < 1e-290) {
    double const room = largest > 1e-290 ? 0.05 * largest : 1;
    range.low -= room;
    range.high += room;
  } else {
    range.low -= padding * width;
    range.high += padding * width;
  }
  if (fixed_low) range.low = axis.low;
  if (fixed_high) range.high = axis.high;
  if (range.low > range.high && fixed_low && fixed_high) std::swap(range.low, range.high);
  if (!(range.high - range.low > 1e-13 * std::max(std::abs(range.low), std::abs(range.high)))) {
    double const room = std::max(std::abs(range.low), std::abs(range.high)) > 1e-290 ? 0.05 * std::abs(range.low) : 1;
    if (!fixed_high || fixed_low) range.high = range.low + room;
    if (!fixed_low) range.low = range.high - room;
  }
  return range;
}

AxisRange logarithmic_range(Axis const& axis, Extent const& extent) {
  double low = extent.empty() ? 0 : std::log10(extent.low), high = extent.empty() ? 1 : std::log10(extent.high);
  if (!extent.empty()) {
    double const room = high - low < 1e-9 ? 0.5 : padding * (high - low);
    low -= room;
    high += room;
  }
  if (std::isfinite(axis.low) && axis.low > 0) low = std::log10(axis.low);
  if (std::isfinite(axis.high) && axis.high > 0) high = std::log10(axis.high);
  if (low > high && axis.low > 0 && axis.high > 0) std::swap(low, high);
  if (!(high - low > 1e-9)) (std::isfinite(axis.high) && !std::isfinite(axis.low)) ? low = high - 1 : high = low + 1;
  return {std::pow(10.0, std::max(low, -307.0)), std::pow(10.0, std::min(high, 307.0)), true};
}

/// The extents of all positions that the axes can show.
std::array<Extent, 2> extents(Canvas const& canvas) {
  bool const x_log = canvas.x_axis().logarithmic, y_log = canvas.y_axis().logarithmic;
  std::array<Extent, 2> both{Extent{.positive_only = x_log}, Extent{.positive_only = y_log}};
  each_place(canvas, [&](double px, double py, double radius) {
    if ((x_log && px <= 0) || (y_log && py <= 0)) return;
    both[0].add_between(px, radius);
    both[1].add_between(py, canvas.equal_aspect() ? radius : 0);
  });
  return both;
}

}  // namespace

double AxisRange::place(double value) const {
  if (!logarithmic) return (value / 2 - low / 2) / (high / 2 - low / 2);
  return value > 0 ? (std::log10(value) - std::log10(low)) / (std::log10(high) - std::log10(low))
                   : std::numeric_limits<double>::quiet_NaN();
}

std::array<AxisRange, 2> axis_ranges(Canvas const& canvas, double width_to_height) {
  bool const x_log = canvas.x_axis().logarithmic, y_log = canvas.y_axis().logarithmic;
  auto const given = [](Axis const& axis) { return std::isfinite(axis.low) && std::isfinite(axis.high); };
  if (!x_log && !y_log && given(canvas.x_axis()) && given(canvas.y_axis()))
    return {linear_range(canvas.x_axis(), {}), linear_range(canvas.y_axis(), {})};
  auto [x, y] = extents(canvas);
  AxisRange const x_range = x_log ? logarithmic_range(canvas.x_axis(), x) : linear_range(canvas.x_axis(), x);
  bool const with_discs =
      !canvas.circles().empty() || std::any_of(canvas.clouds().begin(), canvas.clouds().end(), [](auto const& cloud) {
        return cloud.common_diameter != 0 || !cloud.diameter.empty();
      });
  if (!canvas.equal_aspect() && !x_log && !y_log && with_discs) {
    double const per_x = (y.high - y.low) / (x_range.high - x_range.low) * width_to_height;
    if (std::isfinite(per_x)) {
      Extent with_circles = y;
      for (auto const& c : canvas.circles()) with_circles.add_between(c.y, c.radius * per_x);
      for (auto const& cloud : canvas.clouds())
        each_place(cloud, [&](double, double at, double radius) { with_circles.add_between(at, radius * per_x); });
      y = with_circles;
    }
  }
  return {x_range, y_log ? logarithmic_range(canvas.y_axis(), y) : linear_range(canvas.y_axis(), y)};
}

std::optional<std::array<std::array<double, 2>, 2>> content_corners(Canvas const& canvas) {
  auto const [x, y] = extents(canvas);
  if (x.empty() || y.empty()) return std::nullopt;
  return std::array{std::array{x.low, y.low}, std::array{x.high, y.high}};
}

std::size_t not_positive(Canvas const& canvas) {
  bool const x_log = canvas.x_axis().logarithmic, y_log = canvas.y_axis().logarithmic;
  if (!x_log && !y_log) return 0;
  auto hidden = [&](double x, double y) { return (x_log && x <= 0) || (y_log && y <= 0); };
  std::size_t count = 0;
  for (auto const& c : canvas.circles()) count += hidden(c.x, c.y);
  for (auto const& p : canvas.points()) count += hidden(p.x, p.y);
  for (auto const& l : canvas.lines()) count += hidden(l.x0, l.y0) || hidden(l.x1, l.y1);
  for (auto const& a : canvas.arrows()) count += hidden(a.x0, a.y0) || hidden(a.x1, a.y1);
  for (auto const& t : canvas.texts()) count += hidden(t.x, t.y);
  for (auto const& i : canvas.images()) count += hidden(i.x0, i.y0) || hidden(i.x1, i.y1);
  for (auto const& cloud : canvas.clouds())
    each_place(cloud, [&](double x, double y, double) { count += hidden(x, y); });
  for (auto const& c : canvas.curves())
    for (std::size_t i = 0; i < c.x.size(); ++i)
      count += std::isfinite(c.x[i]) && std::isfinite(c.y[i]) && hidden(c.x[i], c.y[i]);
  return count;
}

}  // namespace boltzmann
