// Drawings of measurements with their errors: points with bars, and curves over time with bars.
#pragma once

#include <boltzmann/pictures/canvas.hpp>

#include <optional>
#include <span>
#include <string>

namespace boltzmann {

/// One measured quantity: y over x, each with its standard error, or without one (an empty span, NaN, 0: no bar).
struct MeasuredSeries {
  std::string label;
  std::span<double const> x, y, x_error = {}, y_error = {};
  std::optional<Colour> colour = {};  // the palette's without one
};

/// A point for each measurement, with bars from value - error to value + error. `lines`: straight lines,
/// intercept and slope, dashed in the colour of the series of the same number. Throws Error if lengths differ.
struct StraightLine {
  double intercept, slope;
};
Canvas draw_measured_points(std::span<MeasuredSeries const> series, Axis x, Axis y, std::string title = "",
                            std::span<std::optional<StraightLine> const> lines = {});

/// A curve for each quantity with bars at some 20 places, not at the same ones, so that none hides another's; the time
/// axis ends where the series end. Throws Error if lengths differ.
Canvas draw_measured_time_series(std::span<MeasuredSeries const> series, Axis x, Axis y, std::string title = "");

}  // namespace boltzmann
