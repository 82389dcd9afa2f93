// Draws discs with exact coverage, everything else as Cairo paths.
#include <boltzmann/pictures/figure_paint.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace boltzmann {
namespace {

// Clips a segment to within `reach` of the box, because Cairo's coordinates are limited to some millions.
bool clip_segment(DevicePoint& a, DevicePoint& b, DeviceBox const& box, double reach) {
  double first = 0, last = 1;
  double const dx = b.x - a.x, dy = b.y - a.y;
  auto side = [&](double direction, double distance) {
    if (direction == 0) return distance >= 0;
    double const t = distance / direction;
    if (direction < 0)
      first = std::max(first, t);
    else
      last = std::min(last, t);
    return first <= last;
  };
  if (!side(-dx, a.x - (box.left - reach)) || !side(dx, box.right() + reach - a.x) ||
      !side(-dy, a.y - (box.top - reach)) || !side(dy, box.bottom() + reach - a.y))
    return false;
  DevicePoint const start = a;
  b = last < 1 ? DevicePoint{start.x + last * dx, start.y + last * dy} : b;
  a = first > 0 ? DevicePoint{start.x + first * dx, start.y + first * dy} : a;
  return true;
}

std::vector<DevicePoint> reduced(std::vector<DevicePoint> const& nodes) {
  std::vector<DevicePoint> kept;
  auto column = [](DevicePoint p) { return std::floor(2 * p.x); };
  for (std::size_t begin = 0, end = 0; begin < nodes.size(); begin = end) {
    while (end < nodes.size() && column(nodes[end]) == column(nodes[begin])) ++end;
    if (end - begin <= 4) {
      kept.insert(kept.end(), nodes.begin() + static_cast<std::ptrdiff_t>(begin),
                  nodes.begin() + static_cast<std::ptrdiff_t>(end));
      continue;
    }
    std::size_t lowest = begin, highest = begin;
    for (std::size_t i = begin; i < end; ++i) {
      if (nodes[i].y < nodes[lowest].y) lowest = i;
      if (nodes[i].y > nodes[highest].y) highest = i;
    }
    kept.push_back(nodes[begin]);
    kept.push_back(nodes[std::min(lowest, highest)]);
    kept.push_back(nodes[std::max(lowest, highest)]);
    kept.push_back(nodes[end - 1]);
  }
  return kept;
}

// Spheres: light comes from the upper left. Position of the light and extent of its gradient, in radii.
constexpr double light_at = 0.34, light_reach = 1.42;

struct SphereTones {
  Colour light, middle, dark;
  explicit SphereTones(Colour fill)
      : light(mixed(fill, {1, 1, 1, fill.alpha}, 0.42)), middle(fill), dark(mixed(fill, {0, 0, 0, fill.alpha}, 0.45)) {}
  Colour at(double t) const {
    return t < 0.5 ? mixed(light, middle, 2 * t) : mixed(middle, dark, std::min(2 * t - 1, 1.0));
  }
};

}  // namespace

void set_colour(cairo_t* cairo, Colour colour) {
  cairo_set_source_rgba(cairo, colour.red, colour.green, colour.blue, colour.alpha);
}

Painter::Painter(cairo_t* cairo, DeviceBox clip)
    : cairo_(cairo),
      surface_(cairo_get_target(cairo)),
      clip_(clip),
      pixels_(cairo_surface_get_type(surface_) == CAIRO_SURFACE_TYPE_IMAGE) {
  cairo_save(cairo_);
  cairo_rectangle(cairo_, clip.left, clip.top, clip.width, clip.height);
  cairo_clip(cairo_);
  cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
  cairo_set_line_join(cairo_, CAIRO_LINE_JOIN_ROUND);
}

Painter::~Painter() {
  flush();
  cairo_restore(cairo_);
}

void Painter::flush() {
  if (pending_) {
    cairo_set_line_width(cairo_, pending_width_);
    set_colour(cairo_, pending_colour_);
    cairo_stroke(cairo_);
    pending_ = false;
  }
  if (drawing_pixels_) {
    cairo_surface_mark_dirty(surface_);
    drawing_pixels_ = false;
  }
}

void Painter::begin_pixels() {
  if (pending_) flush();
  if (drawing_pixels_) return;
  cairo_surface_flush(surface_);
  drawing_pixels_ = true;
}

void Painter::pen(double width, Colour colour) {
  if (drawing_pixels_ || (pending_ && (width != pending_width_ || colour != pending_colour_ || pending_count_ >= 500)))
    flush();
  if (!pending_) {
    pending_ = true;
    pending_width_ = width;
    pending_colour_ = colour;
    pending_count_ = 0;
  }
  ++pending_count_;
}

void Painter::disc(DevicePoint centre, double radius, DiscStyle const& style) {
  if (!(centre.x + radius > clip_.left && centre.x - radius < clip_.right() && centre.y + radius > clip_.top &&
        centre.y - radius < clip_.bottom()))
    return;
  if (pixels_ && radius < 4000)
    disc_on_pixels(centre, radius, style);
  else
    disc_on_paths(centre, std::min(radius, 1e5), style);
}

