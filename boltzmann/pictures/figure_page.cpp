// Laying a canvas out on a page: margins, ticks, titles, legend and colour bars; and drawing it there.
#include <boltzmann/pictures/canvas_ticks.hpp>
#include <boltzmann/pictures/figure_page.hpp>
#include <boltzmann/pictures/figure_paint.hpp>
#include <boltzmann/pictures/figure_text.hpp>
#include <boltzmann/pictures/projection.hpp>

#include <fmt/format.h>

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

// Sizes in pixels of a picture of 1200 x 900.
namespace size {
constexpr double outer = 20, tick_text = 20, axis_title = 22, heading = 25, legend = 20, note = 16.5;
constexpr double tick = 7, minor_tick = 4, tick_gap = 6, title_gap = 12, frame_line = 1.3, grid_line = 1;
constexpr double bar_gap = 28, bar = 22, legend_row = 31, heading_row = 35, note_row = 23;
}  // namespace size

std::string axis_title(std::string const& label, std::string const& unit) {
  if (unit.empty()) return label;
  return label.empty() ? fmt::format("({})", unit) : fmt::format("{} ({})", label, unit);
}

std::string counted(std::size_t count, std::string const& what) {
  return std::to_string(count) + (count == 1 ? " point " : " points ") + what;
}

struct Key {
  std::string label;
  Colour colour;
  bool line = false, dashed = false;
};

class Figure {
 public:
  Figure(Canvas const& canvas, cairo_t* cairo, double width, double height, double unit, bool is_dark)
      : canvas_(canvas),
        cairo_(cairo),
        width_(width),
        height_(height),
        unit_(unit),
        theme_(is_dark ? dark : light),
        raster_(cairo_surface_get_type(cairo_get_target(cairo)) == CAIRO_SURFACE_TYPE_IMAGE),
        text_(cairo, raster_) {
    for (auto const& entry : canvas.legend_entries()) keys_.push_back({entry.label, entry.colour});
    for (auto const& curve : canvas.curves())
      if (!curve.label.empty()) keys_.push_back({curve.label, curve.colour, true, curve.dashed});
  }

  PictureLayout layout() {
    plan();
    return {box_.left, box_.top, box_.width, box_.height, x_, y_};
  }

  void draw() {
    plan();
    set_colour(cairo_, theme_.paper);
    cairo_paint(cairo_);
    if (canvas_.frame() && canvas_.grid()) draw_grid();
    draw_content();
    if (canvas_.frame()) draw_frame();
    draw_heading();
    double bar_left = box_.right();
    for (std::size_t i = 0; i < bars_.size(); ++i) {
      draw_colour_bar(canvas_.colour_bars()[i], bars_[i], bar_left + size::bar_gap * unit_);
      bar_left += bars_[i].width;
    }
    set_colour(cairo_, theme_.quiet);
    double y = notes_top_;
    for (auto const& line : notes_) text_.draw(line, notes_left_, y += size::note_row * unit_, size::note * unit_);
  }

 private:
  struct Bar {
    Ticks ticks;
    double labels = 0, width = 0;
  };

  double length(double pixels) const { return pixels * unit_; }
  Colour shown(Colour colour) const { return is_ink(colour) ? with_alpha(theme_.ink, colour.alpha) : colour; }
  // On pixels, thin straight lines stand on whole pixels.
  double line_width(double pixels) const {
    return raster_ ? std::max(1.0, std::round(length(pixels))) : length(pixels);
  }
  double crisp(double at, double width) const {
    if (!raster_) return at;
    return static_cast<int>(std::lround(width)) % 2 == 1 ? std::floor(at) + 0.5 : std::round(at);
  }
  double widest(Ticks const& ticks) const {
    double most = 0;
    for (auto const& label : ticks.labels) most = std::max(most, text_.width(label, length(size::tick_text)));
    return most;
  }
  double fitted(std::string const& text, double font, double most) const {
    double const wide = text_.width(text, font);
    return wide > most ? font * most / wide : font;
  }
  bool shares_digits(Ticks const& ticks) const { return ticks.multiplier.find(' ') != std::string::npos; }

