// Integrals over panels, and the equations of their strengths.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/schemes/panels/panel_kernels.hpp>
#include <boltzmann/schemes/panels/panel_sheet.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

namespace boltzmann {
namespace {

constexpr std::size_t max_panels = 2000;
/// Closer than this number of its lengths, a panel is integrated. Further away, three Gauss points represent it, with
/// relative errors below 1e-6.
constexpr double near_lengths = 5;
constexpr std::array<double, 3> gauss_places{0.11270166537925831, 0.5, 0.88729833462074169};
constexpr std::array<double, 3> gauss_weights{5.0 / 18, 8.0 / 18, 5.0 / 18};

/// In the frame of a panel: x along it, y to its left, into the body.
Vector<2> in_frame(SheetPanel const& panel, Vector<2> const& place) {
  auto const d = place - panel.from;
  return {dot(d, panel.along), panel.along[0] * d[1] - panel.along[1] * d[0]};
}

double log_of(double square) { return square > 0 ? 0.5 * std::log(square) : 0; }

/// The integrals of ln r over a panel, with weights 1 - s/L and s/L.
struct LogIntegrals {
  double falling, rising;
};
LogIntegrals log_integrals(SheetPanel const& panel, Vector<2> const& place) {
  auto const at = in_frame(panel, place);
  double const a = at[0], b = at[0] - panel.length, y = at[1];
  double const r1 = a * a + y * y, r2 = b * b + y * y, l1 = log_of(r1), l2 = log_of(r2);
  double const angle = y == 0 ? 0 : std::atan(a / y) - std::atan(b / y);
  double const whole = a * l1 - b * l2 - panel.length + y * angle;
  double const first = a * whole - (0.5 * (r1 * l1 - r2 * l2) - 0.25 * (a * a - b * b));
  double const rising = first / panel.length;
  return {whole - rising, rising};
}

}  // namespace

void PanelSheet::add(Outline const& outline, double circulation, bool kutta) {
  check(outline);
  if (kutta && !outline.sharp)
    throw Error("a Kutta condition needs a trailing edge, which this outline has not; give its circulation instead");
  std::size_t const count = outline.corners.size();
  if (panels_.size() + count > max_panels)
    throw Error(fmt::format("{} panels: at most {} of all bodies together can be solved for", panels_.size() + count,
                            max_panels));
  for (auto const& corner : outline.corners)
    if (!bodies_.empty() && inside(corner)) throw Error("two bodies overlap");
  Body body{panels_.size(), count, strengths_.size(),  count + (kutta ? 1 : 0),
            circulation,    kutta, outline.corners[0], outline.corners[0]};
  for (std::size_t i = 0; i < count; ++i) {
    auto const &from = outline.corners[i], &to = outline.corners[(i + 1) % count];
    double const length = magnitude(to - from);
    std::size_t const next = i + 1 == count && !kutta ? 0 : i + 1;
    panels_.push_back(
        {from, (to - from) / length, length, body.first_strength + i, body.first_strength + next, bodies_.size()});
    for (std::size_t a = 0; a < 2; ++a)
      body.low[a] = std::min(body.low[a], from[a]), body.high[a] = std::max(body.high[a], from[a]);
  }
  bodies_.push_back(body);
  strengths_.resize(strengths_.size() + body.strengths, 0.0);
  equations_ = {};
  find_near_cells();
  place_points();
}

void PanelSheet::strengths(std::span<double const> strengths) {
  if (strengths.size() != strengths_.size())
    throw Error("the checkpoint does not fit this simulation: its bodies differ");
  std::copy(strengths.begin(), strengths.end(), strengths_.begin());
  place_points();
}

double PanelSheet::circulation(std::size_t body) const {
  auto const& b = bodies_[body];
  double sum = 0;
  for (std::size_t k = b.first_panel; k < b.first_panel + b.panels; ++k)
    sum += 0.5 * panels_[k].length * (strengths_[panels_[k].first] + strengths_[panels_[k].second]);
  return sum;
}

void PanelSheet::factorise() {
  std::size_t const count = strengths_.size() + bodies_.size();
  std::vector<double> matrix(count * count, 0.0);
  std::size_t row = 0;
  for (std::size_t b = 0; b < bodies_.size(); ++b) {
    auto const& body = bodies_[b];
    // The stream function is constant at all corners of the body.
    for (std::size_t k = 0; k < body.panels; ++k, ++row) {
      double* const numbers = &matrix[row * count];
      auto const& corner = panels_[body.first_panel + k].from;
      for (auto const& panel : panels_) {
        auto const [falling, rising] = log_integrals(panel, corner);
        numbers[panel.first] -= falling / (2 * pi);
        numbers[panel.second] -= rising / (2 * pi);
      }
      numbers[strengths_.size() + b] = -1;
    }
    double* const last = &matrix[row++ * count];
    std::size_t const first = body.first_strength, end = first + body.strengths - 1;
    if (body.kutta) {
      last[first] = last[end] = 1;
      // The trailing edge has one corner and two strengths. Their sum continues smoothly.
      double* const smooth = &matrix[row++ * count];
      smooth[first] = 1, smooth[first + 1] = -2, smooth[first + 2] = 1;
      smooth[end] = -1, smooth[end - 1] = 2, smooth[end - 2] = -1;
    } else {
      for (std::size_t k = body.first_panel; k < body.first_panel + body.panels; ++k) {
        last[panels_[k].first] += 0.5 * panels_[k].length;
        last[panels_[k].second] += 0.5 * panels_[k].length;
      }
    }
  }
  equations_ = LinearEquations(std::move(matrix), count);
  numbers_.assign(count, 0.0);
}

void PanelSheet::state_equations(std::span<double const> normal_velocity, bool prescribed,
                                 std::vector<double>& numbers) const {
  std::size_t row = 0;
  for (auto const& body : bodies_) {
    double flux = 0, around = 0;
    for (std::size_t k = body.first_panel; k < body.first_panel + body.panels; ++k)
      flux += normal_velocity[k] * panels_[k].length, around += panels_[k].length;
    double stream =
        0;  // of the external flow; the net flux out of a body is zero, except for errors of the mean velocities
    for (std::size_t k = body.first_panel; k < body.first_panel + body.panels; ++k) {
      numbers[row++] = -stream;
      stream += (normal_velocity[k] - flux / around) * panels_[k].length;
    }
    numbers[row++] = body.kutta || !prescribed ? 0 : body.circulation;
    if (body.kutta) numbers[row++] = 0;
  }
}

Vector<2> PanelSheet::added_impulse(std::span<double const> normal_velocity) const {
  Vector<2> impulse{0, 0};
  if (equations_.size() == 0) return impulse;
  std::vector<double> numbers(numbers_.size());
  state_equations(normal_velocity, false, numbers);
  equations_.solve(numbers);
  for (auto const& panel : panels_) {
    auto const middle = panel.middle();
    double const circulation = 0.5 * (numbers[panel.first] + numbers[panel.second]) * panel.length;
    impulse += Vector<2>{middle[1], -middle[0]} * circulation;
  }
  return impulse;
}

void PanelSheet::solve(std::span<double const> normal_velocity) {
  if (equations_.size() == 0) factorise();
  state_equations(normal_velocity, true, numbers_);
  equations_.solve(numbers_);
  std::copy_n(numbers_.begin(), strengths_.size(), strengths_.begin());
  place_points();
}

/// (u - i v) = 1/(2 pi i) integral of the strength over (z - s), in the frame of the panel (J. Katz and A. Plotkin,
/// Low-Speed Aerodynamics, section 10.3). The logarithm is infinite at corners. Those of collinear neighbours cancel;
/// the remainder at a corner is smoothed over a fifth of the shortest panel.
Vector<2> PanelSheet::velocity(SheetPanel const& panel, Vector<2> const& place) const {
  auto const at = in_frame(panel, place);
  double const a = at[0], b = at[0] - panel.length, y = at[1];
  double const log = 0.5 * std::log((a * a + y * y + smooth2_) / (b * b + y * y + smooth2_));
  double const angle = std::atan2(0.0 - y * panel.length, a * b + y * y);  // on the panel: the outer side
  double const first = strengths_[panel.first], slope = (strengths_[panel.second] - first) / panel.length;
  double const value = first + slope * a;
  // (value + i slope y) (log + i angle) - slope length
  double const real = value * log - slope * y * angle - slope * panel.length;
  double const imaginary = value * angle + slope * y * log;
  double const u = imaginary / (2 * pi), v = real / (2 * pi);
  return panel.along * u - panel.normal() * v;
}

Vector<2> PanelSheet::velocity(Vector<2> const& place) const {
  Vector<2> sum{0, 0};
  for (auto const& panel : panels_) sum += velocity(panel, place);
  return sum;
}

double PanelSheet::stream_function(Vector<2> const& place) const {
  double sum = 0;
  for (auto const& panel : panels_) {
    auto const [falling, rising] = log_integrals(panel, place);
    sum -= (strengths_[panel.first] * falling + strengths_[panel.second] * rising) / (2 * pi);
  }
  return sum;
}

void PanelSheet::place_points() {
  std::size_t const count = panels_.size() * gauss_places.size();
  point_x_.resize(count), point_y_.resize(count), point_strength_.resize(count);
  std::size_t at = 0;
  for (auto const& panel : panels_)
    for (std::size_t g = 0; g < gauss_places.size(); ++g, ++at) {
      auto const place = panel.from + panel.along * (gauss_places[g] * panel.length);
      point_x_[at] = place[0], point_y_[at] = place[1];
      double const strength =
          strengths_[panel.first] + gauss_places[g] * (strengths_[panel.second] - strengths_[panel.first]);
      point_strength_[at] = gauss_weights[g] * panel.length * strength / (2 * pi);
    }
}

Vector<2> PanelSheet::velocity_of_points(std::size_t panel, Vector<2> const& place) const {
  Vector<2> sum{0, 0};
  for (std::size_t k = panel * gauss_places.size(); k < (panel + 1) * gauss_places.size(); ++k) {
    double const dx = place[0] - point_x_[k], dy = place[1] - point_y_[k];
    double const turn = point_strength_[k] / (dx * dx + dy * dy + core2_);
    sum += Vector<2>{-turn * dy, turn * dx};
  }
  return sum;
}

void PanelSheet::find_near_cells() {
  double shortest = std::numeric_limits<double>::infinity(), longest = 0, all = 0;
  Vector<2> low = panels_.front().from, high = low;
  for (auto const& panel : panels_) {
    shortest = std::min(shortest, panel.length), longest = std::max(longest, panel.length), all += panel.length;
    for (std::size_t a = 0; a < 2; ++a)
      low[a] = std::min(low[a], panel.from[a]), high[a] = std::max(high[a], panel.from[a]);
  }
  smooth2_ = square(0.2 * shortest);
  core2_ = square(1e-4 * shortest);
  double const reach = near_lengths * longest;
  low = low - Vector<2>{reach, reach}, high = high + Vector<2>{reach, reach};
  double const widest = std::max(high[0] - low[0], high[1] - low[1]);
  near_.low = low;
  near_.size = std::max(2 * all / static_cast<double>(panels_.size()), widest / 500);
  near_.nx = static_cast<std::size_t>((high[0] - low[0]) / near_.size) + 1;
  near_.ny = static_cast<std::size_t>((high[1] - low[1]) / near_.size) + 1;
  std::vector<std::uint32_t> counts(near_.nx * near_.ny + 1, 0);
  auto const each = [&](auto const& function) {
    for (std::size_t k = 0; k < panels_.size(); ++k) {
      auto const& panel = panels_[k];
      auto const to = panel.from + panel.along * panel.length;
      std::size_t first[2], last[2];
      for (std::size_t a = 0; a < 2; ++a) {
        double const from = std::min(panel.from[a], to[a]) - near_lengths * panel.length - low[a];
        double const end = std::max(panel.from[a], to[a]) + near_lengths * panel.length - low[a];
        first[a] = static_cast<std::size_t>(std::max(0.0, from / near_.size));
        last[a] = std::min(static_cast<std::size_t>(end / near_.size), (a == 0 ? near_.nx : near_.ny) - 1);
      }
      for (std::size_t y = first[1]; y <= last[1]; ++y)
        for (std::size_t x = first[0]; x <= last[0]; ++x) function(y * near_.nx + x, static_cast<std::uint32_t>(k));
    }
  };
  each([&](std::size_t cell, std::uint32_t) { ++counts[cell + 1]; });
  for (std::size_t c = 1; c < counts.size(); ++c) counts[c] += counts[c - 1];
  near_.begin = counts;
  near_.panels.resize(counts.back());
  each([&](std::size_t cell, std::uint32_t panel) { near_.panels[counts[cell]++] = panel; });
}

void PanelSheet::add_velocities(double const* x, double const* y, double* u, double* v, std::size_t count,
                                int threads) const {
  if (panels_.empty()) return;
  SheetPoints const points{point_x_.data(), point_y_.data(), point_strength_.data(), point_x_.size(), core2_};
  auto const velocities = for_instruction_set([](auto set) { return panel_kernels<set>().velocities; });
  constexpr std::size_t grain = 512;  // a multiple of the block of a kernel
  static_assert(grain % places_padding == 0);
  for_ranges(
      count, grain, threads_for(count, static_cast<double>(points.count) / 8, threads),
      [&](std::size_t begin, std::size_t end) {
        for (std::size_t from = begin; from < end; from += grain) {
          std::size_t const until = std::min(end, from + grain);
          velocities(points, x + from, y + from, u + from, v + from, until - from);
          for (std::size_t i = from; i < until; ++i) {
            double const cx = (x[i] - near_.low[0]) / near_.size, cy = (y[i] - near_.low[1]) / near_.size;
            if (!(cx >= 0 && cy >= 0 && cx < static_cast<double>(near_.nx) && cy < static_cast<double>(near_.ny)))
              continue;
            std::size_t const cell = static_cast<std::size_t>(cy) * near_.nx + static_cast<std::size_t>(cx);
            for (std::size_t k = near_.begin[cell]; k < near_.begin[cell + 1]; ++k) {
              Vector<2> const place{x[i], y[i]};
              auto const more = velocity(panels_[near_.panels[k]], place) - velocity_of_points(near_.panels[k], place);
              u[i] += more[0], v[i] += more[1];
            }
          }
        }
      });
}

bool PanelSheet::inside(Vector<2> const& place) const {
  for (auto const& body : bodies_) {
    if (place[0] < body.low[0] || place[1] < body.low[1] || place[0] > body.high[0] || place[1] > body.high[1])
      continue;
    bool odd = false;  // parity of the sides to the right of it
    for (std::size_t k = 0; k < body.panels; ++k) {
      auto const &a = panels_[body.first_panel + k].from, &b = panels_[body.first_panel + (k + 1) % body.panels].from;
      if ((a[1] > place[1]) != (b[1] > place[1]) && place[0] < a[0] + (place[1] - a[1]) / (b[1] - a[1]) * (b[0] - a[0]))
        odd = !odd;
    }
    if (odd) return true;
  }
  return false;
}

NearestPanel PanelSheet::nearest(Vector<2> const& place) const {
  NearestPanel nearest{0, std::numeric_limits<double>::infinity(), place};
  double least = std::numeric_limits<double>::infinity();
  for (std::size_t k = 0; k < panels_.size(); ++k) {
    auto const& panel = panels_[k];
    double const along = std::clamp(dot(place - panel.from, panel.along), 0.0, panel.length);
    auto const foot = panel.from + panel.along * along;
    double const distance2 = norm2(place - foot);
    if (distance2 < least) least = distance2, nearest.panel = k, nearest.foot = foot;
  }
  if (!panels_.empty()) nearest.distance = (inside(place) ? -1 : 1) * std::sqrt(least);
  return nearest;
}

std::size_t PanelSheet::bytes() const {
  return equations_.size() * equations_.size() * sizeof(double) + panels_.capacity() * sizeof(SheetPanel) +
         near_.panels.capacity() * sizeof(std::uint32_t) + 3 * point_x_.capacity() * sizeof(double);
}

}  // namespace boltzmann
