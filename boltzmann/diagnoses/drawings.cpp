// Particles, phase space, spectra, time series and fields as marks on a canvas.
#include <boltzmann/core/error.hpp>
#include <boltzmann/diagnoses/canvas_ticks.hpp>
#include <boltzmann/diagnoses/contours.hpp>
#include <boltzmann/diagnoses/drawings.hpp>

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <utility>

namespace boltzmann {
namespace {

void need_length(std::size_t found, std::size_t wanted, std::string const& what) {
  if (found != wanted)
    throw Error("a drawing of " + std::to_string(wanted) + " particles can't use " + std::to_string(found) +
                " numbers for " + what);
}

struct Limits {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  explicit Limits(std::span<double const> values) {
    for (double v : values) add(v);
  }
  Limits() = default;
  void add(double v) {
    if (!std::isfinite(v)) return;
    low = std::min(low, v);
    high = std::max(high, v);
  }
  bool empty() const { return low > high; }
  void centre_on_zero() {
    high = std::max(std::abs(low), std::abs(high));
    low = -high;
  }
  double width() const { return empty() ? 0 : high - low; }
};

void check(std::size_t count, CartesianStyle const& style, std::size_t dimensions) {
  if (!style.value.empty()) need_length(style.value.size(), count, "the value " + style.value_name);
  if (!style.species.empty()) need_length(style.species.size(), count, "the species");
  if (!style.diameter.empty()) need_length(style.diameter.size(), count, "the diameter");
  if (!style.box.empty() && style.box.size() != dimensions)
    throw Error("a drawing in " + std::to_string(dimensions) + " dimensions needs a box with as many axes, found " +
                std::to_string(style.box.size()));
  if (!style.velocity[0].empty())
    for (std::size_t d = 0; d < dimensions; ++d) need_length(style.velocity[d].size(), count, "the velocity");
  for (auto const& [i, j] : style.connections)
    if (i >= count || j >= count)
      throw Error("a connection joins particles " + std::to_string(i) + " and " + std::to_string(j) +
                  "; there are particles 0 to " + std::to_string(static_cast<long long>(count) - 1));
}

Colour colour_of(CartesianStyle const& style, int species) {
  bool const own = species >= 0 && static_cast<std::size_t>(species) < style.species_colours.size();
  return own ? style.species_colours[static_cast<std::size_t>(species)] : species_colour(species);
}

// The colour of each particle; adds the colour bar or the legend that explains it.
std::vector<Colour> particle_colours(std::size_t count, CartesianStyle const& style, Canvas& canvas) {
  std::vector<Colour> colours(count, species_colour(0));
  if (!style.value.empty()) {
    Limits limits(style.value);
    if (limits.empty()) limits.low = limits.high = 0;
    if (style.map == ColourMap::diverging) limits.centre_on_zero();
    if (std::isfinite(style.value_low)) limits.low = style.value_low;
    if (std::isfinite(style.value_high)) limits.high = style.value_high;
    std::size_t missing = 0;
    for (std::size_t i = 0; i < count; ++i) {
      missing += std::isnan(style.value[i]);
      colours[i] = map_colour(style.map, place_between(limits.low, limits.high, style.value[i]));
    }
    canvas.colour_bar(style.value_name, style.value_unit, limits.low, limits.high, style.map, style.value_factor);
    if (missing > 0)
      canvas.note(std::to_string(missing) + (missing == 1 ? " particle" : " particles") + " without a value (grey)");
  } else if (!style.species.empty()) {
    for (std::size_t i = 0; i < count; ++i) colours[i] = colour_of(style, style.species[i]);
  }
  if (style.value.empty())
    for (std::size_t s = 0; s < style.species_names.size(); ++s)
      canvas.legend(style.species_names[s], colour_of(style, static_cast<int>(s)));
  return colours;
}

double diameter_of(CartesianStyle const& style, std::size_t i) {
  return style.diameter.empty() ? style.common_diameter : style.diameter[i];
}

bool has_diameters(CartesianStyle const& style) { return !style.diameter.empty() || style.common_diameter > 0; }

// Points of this many particles: smaller ones when they are many.
float fitting_point(std::size_t count) {
  return static_cast<float>(std::clamp(180 / std::sqrt(static_cast<double>(count) + 1), 1.4, 9.0));
}

// Arrows for velocities: drawing length per unit of velocity. The fastest particle's arrow spans 1.5 particle
// distances.
double arrow_scale(CartesianStyle const& style, std::size_t count, double particle_distance, Canvas& canvas) {
  double fastest = 0;
  for (std::size_t i = 0; i < count; ++i) {
    double square = 0;
    for (auto const& component : style.velocity)
      if (i < component.size()) square += component[i] * component[i];
    if (std::isfinite(square)) fastest = std::max(fastest, square);
  }
  fastest = std::sqrt(fastest);
  if (fastest <= 0) return 0;
  canvas.note("longest arrow: " + number_text(fastest) +
              (style.velocity_unit.empty() ? "" : " " + style.velocity_unit));
  return 1.5 * particle_distance / fastest;
}

constexpr Colour connection_colour{0.50F, 0.53F, 0.57F, 1};

// The shortest way from a to b along an axis that may be periodic.
double shortest(double way, CartesianStyle const& style, std::size_t axis) {
  if (axis < style.box.size() && style.periodic[axis]) {
    double const width = style.box[axis][1] - style.box[axis][0];
    if (width > 0 && std::abs(way) > width / 2) return way - width * std::round(way / width);
  }
  return way;
}

// Calls line(from, to) for each connection, as two halves if it goes through a periodic wall.
template <std::size_t D, class Draw>
void each_connection(std::array<std::span<double const>, D> const& position, CartesianStyle const& style, Draw line) {
  for (auto const& [i, j] : style.connections) {
    std::array<double, D> from, to, half_way, half_back;
    bool through = false;
    for (std::size_t d = 0; d < D; ++d) {
      from[d] = position[d][i];
      to[d] = position[d][j];
      double const way = shortest(to[d] - from[d], style, d);
      through = through || way != to[d] - from[d];
      half_way[d] = from[d] + way / 2;
      half_back[d] = to[d] - way / 2;
    }
    if (through) {
      line(from, half_way);
      line(to, half_back);
    } else {
      line(from, to);
    }
  }
}

}  // namespace

Projection::Place Projection::operator()(double x, double y, double z) const {
  double const a = azimuth * std::numbers::pi / 180, e = elevation * std::numbers::pi / 180;
  double const out = x * std::cos(a) + y * std::sin(a);
  return {y * std::cos(a) - x * std::sin(a), z * std::cos(e) - out * std::sin(e), out * std::cos(e) + z * std::sin(e)};
}

Canvas draw_cartesian(std::span<double const> x, std::span<double const> y, CartesianStyle const& style) {
  std::size_t const count = x.size();
  need_length(y.size(), count, "y");
  check(count, style, 2);
  Canvas canvas;
  canvas.title(style.title);
  canvas.equal_aspect(true);
  Axis x_axis{style.axes[0], style.unit}, y_axis{style.axes[1], style.unit};
  x_axis.factor = y_axis.factor = style.unit_factor;
  Limits wide(x), high(y);
  if (!style.box.empty()) {
    auto fit = [](Axis& axis, std::array<double, 2> const& side) {
      double const room = 0.03 * (side[1] - side[0]);
      if (!(room > 0)) return;
      axis.low = side[0] - room;
      axis.high = side[1] + room;
    };
    fit(x_axis, style.box[0]);
    fit(y_axis, style.box[1]);
    canvas.rectangle(style.box[0][0], style.box[1][0], style.box[0][1], style.box[1][1], with_alpha(ink, 0.45), 1.3F);
    wide = Limits(style.box[0]);
    high = Limits(style.box[1]);
  }
  canvas.axes(x_axis, y_axis);

  each_connection<2>({x, y}, style, [&](auto const& from, auto const& to) {
    canvas.line(from[0], from[1], to[0], to[1], connection_colour, 2);
  });
  std::vector<Colour> const colours = particle_colours(count, style, canvas);
  for (std::size_t i = 0; i < count; ++i) {
    if (has_diameters(style))
      canvas.circle(x[i], y[i], diameter_of(style, i) / 2, colours[i]);
    else
      canvas.point(x[i], y[i], colours[i], fitting_point(count));
  }
  if (!style.velocity[0].empty()) {
    double const area = wide.width() * high.width();
    double const distance =
        area > 0 ? std::sqrt(area / static_cast<double>(count)) : std::max({wide.width(), high.width(), 1.0}) / 10;
    if (double const scale = arrow_scale(style, count, distance, canvas); scale > 0)
      for (std::size_t i = 0; i < count; ++i)
        canvas.arrow(x[i], y[i], x[i] + scale * style.velocity[0][i], y[i] + scale * style.velocity[1][i], ink, 1.4F);
  }
  return canvas;
}

namespace {

// The outline of a box in space: edges behind the particles first, the three edges at the nearest corner last; names
// and ends along three edges of the silhouette.
class BoxOutline {
 public:
  BoxOutline(std::vector<std::array<double, 2>> box, CartesianStyle const& style, Projection const& projection)
      : box_(std::move(box)), style_(style), project_(projection) {
    for (int corner = 1; corner < 8; ++corner) {
      if (at(corner).near > at(nearest_).near) nearest_ = corner;
      if (at(corner).near < at(farthest_).near) farthest_ = corner;
    }
    for (int corner = 0; corner < 8; ++corner) {
      right_.add(at(corner).right);
      up_.add(at(corner).up);
    }
  }

