// Figures: a canvas as a picture for a paper or a page, PNG, SVG or PDF. A space is shown as it is seen through its
// projection.
#pragma once

#include <boltzmann/pictures/canvas.hpp>
#include <boltzmann/pictures/figure_layout.hpp>

#include <string>

namespace boltzmann {

/// width and height in pixels; with scale = 2 the same picture has twice as many pixels each way (for print). Text,
/// lines and points keep their proportion to the picture: at 1200 x 900 their sizes are as recorded.
struct FigureOptions {
  int width = 1200, height = 900;
  double scale = 1;
  bool dark = false;
};

/// Whether a path ends in .png, .svg or .pdf.
bool ends_as_picture(std::string const& path);

/// Writes the canvas with frame, ticks, axis titles, legend, colour bars and notes, as the extension of the path says;
/// the page of a PDF is width x height at 150 pixels per inch, times scale. The picture is first written to path +
/// ".part" and then renamed, so that no half picture is ever left at `path`. Throws Error if the path ends in another
/// way, if it can't be written (names path and reason) or if the size is not within 16..20000 pixels after scaling.
void write_picture(Canvas const& canvas, std::string const& path, FigureOptions const& options = {});

/// The same picture in memory: the bytes of a file. `format` is "png", "svg" or "pdf"; Error on any other, and as
/// above.
std::string picture_bytes(Canvas const& canvas, std::string const& format, FigureOptions const& options = {});

/// Where the frame (or, without a frame, what it would enclose) stands in a PNG, in pixels from the upper left corner,
/// and which part of the axes it shows; for a space those of the flat canvas made of it.
struct PictureLayout {
  double left, top, width, height;
  AxisRange x, y;
};
PictureLayout layout_of(Canvas const& canvas, FigureOptions const& options = {});

}  // namespace boltzmann
