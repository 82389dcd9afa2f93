// A page for drawing: a Cairo surface with a size. Private to the figure sources.
#pragma once

#include <boltzmann/pictures/figure.hpp>

typedef struct _cairo cairo_t;

namespace boltzmann {

/// width and height in device units; `unit` device units are one pixel of a picture of 1200 x 900.
struct Page {
  cairo_t* cairo;
  double width, height, unit;
  bool dark;
};

/// Draws the canvas with axes and texts; a space through its projection.
void draw_page(Canvas const& canvas, Page const& page);

/// The position of the frame in draw_page(), in device units.
PictureLayout layout_of(Canvas const& canvas, Page const& page);

}  // namespace boltzmann
