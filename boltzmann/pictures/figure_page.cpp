// Draws a canvas with its axes and texts on a page.
#include <boltzmann/pictures/figure_page.hpp>
#include <boltzmann/pictures/figure_paint.hpp>
#include <boltzmann/pictures/figure_plan.hpp>
#include <boltzmann/pictures/figure_text.hpp>
#include <boltzmann/pictures/projection.hpp>

#include <algorithm>
#include <cmath>
#include <optional>

namespace boltzmann {
namespace {

struct Theme {
  Colour paper, ink, quiet, grid, rim;
  double rim_strength;
};

constexpr Theme light{
    {1, 1, 1, 1}, {0.11F, 0.12F, 0.14F, 1}, {0.36F, 0.38F, 0.42F, 1}, {0.90F, 0.91F, 0.92F, 1}, {0, 0, 0, 1}, 0.42};
constexpr Theme dark{{0.075F, 0.085F, 0.105F, 1},
                     {0.90F, 0.91F, 0.93F, 1},
                     {0.62F, 0.65F, 0.70F, 1},
                     {0.17F, 0.185F, 0.215F, 1},
                     {1, 1, 1, 1},
                     0.22};

class Figure {
 public:
  Figure(Canvas const& canvas, Page const& page)
      : canvas_(canvas),
        cairo_(page.cairo),
        unit_(page.unit),
        theme_(page.dark ? dark : light),
        raster_(cairo_surface_get_type(cairo_get_target(page.cairo)) == CAIRO_SURFACE_TYPE_IMAGE),
        text_(page.cairo, raster_),
        paper_{page.width, page.height, page.unit, raster_},
        plan_(plan_figure(canvas, paper_,
                          [this](std::string_view markup, Font font) { return text_.width(markup, font); })) {}

  PictureLayout layout() const {
    auto const& box = plan_.box;
    return {box.left, box.top, box.width, box.height, plan_.x, plan_.y};
  }

  void draw() {
    set_colour(cairo_, theme_.paper);
    cairo_paint(cairo_);
    if (canvas_.frame() && canvas_.grid()) draw_grid();
    draw_content();
    for (auto const& bar : plan_.bars) draw_colour_bar(bar);
    draw_frames();
    for (auto const& key : plan_.keys) draw_key(key);
    set_colour(cairo_, theme_.ink);
    for (auto const& text : plan_.texts) text_.draw(text);
    set_colour(cairo_, theme_.quiet);
    for (auto const& note : plan_.notes) text_.draw(note);
  }

 private:
  double length(double pixels) const { return pixels * unit_; }
  Colour shown(Colour colour) const { return is_ink(colour) ? with_alpha(theme_.ink, colour.alpha) : colour; }

  DevicePoint place(double x, double y) const {
    auto limited = [](double v) { return std::clamp(v, -1e9, 1e9); };
    auto const& box = plan_.box;
    return {limited(box.left + plan_.x.place(x) * box.width), limited(box.bottom() - plan_.y.place(y) * box.height)};
  }

  void draw_grid() const {
    auto const& box = plan_.box;
    set_colour(cairo_, theme_.grid);
    cairo_set_line_width(cairo_, plan_.grid_line);
    for (double const x : plan_.x_grid) {
      cairo_move_to(cairo_, x, box.top);
      cairo_line_to(cairo_, x, box.bottom());
    }
    for (double const y : plan_.y_grid) {
      cairo_move_to(cairo_, box.left, y);
      cairo_line_to(cairo_, box.right(), y);
    }
    cairo_stroke(cairo_);
  }

