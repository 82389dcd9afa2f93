// Recording on a canvas.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/canvas.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

bool finite(std::initializer_list<double> values) {
  return std::all_of(values.begin(), values.end(), [](double v) { return std::isfinite(v); });
}

std::uint32_t packed(Colour colour) {
  auto byte = [](float v) { return static_cast<std::uint32_t>(std::lround(std::clamp(v, 0.0F, 1.0F) * 255)); };
  return byte(colour.alpha) << 24 | byte(colour.red) << 16 | byte(colour.green) << 8 | byte(colour.blue);
}

}  // namespace

void Canvas::record(Kind kind, std::size_t index) {
  if (!order_.empty() && order_.back().kind == kind)
    ++order_.back().count;
  else
    order_.push_back({kind, index, 1});
}

template <class Mark>
void Canvas::add(Kind kind, std::vector<Mark>& marks, Mark mark, std::initializer_list<double> coordinates) {
  if (!finite(coordinates)) {
    ++not_finite_;
    return;
  }
  record(kind, marks.size());
  marks.push_back(std::move(mark));
}

void Canvas::circle(double x, double y, double radius, Colour colour, bool filled) {
  circle(Circle{x, y, radius, colour, filled});
}

void Canvas::circle(Circle circle) {
  circle.radius = std::abs(circle.radius);
  add(Kind::circle, circles_, circle, {circle.x, circle.y, circle.z, circle.radius});
}

void Canvas::point(double x, double y, Colour colour, float size) { point(Point{x, y, size, colour}); }

void Canvas::point(Point const& point) { add(Kind::point, points_, point, {point.x, point.y, point.z}); }

void Canvas::line(double x0, double y0, double x1, double y1, Colour colour, float width) {
  line(Line{x0, y0, x1, y1, width, colour});
}

void Canvas::line(Line const& line) {
  add(Kind::line, lines_, line, {line.x0, line.y0, line.z0, line.x1, line.y1, line.z1});
}

void Canvas::rectangle(double x0, double y0, double x1, double y1, Colour colour, float width) {
  line(x0, y0, x1, y0, colour, width);
  line(x1, y0, x1, y1, colour, width);
  line(x1, y1, x0, y1, colour, width);
  line(x0, y1, x0, y0, colour, width);
}

void Canvas::arrow(double x0, double y0, double x1, double y1, Colour colour, float width) {
  arrow(Arrow{x0, y0, x1, y1, width, colour});
}

void Canvas::arrow(Arrow const& arrow) {
  add(Kind::arrow, arrows_, arrow, {arrow.x0, arrow.y0, arrow.z0, arrow.x1, arrow.y1, arrow.z1});
}

void Canvas::curve(std::span<double const> x, std::span<double const> y, Colour colour, std::string label, float width,
                   bool dashed) {
  curve(Curve{{x.begin(), x.end()}, {y.begin(), y.end()}, width, colour, std::move(label), dashed});
}

void Canvas::curve(Curve curve) {
  auto const in = [&] { return curve.label.empty() ? "" : " in '" + curve.label + "'"; };
  if (curve.x.size() != curve.y.size())
    throw Error("a curve needs as many y as x, found " + std::to_string(curve.x.size()) + " x and " +
                std::to_string(curve.y.size()) + " y" + in());
  if (!curve.z.empty() && curve.z.size() != curve.x.size())
    throw Error("a curve needs as many z as x, found " + std::to_string(curve.x.size()) + " x and " +
                std::to_string(curve.z.size()) + " z" + in());
  for (std::size_t i = 0; i < curve.x.size(); ++i)
    if (!finite({curve.x[i], curve.y[i], curve.z.empty() ? 0 : curve.z[i]})) ++not_finite_;
  record(Kind::curve, curves_.size());
  curves_.push_back(std::move(curve));
}

void Canvas::text(double x, double y, std::string text, Colour colour, float size, double align) {
  this->text(Text{x, y, std::move(text), size, colour, align});
}

void Canvas::text(Text const& text) { add(Kind::text, texts_, text, {text.x, text.y, text.z}); }

void Canvas::image(double x0, double y0, double x1, double y1, int columns, int rows, std::span<double const> values,
                   double low, double high, ColourMap map) {
  if (columns < 0 || rows < 0 || values.size() != static_cast<std::size_t>(columns) * static_cast<std::size_t>(rows))
    throw Error("an image of " + std::to_string(columns) + " x " + std::to_string(rows) + " cells can't be made of " +
                std::to_string(values.size()) + " values");
  if (!finite({x0, y0, x1, y1})) {
    ++not_finite_;
    return;
  }
  Image image{x0, y0, x1, y1, columns, rows, {}};
  image.pixels.reserve(values.size());
  for (double value : values) image.pixels.push_back(packed(map_colour(map, place_between(low, high, value))));
  record(Kind::image, images_.size());
  images_.push_back(std::move(image));
}

void Canvas::cloud(Cloud cloud, std::optional<std::size_t> not_finite) {
  if (cloud.dimension != 2 && cloud.dimension != 3)
    throw Error("a cloud has 2 or 3 numbers for each particle, not " + std::to_string(cloud.dimension));
  if (cloud.position.size() % static_cast<std::size_t>(cloud.dimension) != 0)
    throw Error("a cloud needs " + std::to_string(cloud.dimension) + " numbers for each particle, found " +
                std::to_string(cloud.position.size()));
  auto const fits = [&](std::size_t found, char const* what) {
    if (found != 0 && found != cloud.count())
      throw Error("a cloud of " + std::to_string(cloud.count()) + " particles can't use " + std::to_string(found) +
                  " numbers for " + what);
  };
  fits(cloud.value.size(), "the value");
  fits(cloud.diameter.size(), "the diameter");
  fits(cloud.number.size(), "the number");
  if (!not_finite) {
    not_finite = 0;
    auto const dimension = static_cast<std::size_t>(cloud.dimension);
    for (std::size_t i = 0; i < cloud.position.size(); i += dimension) {
      bool whole = true;
      for (std::size_t a = 0; a < dimension; ++a) whole = whole && std::isfinite(cloud.position[i + a]);
      *not_finite += !whole;
    }
  }
  not_finite_ += *not_finite;
  record(Kind::cloud, clouds_.size());
  clouds_.push_back(std::move(cloud));
}

void Canvas::axes(Axis x, Axis y) {
  x_axis_ = std::move(x);
  y_axis_ = std::move(y);
  projection_.reset();
}

void Canvas::axes(Axis x, Axis y, Axis z, Projection const& projection) {
  axes(std::move(x), std::move(y));
  z_axis_ = std::move(z);
  projection_ = projection;
}

void Canvas::colour_bar(std::string label, std::string unit, double low, double high, ColourMap map, double factor) {
  colour_bars_.push_back({std::move(label), std::move(unit), low, high, map, factor});
}

void Canvas::legend(std::string label, Colour colour) { legend_.push_back({std::move(label), colour}); }

double place_between(double low, double high, double value) {
  if (std::isnan(value)) return value;
  if (!(high > low)) return 0.5;
  return std::clamp(value / 2 - low / 2, -1e300, 1e300) / (high / 2 - low / 2);
}

}  // namespace boltzmann
