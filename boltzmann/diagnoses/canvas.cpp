// Recording on a canvas.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/canvas.hpp>

#include <algorithm>
#include <cmath>
#include <initializer_list>
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

void Canvas::circle(double x, double y, double radius, Colour colour, bool filled) {
  circle(Circle{x, y, radius, colour, filled});
}

void Canvas::circle(Circle const& circle) {
  if (!finite({circle.x, circle.y, circle.radius})) {
    ++not_finite_;
    return;
  }
  record(Kind::circle, circles_.size());
  circles_.push_back(circle);
  circles_.back().radius = std::abs(circle.radius);
}

void Canvas::point(double x, double y, Colour colour, float size) {
  if (!finite({x, y})) {
    ++not_finite_;
    return;
  }
  record(Kind::point, points_.size());
  points_.push_back({x, y, size, colour});
}

void Canvas::line(double x0, double y0, double x1, double y1, Colour colour, float width) {
  if (!finite({x0, y0, x1, y1})) {
    ++not_finite_;
    return;
  }
  record(Kind::line, lines_.size());
  lines_.push_back({x0, y0, x1, y1, width, colour});
}

void Canvas::rectangle(double x0, double y0, double x1, double y1, Colour colour, float width) {
  line(x0, y0, x1, y0, colour, width);
  line(x1, y0, x1, y1, colour, width);
  line(x1, y1, x0, y1, colour, width);
  line(x0, y1, x0, y0, colour, width);
}

void Canvas::arrow(double x0, double y0, double x1, double y1, Colour colour, float width) {
  if (!finite({x0, y0, x1, y1})) {
    ++not_finite_;
    return;
  }
  record(Kind::arrow, arrows_.size());
  arrows_.push_back({x0, y0, x1, y1, width, colour});
}

void Canvas::curve(std::span<double const> x, std::span<double const> y, Colour colour, std::string label, float width,
                   bool dashed) {
  if (x.size() != y.size())
    throw Error("a curve needs as many y as x, found " + std::to_string(x.size()) + " x and " +
                std::to_string(y.size()) + " y" + (label.empty() ? "" : " in '" + label + "'"));
  for (std::size_t i = 0; i < x.size(); ++i)
    if (!finite({x[i], y[i]})) ++not_finite_;
  record(Kind::curve, curves_.size());
  curves_.push_back({{x.begin(), x.end()}, {y.begin(), y.end()}, width, colour, std::move(label), dashed});
}

void Canvas::text(double x, double y, std::string text, Colour colour, float size, double align) {
  if (!finite({x, y})) {
    ++not_finite_;
    return;
  }
  record(Kind::text, texts_.size());
  texts_.push_back({x, y, std::move(text), size, colour, align});
}

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

void Canvas::axes(Axis x, Axis y) {
  x_axis_ = std::move(x);
  y_axis_ = std::move(y);
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