  void draw_behind(Canvas& canvas) const {
    each_edge([&](int a, int b, int) {
      bool const hidden = a == farthest_ || b == farthest_;
      if (a != nearest_ && b != nearest_) edge(canvas, a, b, hidden ? 0.22 : 0.5);
    });
  }
  void draw_before(Canvas& canvas) const {
    each_edge([&](int a, int b, int) {
      if (a == nearest_ || b == nearest_) edge(canvas, a, b, 0.22);
    });
  }

  void name_axes(Canvas& canvas) const {
    double const size = std::max(right_.width(), up_.width());
    double const middle_right = (right_.low + right_.high) / 2;
    for (int axis = 0; axis < 3; ++axis) {
      // The silhouette's edges along this axis touch neither the nearest nor the farthest corner: x and y are named at
      // the lower of them, z at the left one.
      int best_a = -1, best_b = -1;
      double best = std::numeric_limits<double>::infinity();
      each_edge([&](int a, int b, int along) {
        if (along != axis || a == nearest_ || b == nearest_ || a == farthest_ || b == farthest_) return;
        double const rank = axis == 2 ? at(a).right + at(b).right : at(a).up + at(b).up;
        if (rank < best - 1e-12 * size) {
          best = rank;
          best_a = a;
          best_b = b;
        }
      });
      if (best_a < 0) continue;
      auto const a = at(best_a), b = at(best_b);
      double const length = std::hypot(b.right - a.right, b.up - a.up);
      if (length < 0.1 * size) continue;  // seen from its end
      double out_right = (b.up - a.up) / length,
             out_up = -(b.right - a.right) / length;  // across the edge, away from the box
      double const mid_right = (a.right + b.right) / 2, mid_up = (a.up + b.up) / 2;
      if (out_right * (mid_right - middle_right) + out_up * (mid_up - (up_.low + up_.high) / 2) < 0) {
        out_right = -out_right;
        out_up = -out_up;
      }
      auto write = [&](double fraction, double away, std::string const& text, float font) {
        double const align = 0.5 - 0.5 * std::clamp(4 * out_right, -1.0, 1.0);
        canvas.text(a.right + fraction * (b.right - a.right) + away * size * out_right,
                    a.up + fraction * (b.up - a.up) + away * size * out_up, text, ink, font, align);
      };
      auto const along = static_cast<std::size_t>(axis);
      Ticks const ticks =
          ticks_between(box_[along][0] * style_.unit_factor, box_[along][1] * style_.unit_factor, false, 5);
      double const width = box_[along][1] - box_[along][0];
      for (std::size_t i = 0; i < ticks.major.size(); ++i) {
        double const fraction = (ticks.major[i] / style_.unit_factor - box_[along][0]) / width;
        double const r = a.right + fraction * (b.right - a.right), u = a.up + fraction * (b.up - a.up);
        canvas.line(r, u, r + 0.009 * size * out_right, u + 0.009 * size * out_up, with_alpha(ink, 0.6), 1.3F);
        write(fraction, 0.028, ticks.labels[i], 18);
      }
      std::string unit = style_.unit;
      if (!ticks.multiplier.empty()) unit.insert(0, unit.empty() ? ticks.multiplier : ticks.multiplier + " ");
      std::string const name = style_.axes[along] + (unit.empty() ? "" : " (" + unit + ")");
      if (axis == 2) {  // above the upper end, where it needs no room beside the box
        auto const& top = a.up > b.up ? a : b;
        canvas.text(top.right, top.up + 0.04 * size, name, ink, 21, 0.85);
      } else {
        write(0.5, 0.09, name, 21);
      }
    }
  }

