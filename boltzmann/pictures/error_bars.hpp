// Drawings of measurements with their errors: points with bars, and curves over time with bars.
#pragma once

#include <boltzmann/pictures/canvas.hpp>

#include <optional>
#include <span>
#include <string>

namespace boltzmann {

/// One measured quantity: y over x, each with its standard error, or without one (an empty span, NaN or 0: no bar).
struct MeasuredSeries {
  std::string label;
  std::span<double const> x, y, x_error = {}, y_error = {};
  std::optional<Colour> colour = {};  // empty: from the palette
};

/// A point per measurement, with bars from value - error to value + error. `lines`: straight lines, intercept and
/// slope, dashed in the colour of the series with the same index. Throws Error if lengths differ.
struct StraightLine {
  double intercept, slope;
};
Canvas draw_measured_points(std::span<MeasuredSeries const> series, Axis x, Axis y, std::string title = "",
                            std::span<std::optional<StraightLine> const> lines = {});

/// A curve per quantity with bars at about 20 positions, which differ between series so that bars don't overlap. The
/// time axis ends where the series end. Throws Error if lengths differ.
Canvas draw_measured_time_series(std::span<MeasuredSeries const> series, Axis x, Axis y, std::string title = "");

}  // namespace boltzmann
