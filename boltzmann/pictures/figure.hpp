// Figures: renders a canvas as PNG, SVG or PDF. A space is shown through its projection.
#pragma once

#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/pictures/figure_layout.hpp>

#include <string>

namespace boltzmann {

/// width and height in pixels. With scale = 2 the same picture has twice as many pixels in each direction (for print).
/// Text, lines and points keep their size relative to the picture: at 1200 x 900 sizes are as recorded.
struct FigureOptions {
  int width = 1200, height = 900;
  double scale = 1;
  bool dark = false;
};

/// True if a path ends in .png, .svg or .pdf.
bool ends_as_picture(std::string const& path);

/// Writes the canvas with frame, ticks, axis titles, legend, colour bars and notes, in the format of the extension of
/// the path. The page of a PDF is width x height at 150 pixels per inch, times scale. The picture is first written to
/// path + ".part" and then renamed, so that no incomplete picture remains at `path`. Throws Error if the extension is
/// unknown, if the path can't be written (with path and reason) or if the size is not within 16..20000 pixels after
/// scaling.
void write_picture(Canvas const& canvas, std::string const& path, FigureOptions const& options = {});

/// The same picture in memory: the bytes of a file. `format` is "png", "svg" or "pdf". Throws Error for any other, and
/// as above.
std::string picture_bytes(Canvas const& canvas, std::string const& format, FigureOptions const& options = {});

/// The position of the frame (or of the area that it would enclose) in a PNG, in pixels from the upper left corner, and
/// the ranges of the axes. For a space, those of the flattened canvas.
struct PictureLayout {
  double left, top, width, height;
  AxisRange x, y;
};
PictureLayout layout_of(Canvas const& canvas, FigureOptions const& options = {});

}  // namespace boltzmann
