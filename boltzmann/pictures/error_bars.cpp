// Bars are lines with a short stroke at each end. The length of strokes is a fraction of the picture, independent of
// the axes.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/error_bars.hpp>
#include <boltzmann/pictures/figure_layout.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

constexpr double picture_width_to_height = 4.0 / 3;
constexpr double stroke = 0.005;  // half the length of a stroke, as a fraction of the axis

Colour series_colour(std::span<MeasuredSeries const> series, std::size_t s) {
  return series[s].colour.value_or(species_colour(static_cast<int>(s)));
}

void check(std::span<MeasuredSeries const> series) {
  for (auto const& one : series)
    for (std::size_t const length : {one.y.size(), one.x_error.empty() ? one.x.size() : one.x_error.size(),
                                     one.y_error.empty() ? one.x.size() : one.y_error.size()})
      if (length != one.x.size())
        throw Error("'" + one.label + "' has " + std::to_string(one.x.size()) + " x, and " + std::to_string(length) +
                    " of something else");
}

double error_at(std::span<double const> errors, std::size_t i) {
  return i < errors.size() && std::isfinite(errors[i]) ? errors[i] : 0;
}

/// A value shifted by a fraction of the axis.
double moved(double value, double part, AxisRange const& axis) {
  if (!axis.logarithmic) return value + part * (axis.high - axis.low);
  return value * std::pow(axis.high / axis.low, part);
}

/// The low end of a bar. On a logarithmic axis, one that extends below zero ends at the low end of the axis.
double low_end(double value, double error, AxisRange const& axis) {
  double const low = value - error;
  return axis.logarithmic && low <= 0 ? std::min(axis.low, value) : low;
}

void draw_bars(Canvas& canvas, MeasuredSeries const& one, std::size_t i, Colour colour,
               std::array<AxisRange, 2> const& axes) {
  double const x = one.x[i], y = one.y[i];
  if (!std::isfinite(x) || !std::isfinite(y)) return;
  if (double const error = error_at(one.y_error, i); error > 0 && axes[1].shows(y)) {
    double const low = low_end(y, error, axes[1]), high = y + error;
    double const left = moved(x, -stroke, axes[0]), right = moved(x, stroke, axes[0]);
    canvas.line(x, low, x, high, colour, 1.6F);
    canvas.line(left, low, right, low, colour, 1.6F);
    canvas.line(left, high, right, high, colour, 1.6F);
  }
  if (double const error = error_at(one.x_error, i); error > 0 && axes[0].shows(x)) {
    double const left = low_end(x, error, axes[0]), right = x + error;
    double const part = stroke * picture_width_to_height;
    double const low = moved(y, -part, axes[1]), high = moved(y, part, axes[1]);
    canvas.line(left, y, right, y, colour, 1.6F);
    canvas.line(left, low, left, high, colour, 1.6F);
    canvas.line(right, low, right, high, colour, 1.6F);
  }
}

/// The ranges of the axes: the measurements with the ends of all bars.
std::array<AxisRange, 2> ranges_with_bars(std::span<MeasuredSeries const> series, Axis const& x, Axis const& y) {
  Canvas all;
  all.axes(x, y);
  for (auto const& one : series)
    for (std::size_t i = 0; i < one.x.size(); ++i) {
      double const dx = error_at(one.x_error, i), dy = error_at(one.y_error, i);
      all.point(one.x[i] - dx, one.y[i] - dy, ink);
      all.point(one.x[i] + dx, one.y[i] + dy, ink);
      all.point(one.x[i], one.y[i], ink);
    }
  return axis_ranges(all, picture_width_to_height);
}

void fix(Axis& axis, AxisRange const& range) {
  axis.low = range.low;
  axis.high = range.high;
}

}  // namespace

Canvas draw_measured_points(std::span<MeasuredSeries const> series, Axis x, Axis y, std::string title,
                            std::span<std::optional<StraightLine> const> lines) {
  check(series);
  auto const ranges = ranges_with_bars(series, x, y);
  fix(x, ranges[0]);
  fix(y, ranges[1]);
  Canvas canvas;
  canvas.title(std::move(title));
  canvas.axes(std::move(x), std::move(y));
  canvas.grid(true);
  for (std::size_t s = 0; s < series.size(); ++s) {
    Colour const colour = series_colour(series, s);
    if (s < lines.size() && lines[s]) {
      std::vector<double> right, up;
      constexpr int nodes = 100;  // a straight line is a curve on a logarithmic axis
      for (int k = 0; k <= nodes; ++k) {
        double const at = moved(ranges[0].low, static_cast<double>(k) / nodes, ranges[0]);
        double const height = lines[s]->intercept + lines[s]->slope * at;
        if (height < ranges[1].low || height > ranges[1].high) continue;
        right.push_back(at);
        up.push_back(height);
      }
      canvas.curve(right, up, with_alpha(colour, 0.7), "", 2, true);
    }
    if (!series[s].label.empty()) canvas.legend(series[s].label, colour);
    for (std::size_t i = 0; i < series[s].x.size(); ++i) {
      draw_bars(canvas, series[s], i, colour, ranges);
      canvas.point(series[s].x[i], series[s].y[i], colour, 9);
    }
  }
  return canvas;
}

Canvas draw_measured_time_series(std::span<MeasuredSeries const> series, Axis x, Axis y, std::string title) {
  check(series);
  double low = std::numeric_limits<double>::infinity(), high = -low;
  for (auto const& one : series)
    for (double const t : one.x)
      if (std::isfinite(t)) low = std::min(low, t), high = std::max(high, t);
  if (!x.logarithmic && high > low) {
    if (!std::isfinite(x.low)) x.low = low;
    if (!std::isfinite(x.high)) x.high = high;
  }
  auto const ranges = ranges_with_bars(series, x, y);
  fix(y, ranges[1]);
  Canvas canvas;
  canvas.title(std::move(title));
  canvas.axes(std::move(x), std::move(y));
  canvas.grid(true);
  for (std::size_t s = 0; s < series.size(); ++s) {
    Colour const colour = series_colour(series, s);
    canvas.curve(series[s].x, series[s].y, colour, series[s].label, 2.4F);
    // Selects nodes at a fixed interval, with an offset that no other series has.
    std::size_t const count = series[s].x.size(), every = std::max<std::size_t>(1, count / 20);
    for (std::size_t i = every * s / series.size(); i < count; i += every)
      draw_bars(canvas, series[s], i, colour, ranges);
  }
  return canvas;
}

}  // namespace boltzmann