void Painter::disc_on_pixels(DevicePoint centre, double radius, DiscStyle const& style) {
  begin_pixels();
  unsigned char* const data = cairo_image_surface_get_data(surface_);
  int const stride = cairo_image_surface_get_stride(surface_);
  // Coverage decreases from 1 to 0 over one pixel at the rim, which adds pi / 12 to the area; the radius is reduced to
  // compensate. Discs smaller than a pixel are drawn as faint discs of the smallest size.
  constexpr double smallest = 0.65;
  double const strength = radius < smallest ? radius * radius / (smallest * smallest) : 1;
  radius = std::max(radius, smallest);
  radius = std::sqrt(radius * radius - 1.0 / 12);
  auto range = [radius](double c, double low, double high) {
    return std::array<int, 2>{static_cast<int>(std::floor(std::max(c - radius - 0.5, std::round(low)))),
                              static_cast<int>(std::ceil(std::min(c + radius + 0.5, std::round(high))))};
  };
  auto const [left, right] = range(centre.x, std::max(clip_.left, 0.0),
                                   std::min<double>(clip_.right(), cairo_image_surface_get_width(surface_)));
  auto const [top, bottom] = range(centre.y, std::max(clip_.top, 0.0),
                                   std::min<double>(clip_.bottom(), cairo_image_surface_get_height(surface_)));
  SphereTones const tones(style.fill);
  double const inner = radius - style.rim_width;
  for (int y = top; y < bottom; ++y) {
    auto* row = reinterpret_cast<std::uint32_t*>(data + static_cast<std::ptrdiff_t>(y) * stride);
    for (int x = left; x < right; ++x) {
      double const dx = x + 0.5 - centre.x, dy = y + 0.5 - centre.y;
      double const distance_squared = dx * dx + dy * dy;
      if (distance_squared >= (radius + 0.5) * (radius + 0.5)) continue;
      double const distance = std::sqrt(distance_squared);
      double const outside = std::clamp(radius + 0.5 - distance, 0.0, 1.0);
      double const inside = style.rim_width > 0 || style.hollow ? std::clamp(inner + 0.5 - distance, 0.0, 1.0) : 1;
      Colour colour = style.fill;
      double coverage = outside;
      if (style.hollow) {
        colour = style.rim;
        coverage = outside * (1 - inside);
      } else {
        if (style.shaded)
          colour = tones.at(std::hypot(dx + light_at * radius, dy + light_at * radius) / (light_reach * radius));
        if (inside < 1) colour = mixed(style.rim, colour, inside);
      }
      auto const a = static_cast<float>(coverage * strength) * colour.alpha;
      std::uint32_t const old = row[x];
      auto blend = [a, old](int shift, float c) {
        auto const before = static_cast<float>((old >> shift) & 255U);
        return static_cast<std::uint32_t>(std::lround(before + a * (255 * c - before))) << shift;
      };
      row[x] = 0xff000000U | blend(16, colour.red) | blend(8, colour.green) | blend(0, colour.blue);
    }
  }
}

void Painter::disc_on_paths(DevicePoint centre, double radius, DiscStyle const& style) {
  bool const plain = !style.hollow && !style.shaded && style.rim_width <= 0;
  if (plain && style.fill.alpha >= 1 && radius < 6) {  // a dot of a round pen: many dots make one short path
    pen(2 * radius, style.fill);
    cairo_move_to(cairo_, centre.x, centre.y);
    cairo_line_to(cairo_, centre.x, centre.y);
    return;
  }
  flush();
  double const middle_of_rim = std::max(radius - style.rim_width / 2, 0.0);
  cairo_new_path(cairo_);
  cairo_arc(cairo_, centre.x, centre.y, middle_of_rim, 0, 2 * std::numbers::pi);
  cairo_close_path(cairo_);
  if (!style.hollow) {
    if (style.shaded) {
      SphereTones const tones(style.fill);
      double const x = centre.x - light_at * radius, y = centre.y - light_at * radius;
      cairo_pattern_t* gradient = cairo_pattern_create_radial(x, y, 0, x, y, light_reach * radius);
      auto stop = [gradient](double at, Colour c) {
        cairo_pattern_add_color_stop_rgba(gradient, at, c.red, c.green, c.blue, c.alpha);
      };
      stop(0, tones.light);
      stop(0.5, tones.middle);
      stop(1, tones.dark);
      cairo_set_source(cairo_, gradient);
      cairo_pattern_destroy(gradient);
    } else {
      set_colour(cairo_, style.fill);
    }
    cairo_fill_preserve(cairo_);
  }
  if (style.rim_width > 0 || style.hollow) {
    set_colour(cairo_, style.rim);
    cairo_set_line_width(cairo_, style.rim_width);
    cairo_stroke_preserve(cairo_);
  }
  cairo_new_path(cairo_);
}