  // The most ticks whose labels don't touch.
  Ticks ticks_that_fit(AxisRange const& range, double extent, bool across, int at_most_exponent = 400) const {
    for (int most = 8;; --most) {
      Ticks ticks =
          ticks_between(range.low * range.factor, range.high * range.factor, range.logarithmic, most, at_most_exponent);
      for (auto* values : {&ticks.major, &ticks.minor})
        for (double& value : *values) value /= range.factor;
      bool fits = true;
      double before_at = 0, before_width = 0;
      for (std::size_t i = 0; i < ticks.major.size(); ++i) {
        double const at = range.place(ticks.major[i]) * extent;
        double const wide =
            across ? text_.width(ticks.labels[i], length(size::tick_text)) + length(16) : length(1.7 * size::tick_text);
        if (i > 0 && at - before_at < (wide + before_width) / 2) fits = false;
        before_at = at;
        before_width = wide;
      }
      if (fits || most <= 2) return ticks;
    }
  }

  // The ticks of both axes. With equal units, both count in the same power of ten.
  void choose_ticks(bool equal) {
    x_ticks_ = y_ticks_ = {};
    if (!canvas_.frame()) return;
    x_ticks_ = ticks_that_fit(x_, box_.width, true);
    y_ticks_ = ticks_that_fit(y_, box_.height, false);
    if (!equal || x_ticks_.multiplier.empty() || y_ticks_.multiplier.empty()) return;
    int const exponent = std::min(x_ticks_.exponent, y_ticks_.exponent);
    x_ticks_ = ticks_that_fit(x_, box_.width, true, exponent);
    y_ticks_ = ticks_that_fit(y_, box_.height, false, exponent);
  }

  // Everything's place. Margins depend on tick labels, these on the frame, this on the margins: three rounds settle it.
  void plan() {
    double const outer = length(size::outer);
    bool const framed = canvas_.frame();
    Axis const &x_axis = canvas_.x_axis(), &y_axis = canvas_.y_axis();
    x_title_ = framed ? axis_title(x_axis.label, x_axis.unit) : "";
    y_title_ = framed ? axis_title(y_axis.label, y_axis.unit) : "";
    box_ = {outer, outer, width_ - 2 * outer, height_ - 2 * outer};
    bars_.resize(canvas_.colour_bars().size());
    for (int round = 0; round < 3; ++round) {
      auto const ranges = axis_ranges(canvas_, box_.width / box_.height);
      x_ = ranges[0];
      y_ = ranges[1];
      x_.factor = x_axis.factor;
      y_.factor = y_axis.factor;
      bool const equal = canvas_.equal_aspect() && !x_.logarithmic && !y_.logarithmic;
      if (equal) widen_thin_ranges();
      choose_ticks(equal);
      double const right = plan_right(framed, outer), left = plan_left(framed, outer);
      plan_heading(left, right);
      bool const headed = !keys_.empty() || !title_.empty();
      bool const any_multiplier =
          !y_ticks_.multiplier.empty() ||
          std::any_of(bars_.begin(), bars_.end(), [](Bar const& b) { return !b.ticks.multiplier.empty(); });
      bool const lifted = !y_ticks_.multiplier.empty() && (headed || shares_digits(y_ticks_));
      heading_gap_ = lifted ? length(1.85 * size::tick_text) : length(headed ? 8 : 0);
      double top = 0.8 * outer + static_cast<double>(title_.size()) * length(size::heading_row) +
                   static_cast<double>(key_rows_) * length(size::legend_row) + heading_gap_;
      top = std::max(top, any_multiplier ? length(2.3 * size::tick_text) : outer);
      double const bottom = plan_below(left, right);

      DeviceBox const room{left, top, std::max(width_ - left - right, 8.0), std::max(height_ - top - bottom, 8.0)};
      fit_box(room, equal);
      notes_left_ = framed ? box_.left : outer;
      notes_top_ = box_.bottom() + bottom - outer - static_cast<double>(notes_.size()) * length(size::note_row);
      if (!framed) notes_top_ = height_ - 0.8 * outer - static_cast<double>(notes_.size()) * length(size::note_row);
    }
  }

