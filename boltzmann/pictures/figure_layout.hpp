// What an axis shows and where a value falls on it.
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

  /// 0 at low, 1 at high; NaN where a logarithmic axis has no such value.
  double place(double value) const;
  bool shows(double value) const { return !logarithmic || value > 0; }
};

/// The ranges of x and y: what the axes ask for, else the extent of the content (circles with their radius) with 3 %
/// padding on each side. An empty canvas shows 0..1 (logarithmic 1..10), a single value is shown with 5 % of itself (or
/// 1) on either side. width_to_height of the drawing area is needed to give circles room on y.
std::array<AxisRange, 2> axis_ranges(Canvas const& canvas, double width_to_height);

/// The low and the high corner of all that the canvas draws, as x and y; of logarithmic axes what is positive. Nothing
/// if there is nothing.
std::optional<std::array<std::array<double, 2>, 2>> content_corners(Canvas const& canvas);

/// How many elements and nodes have a coordinate that a logarithmic axis can't show.
std::size_t not_positive(Canvas const& canvas);

}  // namespace boltzmann