  // The range of the picture, with room for the names.
  std::array<Limits, 2> ranges() const {
    double const size = std::max(right_.width(), up_.width());
    std::array<Limits, 2> both = {right_, up_};
    both[0].low -= 0.1 * size;
    both[0].high += 0.07 * size;
    both[1].low -= 0.07 * size;
    both[1].high += 0.07 * size;
    return both;
  }

 private:
  Projection::Place at(int corner) const {
    auto side = [&](int axis) {
      return box_[static_cast<std::size_t>(axis)][static_cast<std::size_t>(corner >> axis & 1)];
    };
    return project_(side(0), side(1), side(2));
  }
  template <class Visit>
  static void each_edge(Visit visit) {
    for (int axis = 0; axis < 3; ++axis)
      for (int corner = 0; corner < 8; ++corner)
        if ((corner >> axis & 1) == 0) visit(corner, corner | 1 << axis, axis);
  }
  void edge(Canvas& canvas, int a, int b, double strength) const {
    auto const from = at(a), to = at(b);
    canvas.line(from.right, from.up, to.right, to.up, with_alpha(ink, strength), 1.4F);
  }

  std::vector<std::array<double, 2>> box_;
  CartesianStyle const& style_;
  Projection const& project_;
  int nearest_ = 0, farthest_ = 0;
  Limits right_, up_;
};

std::vector<std::array<double, 2>> content_box(std::array<std::span<double const>, 3> const& position) {
  std::vector<std::array<double, 2>> box;
  for (auto const& values : position) {
    Limits limits(values);
    if (limits.empty()) limits.low = 0, limits.high = 1;
    box.push_back({limits.low, limits.high});
  }
  double widest = 0;
  for (auto const& side : box) widest = std::max(widest, side[1] - side[0]);
  if (widest <= 0) widest = 1;
  for (auto& side : box) {
    double const room = std::max(0.02 * widest, (0.05 * widest - (side[1] - side[0])) / 2);
    side = {side[0] - room, side[1] + room};
  }
  return box;
}

}  // namespace

Canvas draw_cartesian(std::span<double const> x, std::span<double const> y, std::span<double const> z,
                      CartesianStyle const& style, Projection const& projection) {
  std::size_t const count = x.size();
  need_length(y.size(), count, "y");
  need_length(z.size(), count, "z");
  check(count, style, 3);
  Canvas canvas;
  canvas.title(style.title);
  canvas.equal_aspect(true);
  canvas.frame(false);
  auto const box = style.box.empty() ? content_box({x, y, z}) : style.box;
  BoxOutline const outline(box, style, projection);
  auto const ranges = outline.ranges();
  canvas.axes({"", "", ranges[0].low, ranges[0].high}, {"", "", ranges[1].low, ranges[1].high});
  outline.draw_behind(canvas);

  std::vector<Projection::Place> places(count);
  Limits depth;
  for (std::size_t i = 0; i < count; ++i) {
    places[i] = projection(x[i], y[i], z[i]);
    depth.add(places[i].near);
  }
  each_connection<3>({x, y, z}, style, [&](auto const& from, auto const& to) {
    auto const a = projection(from[0], from[1], from[2]), b = projection(to[0], to[1], to[2]);
    canvas.line(a.right, a.up, b.right, b.up, connection_colour, 2);
  });
  std::vector<Colour> const colours = particle_colours(count, style, canvas);
  std::vector<std::size_t> order(count);
  std::iota(order.begin(), order.end(), std::size_t{0});
  std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) {
    double const a = places[i].near, b = places[j].near;
    return std::isnan(b) ? !std::isnan(a) : a < b;
  });
  double const screen = std::max(ranges[0].width(), ranges[1].width());
  for (std::size_t i : order) {
    bool const sized = has_diameters(style);
    double const radius = sized ? diameter_of(style, i) / 2 : fitting_point(count) * screen / 1700;
    // Where the colour carries a value, fading is weak: the colour bar must stay readable.
    double const most = style.value.empty() ? 1 : 0.4;
    double const far = depth.width() > 0 ? most * (depth.high - places[i].near) / depth.width() : 0;
    canvas.circle({places[i].right, places[i].up, radius, colours[i], true, true, static_cast<float>(far)});
  }
  if (!style.velocity[0].empty()) {
    double volume = 1;
    for (auto const& side : box) volume *= side[1] - side[0];
    if (double const scale =
            arrow_scale(style, count, std::cbrt(volume / static_cast<double>(std::max<std::size_t>(count, 1))), canvas);
        scale > 0)
      for (std::size_t i : order) {
        auto const way = projection(style.velocity[0][i], style.velocity[1][i], style.velocity[2][i]);
        canvas.arrow(places[i].right, places[i].up, places[i].right + scale * way.right, places[i].up + scale * way.up,
                     ink, 1.4F);
      }
  }
  outline.draw_before(canvas);
  outline.name_axes(canvas);
  return canvas;
}

