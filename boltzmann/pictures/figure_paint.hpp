// Draws the marks of a canvas on a Cairo surface, in device units. Private to the figure sources (needs Cairo).
#pragma once

#include <cairo.h>
#include <boltzmann/pictures/colour.hpp>
#include <boltzmann/pictures/figure_plan.hpp>

#include <cstdint>
#include <vector>

namespace boltzmann {

/// The style of a disc: its fill and, if wider than 0, a rim inside its radius.
struct DiscStyle {
  Colour fill, rim = {};
  double rim_width = 0;
  bool hollow = false;
  bool shaded = false;
};

/// Draws discs, lines, arrows, curves and images, clipped to a box. Discs on raster surfaces are computed directly
/// (exact coverage, a hundred thousand in a fraction of a second); everything else uses Cairo.
class Painter {
 public:
  Painter(cairo_t* cairo, DeviceBox clip);
  ~Painter();
  Painter(Painter const&) = delete;
  Painter& operator=(Painter const&) = delete;

  void disc(DevicePoint centre, double radius, DiscStyle const& style);
  void line(DevicePoint from, DevicePoint to, double width, Colour colour);
  void arrow(DevicePoint from, DevicePoint to, double width, double head, Colour colour);
  /// A connected section of a curve. Many nodes within half a device unit are reduced to first, lowest, highest and
  /// last.
  void curve(std::vector<DevicePoint> const& nodes, double width, Colour colour, double dash);
  /// pixels are 0xAARRGGBB, row by row from the side of `first_corner` to the other.
  void image(DevicePoint first_corner, DevicePoint last_corner, int columns, int rows,
             std::vector<std::uint32_t> const& pixels);
  /// Writes pending drawing to the surface; call it before other code draws.
  void flush();

 private:
  void begin_pixels();
  void disc_on_pixels(DevicePoint centre, double radius, DiscStyle const& style);
  void disc_on_paths(DevicePoint centre, double radius, DiscStyle const& style);
  void pen(double width, Colour colour);

  cairo_t* cairo_;
  cairo_surface_t* surface_;
  DeviceBox clip_;
  bool pixels_, drawing_pixels_ = false;
  // Pending lines and small discs of one colour and width, to be stroked together.
  bool pending_ = false;
  double pending_width_ = 0;
  int pending_count_ = 0;
  Colour pending_colour_;
};

void set_colour(cairo_t* cairo, Colour colour);

}  // namespace boltzmann