  // Of the numbers below the frame the last may stand out; colour bars have their place beside it.
  double plan_right(bool framed, double outer) {
    double right = outer;
    if (framed && !x_ticks_.labels.empty()) {
      double const half = text_.width(x_ticks_.labels.back(), length(size::tick_text)) / 2;
      right = std::max(right, half - (1 - x_.place(x_ticks_.major.back())) * box_.width + length(8));
    }
    double bars = 0;
    for (std::size_t i = 0; i < bars_.size(); ++i) bars += plan_colour_bar(canvas_.colour_bars()[i], bars_[i]);
    return bars > 0 ? bars + length(12) : right;
  }

  double plan_left(bool framed, double outer) {
    y_labels_ = framed ? widest(y_ticks_) : 0;
    if (!framed) return outer;
    double left = length(size::tick + size::tick_gap) + y_labels_ + outer;
    if (!y_title_.empty()) left += length(size::title_gap + 1.05 * size::axis_title) - 0.35 * outer;
    if (!y_ticks_.multiplier.empty() && !shares_digits(y_ticks_))
      left =
          std::max(left, text_.width(y_ticks_.multiplier, length(size::tick_text)) + length(size::tick) + 0.5 * outer);
    return left;
  }

  // The frame in the room that is left; with equal units in its middle.
  void fit_box(DeviceBox const& room, bool equal) {
    box_ = room;
    if (equal) {
      double const ratio = (x_.high - x_.low) / (y_.high - y_.low);
      box_.width = std::max(std::min(room.width, room.height * ratio), 4.0);
      box_.height = std::max(std::min(room.height, room.width / ratio), 4.0);
      box_.left += (room.width - box_.width) / 2;
      box_.top += (room.height - box_.height) / 2;
    }
    if (raster_) box_ = {std::round(box_.left), std::round(box_.top), std::round(box_.width), std::round(box_.height)};
  }

  // With equal units, a system much longer than high would be a thread: it gets empty room across.
  void widen_thin_ranges() {
    constexpr double thinnest = 0.12;
    auto widen = [](AxisRange& range, double to) {
      double const more = (to - (range.high - range.low)) / 2;
      if (more > 0) {
        range.low -= more;
        range.high += more;
      }
    };
    widen(y_, thinnest * (x_.high - x_.low));
    widen(x_, thinnest * (y_.high - y_.low));
  }

  double plan_colour_bar(Canvas::ColourBar const& bar, Bar& plan) const {
    plan.ticks = bar.high > bar.low ? ticks_that_fit({bar.low, bar.high, false, bar.factor}, box_.height, false)
                                    : Ticks{{bar.low}, {}, {number_text(bar.low * bar.factor)}, ""};
    plan.labels = widest(plan.ticks);
    plan.width = length(size::bar_gap + size::bar + size::tick + size::tick_gap) + plan.labels;
    std::string const title = axis_title(bar.label, bar.unit);
    if (!title.empty()) plan.width += length(size::title_gap + 1.15 * size::axis_title);
    double const multiplier = text_.width(plan.ticks.multiplier, length(size::tick_text));
    plan.width = std::max(plan.width, length(size::bar_gap) + multiplier);
    return plan.width;
  }

  double key_width(Key const& key) const {
    return length(key.line ? 46 : 24) + text_.width(key.label, length(size::legend)) + length(30);
  }

  void plan_heading(double left, double right) {
    double const wide = std::max(canvas_.equal_aspect() ? box_.width : width_ - left - right, length(260));
    title_ = text_.wrapped(canvas_.title(), length(size::heading), std::max(wide, width_ - left - right), Weight::bold);
    key_rows_ = keys_.empty() ? 0 : 1;
    keys_wide_ = wide;
    double at = 0;
    for (auto const& key : keys_) {
      double const next = key_width(key);
      if (at > 0 && at + next - length(30) > wide) {
        ++key_rows_;
        at = 0;
      }
      at += next;
    }
  }

