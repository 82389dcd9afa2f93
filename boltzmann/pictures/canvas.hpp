// Canvas: the drawing surface of diagnoses. It records circles, points, lines, arrows, curves, texts and images in
// simulation units.
//
// The record is independent of pixels, files and browsers: figure.hpp renders it to pictures, the window sends it to a
// page. Marks with coordinates that are not finite are omitted and counted (a curve gets a gap). Labels are UTF-8;
// ^{...} raises, _{...} lowers.
//
// A canvas is flat, or a space seen through a projection. In a space marks have a z, and projection.hpp converts it to
// a flat canvas.
#pragma once

#include <boltzmann/pictures/colour.hpp>

#include <array>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann {

/// The title of an axis, "label (unit)", and its range low..high. NaN is automatic, from the content.
struct Axis {
  std::string label, unit;
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
  bool logarithmic = false;
  double factor = 1;  ///< the numbers at the ticks are coordinates times this, in `unit`
};

/// The direction of view in three dimensions, in degrees: azimuth around the z axis (0 = along x), elevation above the
/// xy plane (90 = from above). Parallel projection, z is up.
struct Projection {
  double azimuth = 35, elevation = 22;

  struct Place {
    double right, up, near;
  };
  /// The projected position in the picture, and its depth.
  Place operator()(double x, double y, double z) const;
};

class Canvas {
 public:
  /// Many discs at once, for the particles of one ensemble, in single precision. Particle k is drawn at origin + scale
  /// * position[k], axis by axis.
  struct Cloud {
    int dimension = 2;  ///< 2 or 3: numbers per particle in `position`
    std::array<double, 3> origin{0, 0, 0}, scale{1, 1, 1};
    std::vector<float> position;
    std::vector<float> value;  ///< position in the colour map, 0..1 (NaN: no value); empty: all have `colour`
    ColourMap map = ColourMap::viridis;
    Colour colour = ink;
    std::vector<float> diameter;  ///< per particle, in units of the x axis; empty: all have common_diameter
    double common_diameter = 0;   ///< 0 (and no diameters): points, `size` pixels wide
    float size = 4;
    bool shaded = false;                ///< shaded like spheres
    std::string ensemble;               ///< name of the ensemble; with the number it identifies a particle
    std::vector<std::uint32_t> number;  ///< number of each particle in its ensemble; empty: 0, 1, 2, ...
    std::uint32_t stride = 1;           ///< one of this number of particles is shown

    std::size_t count() const { return position.size() / static_cast<std::size_t>(dimension); }
  };
  // Marks: x, y, z are coordinates of the axes, in the simulation's units (not times Axis::factor). Widths and sizes
  // are pixels of a picture of 1200 x 900.
  /// radius in units of the x axis. Shaded circles look like spheres. depth: 0 (near) to 1 (far, faded towards the
  /// paper).
  struct Circle {
    double x = 0, y = 0, radius = 0;
    Colour colour = ink;
    bool filled = true;
    bool shaded = false;
    float depth = 0;
    double z = 0;
  };
  /// A disc; size is its diameter.
  struct Point {
    double x = 0, y = 0;
    float size = 4;
    Colour colour = ink;
    double z = 0;
  };
  struct Line {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    float width = 1.5F;
    Colour colour = ink;
    double z0 = 0, z1 = 0;
  };
  struct Arrow {
    double x0 = 0, y0 = 0, x1 = 0, y1 = 0;
    float width = 1.5F;
    Colour colour = ink;
    double z0 = 0, z1 = 0;
  };
  /// A label adds the curve to the legend.
  struct Curve {
    std::vector<double> x = {}, y = {};
    float width = 2;
    Colour colour = ink;
    std::string label = {};
    bool dashed = false;
    std::vector<double> z = {};  ///< empty: 0
  };
  /// align: 0 = the text begins at x, 0.5 = it is centred there, 1 = it ends there. It is vertically centred at y.
  struct Text {
    double x = 0, y = 0;
    std::string text = {};
    float size = 20;
    Colour colour = ink;
    double align = 0.5;
    double z = 0;
  };
  /// columns x rows cells between the corners (x0, y0) and (x1, y1); pixels are 0xAARRGGBB, row by row from y0 on.
  struct Image {
    double x0, y0, x1, y1;
    int columns, rows;
    std::vector<std::uint32_t> pixels;
  };
  struct ColourBar {
    std::string label, unit;
    double low, high;
    ColourMap map;
    double factor = 1;  ///< the numbers at the ticks are values times this, in `unit`
  };
  struct LegendEntry {
    std::string label;
    Colour colour;
  };
  enum class Kind : std::uint8_t { circle, point, line, arrow, curve, text, image, cloud };
  /// An item of the drawing order: `count` elements of one list, from `first` on.
  struct Run {
    Kind kind;
    std::size_t first, count;
  };