Canvas draw_phase_space(std::span<Series const> species, Axis x, Axis y, std::string title) {
  Canvas canvas;
  canvas.title(std::move(title));
  canvas.axes(std::move(x), std::move(y));
  std::size_t longest = 0, total = 0;
  auto const colour = [&](std::size_t s) { return species[s].colour.value_or(species_colour(static_cast<int>(s))); };
  for (std::size_t s = 0; s < species.size(); ++s) {
    if (species[s].x.size() != species[s].y.size())
      throw Error("phase space of '" + species[s].label + "' has " + std::to_string(species[s].x.size()) + " x and " +
                  std::to_string(species[s].y.size()) + " y");
    longest = std::max(longest, species[s].x.size());
    total += species[s].x.size();
    if (!species[s].label.empty()) canvas.legend(species[s].label, colour(s));
  }
  float const size = std::clamp(fitting_point(total) * 1.6F, 1.6F, 9.0F);
  double const alpha = total > 300 ? 0.75 : 1;
  // Turn by turn, so that no species hides another.
  for (std::size_t i = 0; i < longest; ++i)
    for (std::size_t s = 0; s < species.size(); ++s)
      if (i < species[s].x.size()) canvas.point(species[s].x[i], species[s].y[i], with_alpha(colour(s), alpha), size);
  return canvas;
}

