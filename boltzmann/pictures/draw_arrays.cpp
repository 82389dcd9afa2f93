// Phase space, spectra, time series and fields as marks on a canvas.
#include <boltzmann/core/error.hpp>
#include <boltzmann/pictures/canvas_ticks.hpp>
#include <boltzmann/pictures/contours.hpp>
#include <boltzmann/pictures/draw_arrays.hpp>
#include <boltzmann/pictures/drawing_cartesian.hpp>
#include <boltzmann/pictures/particle_clouds.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace boltzmann {
namespace {

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
  /// Sets missing ends of an axis.
  void give_ends(Axis& axis) const {
    if (axis.logarithmic || !(width() > 0)) return;
    if (!std::isfinite(axis.low)) axis.low = low;
    if (!std::isfinite(axis.high)) axis.high = high;
  }
};

}  // namespace

Canvas draw_phase_space(std::span<Series const> species, Axis x, Axis y, std::string title) {
  std::size_t total = 0;
  Limits right, up;
  for (auto const& one : species) {
    if (one.x.size() != one.y.size())
      throw Error("phase space of '" + one.label + "' has " + std::to_string(one.x.size()) + " x and " +
                  std::to_string(one.y.size()) + " y");
    total += one.x.size();
    for (double const v : one.x) right.add(v);
    for (double const v : one.y) up.add(v);
  }
  std::vector<Canvas::Cloud> clouds;
  for (std::size_t s = 0; s < species.size(); ++s) {
    Canvas::Cloud cloud;
    cloud.ensemble = species[s].label;
    cloud.colour = species[s].colour.value_or(species_colour(static_cast<int>(s)));
    if (!right.empty()) cloud.origin[0] = right.low, cloud.scale[0] = right.width() > 0 ? right.width() : 1;
    if (!up.empty()) cloud.origin[1] = up.low, cloud.scale[1] = up.width() > 0 ? up.width() : 1;
    cloud.position.reserve(2 * species[s].x.size());
    for (std::size_t i = 0; i < species[s].x.size(); ++i) {
      cloud.position.push_back(static_cast<float>((species[s].x[i] - cloud.origin[0]) / cloud.scale[0]));
      cloud.position.push_back(static_cast<float>((species[s].y[i] - cloud.origin[1]) / cloud.scale[1]));
    }
    clouds.push_back(std::move(cloud));
  }
  return draw_phase_space(std::move(clouds), std::move(x), std::move(y), std::move(title));
}

Canvas draw_phase_space(std::vector<Canvas::Cloud> clouds, Axis x, Axis y, std::string title) {
  Canvas canvas;
  canvas.title(std::move(title));
  canvas.axes(std::move(x), std::move(y));
  std::size_t total = 0;
  for (auto const& cloud : clouds) {
    total += cloud.count();
    if (!cloud.ensemble.empty() && clouds.size() > 1 && cloud.value.empty())
      canvas.legend(cloud.ensemble, cloud.colour);
  }
  for (auto& cloud : clouds) {
    cloud.size = std::clamp(fitting_point(total) * 1.6F, 1.6F, 9.0F);
    cloud.colour = with_alpha(cloud.colour, total > 300 ? 0.75 : 1);
  }
  for (auto& cloud : interleaved(std::move(clouds))) canvas.cloud(std::move(cloud));
  return canvas;
}

Canvas draw_spectrum(std::span<double const> frequency, std::span<double const> density, Axis x, Axis y,
                     bool log_density, std::string title) {
  Canvas canvas;
  canvas.title(std::move(title));
  y.logarithmic = log_density;
  Limits const limits(frequency);
  limits.give_ends(x);
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
  limits.give_ends(x);
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

// Completes the axis of a mesh with this number of cells, from low to high.
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