  void draw_content() const {
    Painter painter(cairo_, canvas_.frame() ? plan_.box : DeviceBox{0, 0, paper_.width, paper_.height});
    for (auto const& run : canvas_.order())
      for (std::size_t i = run.first; i < run.first + run.count; ++i) switch (run.kind) {
          case Canvas::Kind::circle:
            draw_circle(painter, canvas_.circles()[i]);
            break;
          case Canvas::Kind::point:
            draw_point(painter, canvas_.points()[i]);
            break;
          case Canvas::Kind::line:
            draw_line(painter, canvas_.lines()[i]);
            break;
          case Canvas::Kind::arrow:
            draw_arrow(painter, canvas_.arrows()[i]);
            break;
          case Canvas::Kind::curve:
            draw_curve(painter, canvas_.curves()[i]);
            break;
          case Canvas::Kind::text:
            draw_text(painter, canvas_.texts()[i]);
            break;
          case Canvas::Kind::image:
            draw_image(painter, canvas_.images()[i]);
            break;
          case Canvas::Kind::cloud:
            draw_cloud(painter, canvas_.clouds()[i]);
            break;
        }
  }

  bool shows(double x, double y) const { return plan_.x.shows(x) && plan_.y.shows(y); }

  void draw_circle(Painter& painter, Canvas::Circle const& circle) const {
    if (!shows(circle.x, circle.y)) return;
    DevicePoint const centre = place(circle.x, circle.y);
    double const radius = std::abs(place(circle.x + circle.radius, circle.y).x - centre.x);
    double const fade = 0.5 * std::clamp(circle.depth, 0.0F, 1.0F);
    auto faded = [&](Colour c) { return mixed(c, with_alpha(theme_.paper, c.alpha), fade); };
    Colour const colour = shown(circle.colour);
    DiscStyle style{.fill = faded(colour),
                    .rim = faded(mixed(colour, with_alpha(theme_.rim, colour.alpha), theme_.rim_strength))};
    if (!circle.filled) {
      style.hollow = true;
      style.rim = faded(colour);
      style.rim_width = length(1.6);
    } else if (radius >= length(3)) {
      style.shaded = circle.shaded;
      style.rim_width = std::clamp(0.09 * radius, length(0.8), length(1.5));
    }
    painter.disc(centre, radius, style);
  }

  void draw_point(Painter& painter, Canvas::Point const& point) const {
    if (shows(point.x, point.y))
      painter.disc(place(point.x, point.y), length(point.size) / 2, {.fill = shown(point.colour)});
  }

  // Draws each particle as a circle or a point.
  void draw_cloud(Painter& painter, Canvas::Cloud const& cloud) const {
    auto const dimension = static_cast<std::size_t>(cloud.dimension);
    bool const sized = !cloud.diameter.empty() || cloud.common_diameter != 0;
    for (std::size_t i = 0; i < cloud.count(); ++i) {
      double const x = cloud.origin[0] + cloud.scale[0] * static_cast<double>(cloud.position[dimension * i]);
      double const y = cloud.origin[1] + cloud.scale[1] * static_cast<double>(cloud.position[dimension * i + 1]);
      if (!std::isfinite(x) || !std::isfinite(y)) continue;
      Colour const colour =
          cloud.value.empty() ? cloud.colour : map_colour(cloud.map, static_cast<double>(cloud.value[i]));
      double const diameter = cloud.diameter.empty() ? cloud.common_diameter : static_cast<double>(cloud.diameter[i]);
      if (!sized)
        draw_point(painter, {x, y, cloud.size, colour});
      else if (std::isfinite(diameter))
        draw_circle(painter, {x, y, std::abs(diameter) / 2, colour, true, cloud.shaded});
    }
  }

  void draw_line(Painter& painter, Canvas::Line const& l) const {
    if (shows(l.x0, l.y0) && shows(l.x1, l.y1))
      painter.line(place(l.x0, l.y0), place(l.x1, l.y1), length(l.width), shown(l.colour));
  }

  void draw_arrow(Painter& painter, Canvas::Arrow const& a) const {
    if (shows(a.x0, a.y0) && shows(a.x1, a.y1))
      painter.arrow(place(a.x0, a.y0), place(a.x1, a.y1), length(a.width), length(5 + 4 * a.width), shown(a.colour));
  }