Canvas draw_spectrum(std::span<double const> frequency, std::span<double const> density, Axis x, Axis y,
                     bool log_density, std::string title) {
  Canvas canvas;
  canvas.title(std::move(title));
  y.logarithmic = log_density;
  Limits const limits(frequency);
  if (!x.logarithmic && limits.width() > 0) {
    if (!std::isfinite(x.low)) x.low = limits.low;
    if (!std::isfinite(x.high)) x.high = limits.high;
  }
  canvas.axes(std::move(x), std::move(y));
  canvas.grid(true);
  canvas.curve(frequency, density, species_colour(0), "", 1.8F);
  return canvas;
}

Canvas draw_time_series(std::span<Series const> series, Axis x, Axis y, std::string title) {
  Canvas canvas;
  canvas.title(std::move(title));
  Limits limits;
  for (auto const& s : series)
    for (double t : s.x) limits.add(t);
  if (!x.logarithmic && limits.width() > 0) {
    if (!std::isfinite(x.low)) x.low = limits.low;
    if (!std::isfinite(x.high)) x.high = limits.high;
  }
  canvas.axes(std::move(x), std::move(y));
  canvas.grid(true);
  for (std::size_t s = 0; s < series.size(); ++s)
    canvas.curve(series[s].x, series[s].y, series[s].colour.value_or(species_colour(static_cast<int>(s))),
                 series[s].label, 2.4F);
  return canvas;
}

Canvas draw_profile(std::span<Series const> series, Axis x, Axis y, std::string title) {
  Canvas canvas = draw_time_series(series, std::move(x), std::move(y), std::move(title));
  constexpr std::size_t marked = 100;
  for (std::size_t s = 0; s < series.size(); ++s)
    for (std::size_t i = 0; i < series[s].x.size() && series[s].x.size() <= marked; ++i)
      canvas.point(series[s].x[i], series[s].y[i], series[s].colour.value_or(species_colour(static_cast<int>(s))), 7);
  return canvas;
}

