// Layout of the elements around a drawing: frame, ticks, titles, legend, colour bars and notes. Nothing is drawn here;
// a callback of the renderer measures text. window/web/src/paint/figure.ts has the same layout;
// tests/window/layouts.json tests both.
#pragma once

#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/pictures/canvas_ticks.hpp>
#include <boltzmann/pictures/figure_layout.hpp>

#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann {

struct DevicePoint {
  double x, y;
};

struct DeviceBox {
  double left = 0, top = 0, width = 0, height = 0;
  double right() const { return left + width; }
  double bottom() const { return top + height; }
};

/// A font with its height in device units.
struct Font {
  double size;
  bool bold = false;
};

/// The width of a text with raised and lowered parts.
using TextWidth = std::function<double(std::string_view markup, Font font)>;

/// The lines of a text, broken at spaces such that each is at most `most` wide (a longer word has a line of its own).
std::vector<std::string> wrapped(std::string_view markup, double most, Font font, TextWidth const& width);

/// The paper of a figure, in device units. `unit` of them are one pixel of a picture of 1200 x 900, in which the fonts
/// of the title and of notes are given. Aligned to whole pixels, thin lines are sharp.
struct Paper {
  double width, height, unit;
  bool whole_pixels = true;
  double heading = 25, note = 16.5;
};

/// The elements around a drawing, in device units; texts in drawing order.
struct FigurePlan {
  /// The base line begins at (x, y) for align = 0 and ends there for 1. Rotated texts run upwards.
  struct Text {
    std::string markup;
    double x, y;
    Font font;
    double align = 0;
    bool rotated = false;
  };
  struct Line {
    DevicePoint from, to;
  };
  /// An entry of the legend: a disc at a position, or a piece of a curve.
  struct Key {
    DevicePoint from, to;
    Colour colour;
    bool line, dashed;
  };
  struct Bar {
    DeviceBox area;
    ColourMap map;
    bool some;  ///< true if there are values; otherwise it has the colour in the middle of the map
  };

  DeviceBox box;  ///< the frame, or the area that it would enclose
  AxisRange x, y;
  std::vector<double> x_grid, y_grid;  ///< positions of the grid lines
  double frame_line, grid_line;        ///< widths
  std::vector<DeviceBox> rims;         ///< of the frame and of colour bars
  std::vector<Line> marks;             ///< at their ticks
  std::vector<Bar> bars;
  std::vector<Key> keys;
  std::vector<Text> texts, notes;
};

/// Plans a flat canvas on paper.
FigurePlan plan_figure(Canvas const& canvas, Paper const& paper, TextWidth const& width);

}  // namespace boltzmann
