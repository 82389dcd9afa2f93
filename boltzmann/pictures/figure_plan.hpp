// What stands around a drawing, and where: frame, ticks, titles, legend, colour bars and notes. Nothing is drawn here,
// and how wide letters are is asked of whoever draws. As window/web/src/paint/figure.ts has it;
// tests/window/layouts.json holds both to it.
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

/// A font is so many device units high.
struct Font {
  double size;
  bool bold = false;
};

/// How wide a text with raised and lowered parts is.
using TextWidth = std::function<double(std::string_view markup, Font font)>;

/// The lines of a text that is broken at spaces so that each is at most `most` wide (a longer word stands alone).
std::vector<std::string> wrapped(std::string_view markup, double most, Font font, TextWidth const& width);

/// The paper of a figure, in device units; `unit` of them are a pixel of a picture of 1200 x 900, in which the fonts of
/// the title and of notes are given. On whole pixels thin lines are crisp.
struct Paper {
  double width, height, unit;
  bool whole_pixels = true;
  double heading = 25, note = 16.5;
};

/// All that stands around a drawing, in device units; texts in their order.
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
  /// An entry of the legend: a disc at a place, or a piece of a curve.
  struct Key {
    DevicePoint from, to;
    Colour colour;
    bool line, dashed;
  };
  struct Bar {
    DeviceBox area;
    ColourMap map;
    bool some;  ///< values; else it has the colour in the middle of the map
  };

  DeviceBox box;  ///< the frame, or what it would enclose
  AxisRange x, y;
  std::vector<double> x_grid, y_grid;  ///< where lines of a grid run through it
  double frame_line, grid_line;        ///< their widths
  std::vector<DeviceBox> rims;         ///< of the frame and of colour bars
  std::vector<Line> marks;             ///< at their ticks
  std::vector<Bar> bars;
  std::vector<Key> keys;
  std::vector<Text> texts, notes;
};

/// A flat canvas on paper.
FigurePlan plan_figure(Canvas const& canvas, Paper const& paper, TextWidth const& width);

}  // namespace boltzmann