namespace {

// The axes of a mesh of so many cells, from low to high.
void complete(Axis& axis, int cells) {
  if (!std::isfinite(axis.low)) axis.low = 0;
  if (!std::isfinite(axis.high)) axis.high = axis.low + std::max(cells, 1);
}

}  // namespace

Canvas draw_field(int columns, int rows, std::span<double const> values, Axis x, Axis y, std::string value_name,
                  std::string value_unit, ColourMap map, std::string title, ColourEnds const& ends) {
  Canvas canvas;
  canvas.title(std::move(title));
  complete(x, columns);
  complete(y, rows);
  Limits limits(values);
  if (limits.empty()) limits.low = limits.high = 0;
  if (map == ColourMap::diverging) limits.centre_on_zero();
  if (std::isfinite(ends.low)) limits.low = ends.low;
  if (std::isfinite(ends.high)) limits.high = ends.high;
  canvas.image(x.low, y.low, x.high, y.high, columns, rows, values, limits.low, limits.high, map);
  canvas.equal_aspect(x.unit == y.unit);
  canvas.axes(std::move(x), std::move(y));
  canvas.colour_bar(std::move(value_name), std::move(value_unit), limits.low, limits.high, map, ends.factor);
  return canvas;
}

Canvas draw_contours(MeshGrid const& grid, std::span<double const> values, std::span<double const> levels, Axis x,
                     Axis y, std::string value_name, std::string value_unit, std::string title,
                     ColourEnds const& ends) {
  auto const lines = contour_lines(grid, values, levels);
  Canvas canvas;
  canvas.title(std::move(title));
  for (int a = 0; a < 2; ++a) {
    Axis& axis = a == 0 ? x : y;
    if (!std::isfinite(axis.low)) axis.low = grid.low[a];
    if (!std::isfinite(axis.high)) axis.high = grid.low[a] + static_cast<double>(grid.cells(a)) * grid.spacing[a];
  }
  Limits limits(levels);
  if (limits.empty()) limits.low = limits.high = 0;
  if (std::isfinite(ends.low)) limits.low = ends.low;
  if (std::isfinite(ends.high)) limits.high = ends.high;
  for (auto const& line : lines) {
    Colour const colour = map_colour(ColourMap::viridis, place_between(limits.low, limits.high, line.level));
    for (auto const& part : inside_box(line, grid)) canvas.curve(part.x, part.y, colour, "", 2.2F);
  }
  canvas.equal_aspect(x.unit == y.unit);
  canvas.axes(std::move(x), std::move(y));
  canvas.colour_bar(std::move(value_name), std::move(value_unit), limits.low, limits.high, ColourMap::viridis,
                    ends.factor);
  return canvas;
}

Canvas draw_bands(int columns, int rows, std::span<double const> values, std::span<double const> levels, Axis x, Axis y,
                  std::string const& value_name, std::string const& value_unit, std::string title, double factor) {
  if (!std::is_sorted(levels.begin(), levels.end())) throw Error("the levels of bands must ascend");
  Canvas canvas;
  canvas.title(std::move(title));
  complete(x, columns);
  complete(y, rows);
  auto const top = static_cast<double>(levels.size());
  std::vector<double> bands(values.begin(), values.end());
  for (double& v : bands)
    if (!std::isnan(v)) v = static_cast<double>(std::upper_bound(levels.begin(), levels.end(), v) - levels.begin());
  canvas.image(x.low, y.low, x.high, y.high, columns, rows, bands, 0, top, ColourMap::grey);
  canvas.equal_aspect(x.unit == y.unit);
  canvas.axes(std::move(x), std::move(y));
  auto const text = [&](std::size_t level) {
    return number_text(levels[level] * factor) + (value_unit.empty() ? "" : " " + value_unit);
  };
  for (std::size_t band = levels.size() + 1; band-- > 0 && !levels.empty();) {
    std::string where = value_name;
    if (band > 0) where.append(band == levels.size() ? " above " : " ").append(text(band - 1));
    if (band < levels.size()) where.append(band == 0 ? " below " : " to ").append(text(band));
    canvas.legend(where, map_colour(ColourMap::grey, place_between(0, top, static_cast<double>(band))));
  }
  return canvas;
}

}  // namespace boltzmann