  // The height of what stands below the frame.
  double plan_below(double left, double right) {
    notes_.clear();
    double const wide = std::max(
        canvas_.frame() ? width_ - std::max(left, box_.left) - length(size::outer) : width_ - 2 * length(size::outer),
        length(200));
    auto add = [&](std::string const& note) {
      auto const lines = text_.wrapped(note, length(size::note), wide);
      notes_.insert(notes_.end(), lines.begin(), lines.end());
    };
    for (auto const& note : canvas_.notes()) add(note);
    if (canvas_.not_finite() > 0) add(counted(canvas_.not_finite(), "not finite"));
    if (std::size_t const hidden = not_positive(canvas_); hidden > 0)
      add(counted(hidden, "not positive, thus not on a logarithmic axis"));
    double below = length(size::outer) + static_cast<double>(notes_.size()) * length(size::note_row);
    if (!canvas_.frame()) return below;
    below += length(size::tick + size::tick_gap + size::tick_text);
    if (!x_title_.empty() || !x_ticks_.multiplier.empty()) below += length(size::title_gap + size::axis_title);
    double const multiplier = text_.width(x_ticks_.multiplier, length(size::tick_text));
    double const half = text_.width(x_title_, length(size::axis_title)) / 2;
    x_multiplier_below_ = !x_title_.empty() && multiplier > 0 &&
                          half + multiplier + length(20) > (width_ - left - right) / 2 &&
                          half + multiplier + length(20) > box_.width / 2;
    if (x_multiplier_below_) below += length(1.3 * size::tick_text);
    if (notes_.empty()) return below;
    return below + length(4);
  }

  DevicePoint place(double x, double y) const {
    auto limited = [](double v) { return std::clamp(v, -1e9, 1e9); };
    return {limited(box_.left + x_.place(x) * box_.width), limited(box_.bottom() - y_.place(y) * box_.height)};
  }

  void draw_grid() const {
    double const wide = line_width(size::grid_line);
    set_colour(cairo_, theme_.grid);
    cairo_set_line_width(cairo_, wide);
    for (double tick : x_ticks_.major) {
      double const x = crisp(place(tick, y_.low).x, wide);
      cairo_move_to(cairo_, x, box_.top);
      cairo_line_to(cairo_, x, box_.bottom());
    }
    for (double tick : y_ticks_.major) {
      double const y = crisp(place(x_.low, tick).y, wide);
      cairo_move_to(cairo_, box_.left, y);
      cairo_line_to(cairo_, box_.right(), y);
    }
    cairo_stroke(cairo_);
  }

  void draw_content() const {
    Painter painter(cairo_, canvas_.frame() ? box_ : DeviceBox{0, 0, width_, height_});
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

  bool shows(double x, double y) const { return x_.shows(x) && y_.shows(y); }

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

  // Each particle as the circle or the point that it stands for.
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
    text_.draw(text.text, at.x, at.y + 0.36 * length(text.size), length(text.size), text.align);
  }

  void draw_image(Painter& painter, Canvas::Image const& image) const {
    if (!shows(image.x0, image.y0) || !shows(image.x1, image.y1)) return;
    painter.image(place(image.x0, image.y0), place(image.x1, image.y1), image.columns, image.rows, image.pixels);
  }

  void draw_frame() const {
    double const wide = line_width(size::frame_line), font = length(size::tick_text);
    double const left = crisp(box_.left, wide), right = crisp(box_.right(), wide);
    double const top = crisp(box_.top, wide), bottom = crisp(box_.bottom(), wide);
    set_colour(cairo_, theme_.ink);
    cairo_set_line_width(cairo_, wide);
    cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_BUTT);
    cairo_rectangle(cairo_, left, top, right - left, bottom - top);
    cairo_stroke(cairo_);
    auto marks = [&](std::vector<double> const& values, bool across, double reach) {
      for (double value : values) {
        DevicePoint const at = place(across ? value : x_.low, across ? y_.low : value);
        cairo_move_to(cairo_, across ? crisp(at.x, wide) : left, across ? bottom : crisp(at.y, wide));
        cairo_rel_line_to(cairo_, across ? 0 : -reach, across ? reach : 0);
      }
      cairo_stroke(cairo_);
    };
    marks(x_ticks_.major, true, length(size::tick));
    marks(x_ticks_.minor, true, length(size::minor_tick));
    marks(y_ticks_.major, false, length(size::tick));
    marks(y_ticks_.minor, false, length(size::minor_tick));