void Painter::line(DevicePoint from, DevicePoint to, double width, Colour colour) {
  if (!clip_segment(from, to, clip_, width + 2000)) return;
  pen(width, colour);
  cairo_move_to(cairo_, from.x, from.y);
  cairo_line_to(cairo_, to.x, to.y);
}

void Painter::arrow(DevicePoint from, DevicePoint to, double width, double head, Colour colour) {
  double const dx = to.x - from.x, dy = to.y - from.y, length = std::hypot(dx, dy);
  if (!(length > 0.25)) return;
  head = std::min(head, 0.55 * length);
  double const ux = dx / length, uy = dy / length, half = 0.4 * head;
  width = std::min(width, 0.9 * half);
  line(from, {to.x - 0.85 * head * ux, to.y - 0.85 * head * uy}, width, colour);
  flush();
  if (std::abs(to.x) > 1e5 || std::abs(to.y) > 1e5) return;
  double const notch = 0.82 * head;
  cairo_move_to(cairo_, to.x, to.y);
  cairo_line_to(cairo_, to.x - head * ux - half * uy, to.y - head * uy + half * ux);
  cairo_line_to(cairo_, to.x - notch * ux, to.y - notch * uy);
  cairo_line_to(cairo_, to.x - head * ux + half * uy, to.y - head * uy - half * ux);
  cairo_close_path(cairo_);
  set_colour(cairo_, colour);
  cairo_fill(cairo_);
}

void Painter::curve(std::vector<DevicePoint> const& nodes, double width, Colour colour, double dash) {
  flush();
  if (nodes.size() == 1) {
    disc(nodes[0], 1.2 * width, {.fill = colour});
    return;
  }
  std::vector<DevicePoint> const kept = reduced(nodes);
  set_colour(cairo_, colour);
  cairo_set_line_width(cairo_, width);
  if (dash > 0) {
    std::array<double, 2> const pattern = {dash, 0.75 * dash};
    cairo_set_dash(cairo_, pattern.data(), 2, 0);
    cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_BUTT);
  }
  DevicePoint pen_at{NAN, NAN};
  int segments = 0;
  for (std::size_t i = 1; i < kept.size(); ++i) {
    DevicePoint a = kept[i - 1], b = kept[i];
    if (!clip_segment(a, b, clip_, width + 2000)) continue;
    bool const joined = a.x == pen_at.x && a.y == pen_at.y;
    if (joined && dash <= 0 && colour.alpha >= 1 &&
        ++segments >= 300) {  // long paths are slow in Cairo; opaque ones may be cut
      cairo_stroke(cairo_);
      cairo_move_to(cairo_, a.x, a.y);
      segments = 0;
    } else if (!joined) {
      cairo_move_to(cairo_, a.x, a.y);
    }
    cairo_line_to(cairo_, b.x, b.y);
    pen_at = b;
  }
  cairo_stroke(cairo_);
  cairo_set_dash(cairo_, nullptr, 0, 0);
  cairo_set_line_cap(cairo_, CAIRO_LINE_CAP_ROUND);
}

void Painter::image(DevicePoint first_corner, DevicePoint last_corner, int columns, int rows,
                    std::vector<std::uint32_t> const& pixels) {
  flush();
  if (columns <= 0 || rows <= 0) return;
  cairo_surface_t* surface = cairo_image_surface_create(CAIRO_FORMAT_ARGB32, columns, rows);
  if (cairo_surface_status(surface) == CAIRO_STATUS_SUCCESS) {
    int const stride = cairo_image_surface_get_stride(surface) / 4;
    auto* data = reinterpret_cast<std::uint32_t*>(cairo_image_surface_get_data(surface));
    for (int row = 0; row < rows; ++row)
      for (int column = 0; column < columns; ++column) {
        std::uint32_t const p = pixels[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) +
                                       static_cast<std::size_t>(column)];
        std::uint32_t const alpha = p >> 24;
        auto by_alpha = [&](int shift) { return (((p >> shift) & 255U) * alpha + 127) / 255 << shift; };
        data[row * stride + column] = alpha << 24 | by_alpha(16) | by_alpha(8) | by_alpha(0);
      }
    cairo_surface_mark_dirty(surface);
    cairo_save(cairo_);
    cairo_translate(cairo_, first_corner.x, first_corner.y);
    cairo_scale(cairo_, (last_corner.x - first_corner.x) / columns, (last_corner.y - first_corner.y) / rows);
    cairo_set_source_surface(cairo_, surface, 0, 0);
    cairo_pattern_set_filter(cairo_get_source(cairo_), CAIRO_FILTER_NEAREST);
    cairo_rectangle(cairo_, 0, 0, columns, rows);
    cairo_fill(cairo_);
    cairo_restore(cairo_);
  }
  cairo_surface_destroy(surface);
}

}  // namespace boltzmann
