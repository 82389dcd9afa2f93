// The ranges of axes, and the positions of values on them.
#pragma once

#include <boltzmann/pictures/canvas.hpp>

#include <array>
#include <optional>

namespace boltzmann {

/// The part of an axis that is shown.
struct AxisRange {
  double low = 0, high = 1;
  bool logarithmic = false;
  double factor = 1;  ///< of the numbers at the ticks

  /// 0 at low, 1 at high; NaN for a value without a position on a logarithmic axis.
  double place(double value) const;
  bool shows(double value) const { return !logarithmic || value > 0; }
};

/// The ranges of x and y: those set for the axes, or else the extent of the content (circles with their radius) with 3
/// % padding on each side. An empty canvas shows 0..1 (logarithmic 1..10). A single value is shown with 5 % of itself
/// (or 1) on either side. width_to_height of the drawing area is needed to reserve space for circles on y.
std::array<AxisRange, 2> axis_ranges(Canvas const& canvas, double width_to_height);

/// The low and the high corner of the content of the canvas, as x and y; for logarithmic axes, of positive values.
/// Nothing if there is no content.
std::optional<std::array<std::array<double, 2>, 2>> content_corners(Canvas const& canvas);

/// The number of elements and nodes with a coordinate that a logarithmic axis can't show.
std::size_t not_positive(Canvas const& canvas);

}  // namespace boltzmann
