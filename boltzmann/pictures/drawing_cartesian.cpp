// Particles in the plane and in space, from arrays.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/canvas_ticks.hpp>
#include <boltzmann/pictures/drawing_cartesian.hpp>
#include <boltzmann/pictures/projection.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <utility>

namespace boltzmann {
namespace {

using Positions = std::vector<std::span<double const>>;  // one array per axis

void need_length(std::size_t found, std::size_t wanted, std::string const& what) {
  if (found != wanted)
    throw Error("a drawing of " + std::to_string(wanted) + " particles can't use " + std::to_string(found) +
                " numbers for " + what);
}

struct Extremes {
  double low = std::numeric_limits<double>::infinity(), high = -std::numeric_limits<double>::infinity();
  explicit Extremes(std::span<double const> values) {
    for (double const v : values)
      if (std::isfinite(v)) low = std::min(low, v), high = std::max(high, v);
  }
  bool empty() const { return low > high; }
  double width() const { return empty() ? 0 : high - low; }
};

void check(Positions const& position, CartesianStyle const& style) {
  std::size_t const count = position[0].size(), dimensions = position.size();
  need_length(position[1].size(), count, "y");
  if (dimensions == 3) need_length(position[2].size(), count, "z");
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

// The ends of the colour range.
std::array<double, 2> ends_of(CartesianStyle const& style) {
  Extremes limits(style.value);
  if (limits.empty()) limits.low = limits.high = 0;
  if (style.map == ColourMap::diverging) {
    limits.high = std::max(std::abs(limits.low), std::abs(limits.high));
    limits.low = -limits.high;
  }
  if (std::isfinite(style.value_low)) limits.low = style.value_low;
  if (std::isfinite(style.value_high)) limits.high = style.value_high;
  return {limits.low, limits.high};
}

constexpr Colour connection_colour{0.50F, 0.53F, 0.57F, 1};

// The shortest distance from a to b along an axis that may be periodic.
double shortest(double way, CartesianStyle const& style, std::size_t axis) {
  if (axis < style.box.size() && style.periodic[axis]) {
    double const width = style.box[axis][1] - style.box[axis][0];
    if (width > 0 && std::abs(way) > width / 2) return way - width * std::round(way / width);
  }
  return way;
}

// One cloud per species, in ascending order.
std::vector<Canvas::Cloud> clouds_of(Positions const& position, CartesianStyle const& style,
                                     std::array<double, 2> const& ends) {
  Canvas::Cloud like;
  like.dimension = static_cast<int>(position.size());
  like.map = style.map;
  like.shaded = position.size() == 3;
  like.common_diameter = style.diameter.empty() ? style.common_diameter : 0;
  like.size = fitting_point(position[0].size());
  for (std::size_t a = 0; a < position.size(); ++a) {
    Extremes const limits(position[a]);
    if (limits.empty()) continue;
    like.origin[a] = limits.low;
    like.scale[a] = limits.width() > 0 ? limits.width() : 1;
  }
  std::map<int, Canvas::Cloud> clouds;
  for (std::size_t i = 0; i < position[0].size(); ++i) {
    int const species = style.species.empty() ? 0 : style.species[i];
    auto const [found, is_new] = clouds.try_emplace(species, like);
    Canvas::Cloud& cloud = found->second;
    if (is_new) {
      cloud.colour = style.species.empty() ? species_colour(0) : colour_of(style, species);
      if (species >= 0 && static_cast<std::size_t>(species) < style.species_names.size())
        cloud.ensemble = style.species_names[static_cast<std::size_t>(species)];
    }
    for (std::size_t a = 0; a < position.size(); ++a)
      cloud.position.push_back(static_cast<float>((position[a][i] - like.origin[a]) / like.scale[a]));
    if (!style.value.empty()) {
      double const place = place_between(ends[0], ends[1], style.value[i]);
      cloud.value.push_back(static_cast<float>(std::isnan(place) ? place : std::clamp(place, 0.0, 1.0)));
    }
    if (!style.diameter.empty()) cloud.diameter.push_back(static_cast<float>(style.diameter[i]));
  }
  std::vector<Canvas::Cloud> all;
  for (auto& [species, cloud] : clouds) all.push_back(std::move(cloud));
  return all;
}

double distance_between(Positions const& position, CartesianStyle const& style,
                        std::array<std::array<double, 2>, 3> const& box) {
  auto const count = static_cast<double>(std::max<std::size_t>(position[0].size(), 1));
  if (position.size() == 3) {
    double volume = 1;
    for (auto const& side : box) volume *= side[1] - side[0];
    return std::cbrt(volume / count);
  }
  auto const width = [&](std::size_t a) { return Extremes(style.box.empty() ? position[a] : style.box[a]).width(); };
  double const area = width(0) * width(1);
  return area > 0 ? std::sqrt(area / count) : std::max({width(0), width(1), 1.0}) / 10;
}

Canvas draw(Positions const& position, CartesianStyle const& style, Projection const* projection) {
  check(position, style);
  Canvas canvas = start_cartesian(style, projection);
  auto const place = [&](std::size_t i) {
    Place3 result{};
    for (std::size_t a = 0; a < position.size(); ++a) result[a] = position[a][i];
    return result;
  };
  for (auto const& [i, j] : style.connections) draw_connection(canvas, place(i), place(j), style);
  auto const ends = ends_of(style);
  for (auto& cloud : clouds_of(position, style, ends)) canvas.cloud(std::move(cloud));
  explain_colours(canvas, style, ends[0], ends[1], !style.value.empty());
  note_without_value(canvas, static_cast<std::size_t>(std::count_if(style.value.begin(), style.value.end(),
                                                                    [](double v) { return std::isnan(v); })));
  std::array<std::array<double, 2>, 3> box{};
  if (projection) {  // fit to the particles only
    box = space_box(canvas);
    std::array<Axis, 3> axes{canvas.x_axis(), canvas.y_axis(), canvas.z_axis()};
    for (std::size_t a = 0; a < 3; ++a) axes[a].low = box[a][0], axes[a].high = box[a][1];
    canvas.axes(axes[0], axes[1], axes[2], *projection);
  }
  if (!style.velocity[0].empty()) {
    std::vector<PlacedVector> arrows(position[0].size());
    for (std::size_t i = 0; i < arrows.size(); ++i) {
      arrows[i].place = place(i);
      for (std::size_t a = 0; a < position.size(); ++a) arrows[i].vector[a] = style.velocity[a][i];
    }
    draw_arrows(canvas, arrows, distance_between(position, style, box), 1, style.velocity_unit);
  }
  return canvas;
}

}  // namespace

float fitting_point(std::size_t count) {
  return static_cast<float>(std::clamp(180 / std::sqrt(static_cast<double>(count) + 1), 1.4, 9.0));
}

Canvas start_cartesian(CartesianStyle const& style, Projection const* projection) {
  Canvas canvas;
  canvas.title(style.title);
  canvas.equal_aspect(true);
  std::array<Axis, 3> axes;
  for (std::size_t a = 0; a < 3; ++a) {
    axes[a].label = style.axes[a];
    axes[a].unit = style.unit;
    axes[a].factor = style.unit_factor;
    if (a >= style.box.size()) continue;
    double const room = projection ? 0 : 0.03 * (style.box[a][1] - style.box[a][0]);
    if (!projection && !(room > 0)) continue;
    axes[a].low = style.box[a][0] - room;
    axes[a].high = style.box[a][1] + room;
  }
  if (projection) {
    canvas.frame(false);
    canvas.axes(axes[0], axes[1], axes[2], *projection);
    return canvas;
  }
  canvas.axes(axes[0], axes[1]);
  if (!style.box.empty())
    canvas.rectangle(style.box[0][0], style.box[1][0], style.box[0][1], style.box[1][1], with_alpha(ink, 0.45), 1.3F);
  return canvas;
}

void draw_connection(Canvas& canvas, Place3 const& from, Place3 const& to, CartesianStyle const& style) {
  Place3 half_way{}, half_back{};
  bool through = false;
  for (std::size_t a = 0; a < 3; ++a) {
    double const way = shortest(to[a] - from[a], style, a);
    through = through || way != to[a] - from[a];
    half_way[a] = from[a] + way / 2;
    half_back[a] = to[a] - way / 2;
  }
  auto const line = [&](Place3 const& a, Place3 const& b) {
    canvas.line({a[0], a[1], b[0], b[1], 2, connection_colour, a[2], b[2]});
  };
  if (through) {
    line(from, half_way);
    line(to, half_back);
  } else {
    line(from, to);
  }
}

void explain_colours(Canvas& canvas, CartesianStyle const& style, double low, double high, bool with_value) {
  if (with_value)
    canvas.colour_bar(style.value_name, style.value_unit, low, high, style.map, style.value_factor);
  else
    for (std::size_t s = 0; s < style.species_names.size(); ++s)
      canvas.legend(style.species_names[s], colour_of(style, static_cast<int>(s)));
}

void note_without_value(Canvas& canvas, std::size_t count) {
  if (count > 0)
    canvas.note(std::to_string(count) + (count == 1 ? " particle" : " particles") + " without a value (grey)");
}

void draw_arrows(Canvas& canvas, std::span<PlacedVector const> arrows, double particle_distance, double factor,
                 std::string const& unit) {
  auto const length = [](PlacedVector const& arrow) {
    return std::hypot(arrow.vector[0], arrow.vector[1], arrow.vector[2]);
  };
  double longest = 0;
  for (auto const& arrow : arrows)
    if (double const of = length(arrow); std::isfinite(of)) longest = std::max(longest, of);
  if (!(longest > 0)) return;
  canvas.note("longest arrow: " + number_text(longest * factor) + (unit.empty() ? "" : " " + unit));
  double const scale = 1.5 * particle_distance / longest;
  for (auto const& [at, way] : arrows)
    canvas.arrow(
        {at[0], at[1], at[0] + scale * way[0], at[1] + scale * way[1], 1.4F, ink, at[2], at[2] + scale * way[2]});
}

Canvas draw_cartesian(std::span<double const> x, std::span<double const> y, CartesianStyle const& style) {
  return draw({x, y}, style, nullptr);
}

Canvas draw_cartesian(std::span<double const> x, std::span<double const> y, std::span<double const> z,
                      CartesianStyle const& style, Projection const& projection) {
  return draw({x, y, z}, style, &projection);
}

}  // namespace boltzmann