  // Drawing: later marks cover earlier ones. In a space, pass marks with a z: canvas.point({.x = 1, .y = 2, .z = 3}).
  void circle(double x, double y, double radius, Colour colour = ink, bool filled = true);
  void circle(Circle circle);
  void point(double x, double y, Colour colour = ink, float size = 4);
  void point(Point const& point);
  void line(double x0, double y0, double x1, double y1, Colour colour = ink, float width = 1.5F);
  void line(Line const& line);
  void rectangle(double x0, double y0, double x1, double y1, Colour colour = ink, float width = 1.5F);
  void arrow(double x0, double y0, double x1, double y1, Colour colour = ink, float width = 1.5F);
  void arrow(Arrow const& arrow);
  /// Throws Error if x and y (and z, if given) differ in length.
  void curve(std::span<double const> x, std::span<double const> y, Colour colour = ink, std::string label = "",
             float width = 2, bool dashed = false);
  void curve(Curve curve);
  void text(double x, double y, std::string text, Colour colour = ink, float size = 20, double align = 0.5);
  void text(Text const& text);
  /// `values` holds columns x rows numbers, row by row from y0 on, coloured from low to high. Throws Error if the count
  /// differs.
  void image(double x0, double y0, double x1, double y1, int columns, int rows, std::span<double const> values,
             double low, double high, ColourMap map = ColourMap::viridis);

  /// Throws Error if its arrays have inconsistent sizes. Particles with a position that is not finite are kept, not
  /// drawn, and counted, unless the caller passes their number.
  void cloud(Cloud cloud, std::optional<std::size_t> not_finite = {});
  /// Moves the clouds out, to recycle their memory. The canvas must not be used afterwards.
  std::vector<Cloud> take_clouds() { return std::move(clouds_); }

  // Axes and texts around the drawing.
  void axes(Axis x, Axis y);
  /// Makes the canvas a space, seen through `projection`. Its box extends from low to high of each axis (NaN: around
  /// the content).
  void axes(Axis x, Axis y, Axis z, Projection const& projection = {});
  /// If `equal`, x and y have the same scale.
  void equal_aspect(bool equal) { equal_aspect_ = equal; }
  void grid(bool shown) { grid_ = shown; }
  /// Without a frame, ticks and axis titles are not drawn either (projections).
  void frame(bool shown) { frame_ = shown; }
  void colour_bar(std::string label, std::string unit, double low, double high, ColourMap map = ColourMap::viridis,
                  double factor = 1);
  void legend(std::string label, Colour colour);
  void title(std::string title) { title_ = std::move(title); }
  /// Adds a line of text below the drawing.
  void note(std::string line) { notes_.push_back(std::move(line)); }

  // The record.
  std::vector<Circle> const& circles() const { return circles_; }
  std::vector<Point> const& points() const { return points_; }
  std::vector<Line> const& lines() const { return lines_; }
  std::vector<Arrow> const& arrows() const { return arrows_; }
  std::vector<Curve> const& curves() const { return curves_; }
  std::vector<Text> const& texts() const { return texts_; }
  std::vector<Image> const& images() const { return images_; }
  std::vector<Cloud> const& clouds() const { return clouds_; }
  std::vector<Run> const& order() const { return order_; }
  std::vector<ColourBar> const& colour_bars() const { return colour_bars_; }
  std::vector<LegendEntry> const& legend_entries() const { return legend_; }
  std::vector<std::string> const& notes() const { return notes_; }
  std::string const& title() const { return title_; }
  Axis const& x_axis() const { return x_axis_; }
  Axis const& y_axis() const { return y_axis_; }
  Axis const& z_axis() const { return z_axis_; }
  /// The projection of a space; nothing if the canvas is flat.
  std::optional<Projection> const& projection() const { return projection_; }
  bool equal_aspect() const { return equal_aspect_; }
  bool grid() const { return grid_; }
  bool frame() const { return frame_; }
  /// The number of elements, nodes of curves and particles of clouds with a coordinate that is NaN or infinite.
  std::size_t not_finite() const { return not_finite_; }
  void not_finite(std::size_t count) { not_finite_ = count; }

 private:
  void record(Kind kind, std::size_t index);
  template <class Mark>
  void add(Kind kind, std::vector<Mark>& marks, Mark mark, std::initializer_list<double> coordinates);

  std::vector<Circle> circles_;
  std::vector<Point> points_;
  std::vector<Line> lines_;
  std::vector<Arrow> arrows_;
  std::vector<Curve> curves_;
  std::vector<Text> texts_;
  std::vector<Image> images_;
  std::vector<Cloud> clouds_;
  std::vector<Run> order_;
  std::vector<ColourBar> colour_bars_;
  std::vector<LegendEntry> legend_;
  std::vector<std::string> notes_;
  std::string title_;
  Axis x_axis_, y_axis_, z_axis_;
  std::optional<Projection> projection_;
  bool equal_aspect_ = false, grid_ = false, frame_ = true;
  std::size_t not_finite_ = 0;
};

/// The relative position of a value in low..high as 0..1, for map_colour; 0.5 if low = high, NaN for NaN.
double place_between(double low, double high, double value);

}  // namespace boltzmann
