// Tables of pressures: the monotone cubic, its integral, and files.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/materials/pressure_table.hpp>
#include <boltzmann/laws/two_columns.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

void check_points(std::span<PressurePoint const> points) {
  if (points.size() < 2) throw Error(fmt::format("pressure table: {} points; at least 2 are needed", points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    auto const [density, pressure] = points[k];
    if (!std::isfinite(density) || !std::isfinite(pressure) || density <= 0)
      throw Error(fmt::format("pressure table: point {} ({:.6g}, {:.6g}) must be finite, its density positive", k,
                              density, pressure));
    if (k > 0 && density <= points[k - 1].density)
      throw Error(fmt::format("pressure table: the density {:.6g} of point {} must be above {:.6g}, the one before",
                              density, k, points[k - 1].density));
  }
}

/// The slope at an end, from the two intervals next to it, h the width and d the secant: that of the parabola, unless
/// it would overshoot.
double end_slope(double h0, double d0, double h1, double d1) {
  double const slope = ((2 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
  if (slope * d0 <= 0) return 0;
  if (d0 * d1 <= 0 && std::fabs(slope) > 3 * std::fabs(d0)) return 3 * d0;
  return slope;
}

std::vector<double> slopes_of(std::span<PressurePoint const> points) {
  std::size_t const intervals = points.size() - 1;
  std::vector<double> h(intervals), d(intervals), slopes(intervals + 1);
  for (std::size_t k = 0; k < intervals; ++k) {
    h[k] = points[k + 1].density - points[k].density;
    d[k] = (points[k + 1].pressure - points[k].pressure) / h[k];
  }
  if (intervals == 1) return {d[0], d[0]};
  slopes.front() = end_slope(h[0], d[0], h[1], d[1]);
  slopes.back() = end_slope(h[intervals - 1], d[intervals - 1], h[intervals - 2], d[intervals - 2]);
  for (std::size_t k = 1; k < intervals; ++k) {
    if (d[k - 1] * d[k] <= 0) continue;  // an extremum
    double const before = h[k - 1] + 2 * h[k], after = 2 * h[k - 1] + h[k];
    slopes[k] = (before + after) / (before / d[k - 1] + after / d[k]);
  }
  return slopes;
}

// Largest ratio of the densities at the ends of a piece: eight points then integrate P / rho^2 to rounding.
constexpr double widest = 1.5;

}  // namespace

PressureTable::Value PressureTable::Piece::at(double density_there) const {
  double const x = density_there - density;
  return {c0 + x * (c1 + x * (c2 + x * c3)), c1 + x * (2 * c2 + x * 3 * c3)};
}

double PressureTable::Piece::energy_at(double density_there) const {
  // Points and weights of Gauss-Legendre quadrature.
  constexpr double place[] = {0.1834346424956498, 0.5255324099163290, 0.7966664774136267, 0.9602898564975363};
  constexpr double weight[] = {0.3626837833783620, 0.3137066458778873, 0.2223810344533745, 0.1012285362903763};
  double const half = (density_there - density) / 2, centre = density + half;
  double sum = 0;
  for (int k = 0; k < 4; ++k)
    for (double const sign : {-1.0, 1.0}) {
      double const rho = centre + sign * place[k] * half;
      sum += weight[k] * at(rho).pressure / (rho * rho);
    }
  return energy + half * sum;
}

PressureTable::PressureTable(std::span<PressurePoint const> points) {
  check_points(points);
  auto const slopes = slopes_of(points);
  auto pieces = std::make_shared<std::vector<Piece>>();
  double energy = points[0].pressure / points[0].density;
  for (std::size_t k = 0; k + 1 < points.size(); ++k) {
    double const begin = points[k].density, end = points[k + 1].density, h = end - begin;
    double const secant = (points[k + 1].pressure - points[k].pressure) / h;
    Piece const whole{begin,
                      points[k].pressure,
                      slopes[k],
                      (3 * secant - 2 * slopes[k] - slopes[k + 1]) / h,
                      (slopes[k] + slopes[k + 1] - 2 * secant) / (h * h),
                      0};
    double const parts = std::ceil(std::log(end / begin) / std::log(widest));
    for (double part = 0; part < parts; ++part) {
      double const from = begin * std::pow(end / begin, part / parts), x = from - begin;
      auto const [pressure, slope] = whole.at(from);
      pieces->push_back({from, pressure, slope, whole.c2 + 3 * whole.c3 * x, whole.c3, energy});
      energy = pieces->back().energy_at(part + 1 < parts ? begin * std::pow(end / begin, (part + 1) / parts) : end);
    }
  }
  pieces->push_back({points.back().density, points.back().pressure, slopes.back(), 0, 0, energy});
  first_ = points.front();
  last_ = points.back().density;
  pieces_ = std::move(pieces);
}

PressureTable::Piece const& PressureTable::piece(double density) const {
  auto const after = std::upper_bound(pieces_->begin() + 1, pieces_->end(), density,
                                      [](double x, Piece const& piece) { return x < piece.density; });
  return *(after - 1);
}

PressureTable::Value PressureTable::at(double density) const {
  if (density < first_.density) {
    double const push = first_.pressure / square(first_.density);
    return {push * square(density), 2 * push * density};
  }
  return piece(density).at(density);
}

double PressureTable::energy(double density) const {
  if (density < first_.density) return first_.pressure / square(first_.density) * density;
  auto const& there = piece(density);
  if (&there != &pieces_->back()) return there.energy_at(density);
  // The straight line beyond the last point.
  double const x = density - there.density, rising = there.c0 - there.c1 * there.density;
  return there.energy + rising * x / (density * there.density) + there.c1 * std::log1p(x / there.density);
}

PressureTable PressureTable::from_file(std::string const& path) {
  std::vector<PressurePoint> points;
  for (auto const& [density, pressure] : read_two_columns(path, "a density", "a pressure", true))
    points.push_back({density, pressure});
  return PressureTable(points);
}

}  // namespace boltzmann