  void draw_curve(Painter& painter, Canvas::Curve const& curve) const {
    std::vector<DevicePoint> stretch;
    auto finish = [&] {
      if (!stretch.empty())
        painter.curve(stretch, length(curve.width), shown(curve.colour),
                      curve.dashed ? length(5 + 2.5 * curve.width) : 0);
      stretch.clear();
    };
    for (std::size_t i = 0; i < curve.x.size(); ++i) {
      if (std::isfinite(curve.x[i]) && std::isfinite(curve.y[i]) && shows(curve.x[i], curve.y[i]))
        stretch.push_back(place(curve.x[i], curve.y[i]));
      else
        finish();
    }
    finish();
  }

  void draw_text(Painter& painter, Canvas::Text const& text) const {
    if (!shows(text.x, text.y)) return;
    painter.flush();
    DevicePoint const at = place(text.x, text.y);
    if (std::abs(at.x) > 1e5 || std::abs(at.y) > 1e5) return;
    set_colour(cairo_, shown(text.colour));
    text_.draw({text.text, at.x, at.y + 0.36 * length(text.size), {length(text.size)}, text.align});
  }

  void draw_image(Painter& painter, Canvas::Image const& image) const {
    if (!shows(image.x0, image.y0) || !shows(image.x1, image.y1)) return;
    painter.image(place(image.x0, image.y0), place(image.x1, image.y1), image.columns, image.rows, image.pixels);
  }

  void draw_frames() const {
    set_colour(cairo_, theme_.ink);
    cairo_set_line_width(cairo_, plan_.frame_line);
    cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_BUTT);
    for (auto const& rim : plan_.rims) {
      cairo_rectangle(cairo_, rim.left, rim.top, rim.width, rim.height);
      cairo_stroke(cairo_);
    }
    for (auto const& mark : plan_.marks) {
      cairo_move_to(cairo_, mark.from.x, mark.from.y);
      cairo_line_to(cairo_, mark.to.x, mark.to.y);
    }
    cairo_stroke(cairo_);
  }

  void draw_key(FigurePlan::Key const& key) const {
    Painter marks(cairo_, {0, 0, paper_.width, paper_.height});
    if (key.line)
      marks.curve({key.from, key.to}, length(3), shown(key.colour), key.dashed ? length(8) : 0);
    else
      marks.disc(key.from, length(7.5), {.fill = with_alpha(shown(key.colour), 1)});
  }

  void draw_colour_bar(FigurePlan::Bar const& bar) const {
    constexpr int steps = 256;
    std::vector<std::uint32_t> pixels;
    pixels.reserve(steps);
    for (int i = 0; i < steps; ++i) {
      Colour const c = map_colour(bar.map, bar.some ? (i + 0.5) / steps : 0.5);
      auto byte = [](float v) { return static_cast<std::uint32_t>(std::lround(v * 255)); };
      pixels.push_back(0xff000000U | byte(c.red) << 16 | byte(c.green) << 8 | byte(c.blue));
    }
    auto const& area = bar.area;
    Painter(cairo_, area).image({area.left, area.bottom()}, {area.right(), area.top}, 1, steps, pixels);
  }

  Canvas const& canvas_;
  cairo_t* cairo_;
  double unit_;
  Theme theme_;
  bool raster_;
  TextPen text_;
  Paper paper_;
  FigurePlan plan_;
};

// Flattens a space by its projection.
Canvas const& flat(Canvas const& canvas, std::optional<Canvas>& seen) {
  return canvas.projection() ? seen.emplace(flattened(canvas)) : canvas;
}

}  // namespace

void draw_page(Canvas const& canvas, Page const& page) {
  std::optional<Canvas> seen;
  Figure(flat(canvas, seen), page).draw();
}

PictureLayout layout_of(Canvas const& canvas, Page const& page) {
  std::optional<Canvas> seen;
  return Figure(flat(canvas, seen), page).layout();
}

}  // namespace boltzmann