    double const label_row = bottom + length(size::tick + size::tick_gap) + 0.76 * font;
    for (std::size_t i = 0; i < x_ticks_.major.size(); ++i)
      text_.draw(x_ticks_.labels[i], place(x_ticks_.major[i], y_.low).x, label_row, font, 0.5);
    double const label_right = left - length(size::tick + size::tick_gap);
    for (std::size_t i = 0; i < y_ticks_.major.size(); ++i)
      text_.draw(y_ticks_.labels[i], label_right, place(x_.low, y_ticks_.major[i]).y + 0.36 * font, font, 1);

    double const title_row = label_row + length(size::title_gap + size::axis_title);
    double const x_font = fitted(x_title_, length(size::axis_title), width_ - length(size::outer));
    double const half = text_.width(x_title_, x_font) / 2;
    double const middle =
        std::clamp(box_.left + box_.width / 2, std::min(half, width_ / 2), std::max(width_ - half, width_ / 2));
    text_.draw(x_title_, middle, title_row, x_font, 0.5);
    if (!x_ticks_.multiplier.empty())
      text_.draw(x_ticks_.multiplier, box_.right(), title_row + (x_multiplier_below_ ? 1.3 * font : 0), font, 1);
    double const y_font = fitted(y_title_, length(size::axis_title), height_ - length(size::outer));
    text_.draw(y_title_, label_right - y_labels_ - length(size::title_gap), box_.top + box_.height / 2, y_font, 0.5,
               Weight::normal, true);
    if (shares_digits(y_ticks_))
      text_.draw(y_ticks_.multiplier, label_right - y_labels_, top - length(13), font, 0);
    else if (!y_ticks_.multiplier.empty())
      text_.draw(y_ticks_.multiplier, left - length(size::tick), top - length(15), font, 1);
  }

  void draw_heading() const {
    double const font = length(size::legend);
    double const left = std::max(canvas_.frame() ? box_.left : length(size::outer), 0.0);
    double const block = static_cast<double>(title_.size()) * length(size::heading_row) +
                         static_cast<double>(key_rows_) * length(size::legend_row) + heading_gap_;
    double const top = canvas_.frame() ? box_.top - block : std::min(box_.top - block, 0.8 * length(size::outer));
    double y = top;
    set_colour(cairo_, theme_.ink);
    for (auto const& line : title_) {
      double const wide = text_.width(line, length(size::heading), Weight::bold);
      double const x = std::max(std::min(left, width_ - length(size::outer) - wide), length(size::outer));
      text_.draw(line, x, y + 0.8 * length(size::heading), length(size::heading), 0, Weight::bold);
      y += length(size::heading_row);
    }
    double at = 0;
    for (auto const& key : keys_) {
      double const next = key_width(key);
      if (at > 0 && at + next - length(30) > keys_wide_) {
        at = 0;
        y += length(size::legend_row);
      }
      double const base = y + 0.8 * font, middle = base - 0.36 * font;
      Painter marks(cairo_, {0, 0, width_, height_});
      if (key.line) {
        std::vector<DevicePoint> const sample = {{left + at, middle}, {left + at + length(36), middle}};
        marks.curve(sample, length(3), shown(key.colour), key.dashed ? length(8) : 0);
      } else {
        marks.disc({left + at + length(8), middle}, length(7.5), {.fill = with_alpha(shown(key.colour), 1)});
      }
      marks.flush();
      set_colour(cairo_, theme_.ink);
      text_.draw(key.label, left + at + length(key.line ? 46 : 24), base, font);
      at += next;
    }
  }

  void draw_colour_bar(Canvas::ColourBar const& bar, Bar const& plan, double left) const {
    double const wide = line_width(size::frame_line), font = length(size::tick_text);
    DeviceBox const area{raster_ ? std::round(left) : left, box_.top,
                         raster_ ? std::round(length(size::bar)) : length(size::bar), box_.height};
    constexpr int steps = 256;
    std::vector<std::uint32_t> pixels;
    pixels.reserve(steps);
    for (int i = 0; i < steps; ++i) {
      Colour const c = map_colour(bar.map, bar.high > bar.low ? (i + 0.5) / steps : 0.5);
      auto byte = [](float v) { return static_cast<std::uint32_t>(std::lround(v * 255)); };
      pixels.push_back(0xff000000U | byte(c.red) << 16 | byte(c.green) << 8 | byte(c.blue));
    }
    { Painter(cairo_, area).image({area.left, area.bottom()}, {area.right(), area.top}, 1, steps, pixels); }
    double const top = crisp(area.top, wide), bottom = crisp(area.bottom(), wide);
    double const start = crisp(area.left, wide), end = crisp(area.right(), wide);
    set_colour(cairo_, theme_.ink);
    cairo_set_line_width(cairo_, wide);
    cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_BUTT);
    cairo_rectangle(cairo_, start, top, end - start, bottom - top);
    cairo_stroke(cairo_);
    AxisRange const range{bar.low, bar.high};
    auto height = [&](double value) {
      return bar.high > bar.low ? area.bottom() - range.place(value) * area.height : area.top + area.height / 2;
    };
    auto mark = [&](double value, double reach) {
      cairo_move_to(cairo_, end, crisp(height(value), wide));
      cairo_rel_line_to(cairo_, reach, 0);
    };
    for (double value : plan.ticks.major) mark(value, length(size::tick));
    for (double value : plan.ticks.minor) mark(value, length(size::minor_tick));
    cairo_stroke(cairo_);
    double const labels = end + length(size::tick + size::tick_gap);
    for (std::size_t i = 0; i < plan.ticks.major.size(); ++i)
      text_.draw(plan.ticks.labels[i], labels + plan.labels, height(plan.ticks.major[i]) + 0.36 * font, font, 1);
    if (!plan.ticks.multiplier.empty()) text_.draw(plan.ticks.multiplier, start, top - length(15), font);
    std::string const title = axis_title(bar.label, bar.unit);
    double const title_font = fitted(title, length(size::axis_title), height_ - length(size::outer));
    text_.draw(title, labels + plan.labels + length(size::title_gap + 0.8 * size::axis_title),
               box_.top + box_.height / 2, title_font, 0.5, Weight::normal, true);
  }

  Canvas const& canvas_;
  cairo_t* cairo_;
  double width_, height_, unit_;
  Theme theme_;
  bool raster_;
  TextPen text_;
  std::vector<Key> keys_;
  DeviceBox box_;
  AxisRange x_, y_;
  Ticks x_ticks_, y_ticks_;
  std::string x_title_, y_title_;
  std::vector<std::string> title_, notes_;
  std::vector<Bar> bars_;
  double y_labels_ = 0, heading_gap_ = 0, keys_wide_ = 0, notes_left_ = 0, notes_top_ = 0;
  int key_rows_ = 0;
  bool x_multiplier_below_ = false;
};

}  // namespace

void draw_page(Canvas const& canvas, Page const& page) {
  std::optional<Canvas> flat;
  if (canvas.projection()) flat = flattened(canvas);
  Figure(flat ? *flat : canvas, page.cairo, page.width, page.height, page.unit, page.dark).draw();
}

PictureLayout layout_of(Canvas const& canvas, Page const& page) {
  std::optional<Canvas> flat;
  if (canvas.projection()) flat = flattened(canvas);
  return Figure(flat ? *flat : canvas, page.cairo, page.width, page.height, page.unit, page.dark).layout();
}

}  // namespace boltzmann
