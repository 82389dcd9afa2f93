// Tables of pair energies: splines through functions, points and files, and their errors.
#include <boltzmann/core/error.hpp>
#include <boltzmann/laws/table.hpp>
#include <boltzmann/laws/two_columns.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <cmath>

namespace boltzmann {
namespace {

constexpr std::size_t most_intervals = 200000, least_per_octave = 4, most_per_octave = 65536;

/// Solves low_k x_(k-1) + middle_k x_k + high_k x_(k+1) = right_k.
std::vector<double> tridiagonal(std::vector<double> const& low, std::vector<double> middle,
                                std::vector<double> const& high, std::vector<double> right) {
  std::size_t const n = right.size();
  for (std::size_t k = 1; k < n; ++k) {
    double const factor = low[k] / middle[k - 1];
    middle[k] -= factor * high[k - 1];
    right[k] -= factor * right[k - 1];
  }
  right[n - 1] /= middle[n - 1];
  for (std::size_t k = n - 1; k-- > 0;) right[k] = (right[k] - high[k] * right[k + 1]) / middle[k];
  return right;
}

/// The cubic spline in r through points.
class PointSpline {
 public:
  PointSpline(std::span<TablePoint const> points, SplineEnds ends) : points_(points.begin(), points.end()) {
    std::size_t const n = points_.size();
    std::vector<double> low(n, 0), middle(n, 1), high(n, 0), right(n, 0);  // for the curvatures at the points
    for (std::size_t k = 1; k + 1 < n; ++k) {
      low[k] = width(k - 1);
      middle[k] = 2 * (width(k - 1) + width(k));
      high[k] = width(k);
      right[k] = 6 * (secant(k) - secant(k - 1));
    }
    if (ends.first_slope) {
      middle[0] = 2;
      high[0] = 1;
      right[0] = 6 * (secant(0) - *ends.first_slope) / width(0);
    }
    if (ends.last_slope) {
      middle[n - 1] = 2;
      low[n - 1] = 1;
      right[n - 1] = 6 * (*ends.last_slope - secant(n - 2)) / width(n - 2);
    }
    curvature_ = tridiagonal(low, middle, high, right);
  }

  double energy(double r) const {
    std::size_t const k = interval(r);
    double const h = width(k), a = points_[k + 1].distance - r, b = r - points_[k].distance;
    return (a * points_[k].energy + b * points_[k + 1].energy) / h +
           ((a * a / h - h) * a * curvature_[k] + (b * b / h - h) * b * curvature_[k + 1]) / 6;
  }
  double slope(double r) const {
    std::size_t const k = interval(r);
    double const h = width(k), a = points_[k + 1].distance - r, b = r - points_[k].distance;
    return secant(k) + ((h - 3 * a * a / h) * curvature_[k] + (3 * b * b / h - h) * curvature_[k + 1]) / 6;
  }

 private:
  double width(std::size_t k) const { return points_[k + 1].distance - points_[k].distance; }
  double secant(std::size_t k) const { return (points_[k + 1].energy - points_[k].energy) / width(k); }
  std::size_t interval(double r) const {
    auto const after = std::upper_bound(points_.begin() + 1, points_.end() - 1, r,
                                        [](double x, TablePoint const& point) { return x < point.distance; });
    return static_cast<std::size_t>(after - points_.begin()) - 1;
  }

  std::vector<TablePoint> points_;
  std::vector<double> curvature_;
};

void check_points(std::span<TablePoint const> points) {
  if (points.size() < 2) throw Error(fmt::format("table: {} points; at least 2 are needed", points.size()));
  for (std::size_t k = 0; k < points.size(); ++k) {
    if (!std::isfinite(points[k].distance) || !std::isfinite(points[k].energy) || points[k].distance < 0)
      throw Error(fmt::format("table: point {} ({:.6g}, {:.6g}) must be finite, its distance zero or positive", k,
                              points[k].distance, points[k].energy));
    if (k > 0 && points[k].distance <= points[k - 1].distance)
      throw Error(fmt::format("table: the distance {:.6g} of point {} must be above {:.6g}, the one before",
                              points[k].distance, k, points[k - 1].distance));
  }
}

double median(std::vector<double>& values) {
  auto const middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

}  // namespace

/// The function of a table, and the reference for its errors.
struct Table::Source {
  Energy energy;
  Energy exact_slope;  // dU/dr; empty: by differences
  double first, last;

  double value(double r) const {
    double const u = energy(r);
    if (!std::isfinite(u)) throw Error(fmt::format("table: the energy at distance {:.6g} is {}", r, u));
    return u;
  }
  /// dU/dr; nothing right beside the ends, where differences would be noise.
  std::optional<double> slope(double r) const {
    if (exact_slope) return exact_slope(r);
    double const d = std::min({3e-4 * r, (r - first) / 2, (last - r) / 2});
    if (d < 3e-5 * r) return std::nullopt;
    return (8 * (value(r + d) - value(r - d)) - (value(r + 2 * d) - value(r - 2 * d))) / (12 * d);
  }
  void check() const {
    if (!std::isfinite(first) || !std::isfinite(last) || first < 0 || last <= first)
      throw Error(fmt::format(
          "table: from distance {:.6g} to {:.6g}; the first must be zero or positive, the last above it", first, last));
    value(first);
    value(last);
  }
};

/// The ends, and between them the knots that are not too close to the ends.
std::vector<double> Table::knots_between(std::int64_t end_row) const {
  std::vector<double> s{least_};
  for (std::int64_t row = first_row_ + 1; row < end_row; ++row) {
    double const width = knot(row + 1) - knot(row);
    if (knot(row) - least_ > width / 4 && greatest_ - knot(row) > width / 4) s.push_back(knot(row));
  }
  s.push_back(greatest_);
  return s;
}

namespace {

/// dU/d(r^2) at the knots, so that two derivatives are continuous; u at the knots, h between them.
std::vector<double> slopes_at_knots(std::vector<double> const& u, std::vector<double> const& h, double first,
                                    double last) {
  std::size_t const n = h.size();
  std::vector<double> low(n + 1, 0), middle(n + 1, 1), high(n + 1, 0), right(n + 1);
  for (std::size_t k = 1; k < n; ++k) {
    low[k] = 1 / h[k - 1];
    high[k] = 1 / h[k];
    middle[k] = 2 * (low[k] + high[k]);
    right[k] = 3 * ((u[k] - u[k - 1]) * low[k] * low[k] + (u[k + 1] - u[k]) * high[k] * high[k]);
  }
  right[0] = first;
  right[n] = last;
  return tridiagonal(low, middle, high, right);
}

}  // namespace

Table::Table(Source const& source, PerOctave fineness) {
  source.check();
  if (!std::has_single_bit(fineness.intervals) || fineness.intervals < least_per_octave ||
      fineness.intervals > most_per_octave)
    throw Error(fmt::format("table: {} intervals per octave; powers of two from {} to {} are allowed",
                            fineness.intervals, least_per_octave, most_per_octave));
  // Octaves down to zero would be infinitely many.
  double const first = std::max(source.first, 1e-3 * source.last);
  least_ = first * first;
  greatest_ = source.last * source.last;
  shift_ = 52 - std::countr_zero(fineness.intervals);
  first_row_ = std::bit_cast<std::int64_t>(least_) >> shift_;
  std::int64_t const end_row = (std::bit_cast<std::int64_t>(greatest_) >> shift_) + 1;
  auto const rows = static_cast<std::size_t>(end_row - first_row_);
  if (rows > most_intervals) throw Error(fmt::format("table: {} intervals; {} are allowed", rows, most_intervals));

  auto const s = knots_between(end_row);
  std::size_t const n = s.size() - 1;
  if (n < 3)
    throw Error(
        fmt::format("table: from distance {:.6g} to {:.6g} there are fewer than 3 intervals; take more per octave",
                    source.first, source.last));
  auto const energy_at = [&](double square) {
    return source.value(std::clamp(std::sqrt(square), source.first, source.last));
  };
  std::vector<double> u(n + 1), h(n);
  for (std::size_t k = 0; k <= n; ++k) u[k] = energy_at(s[k]);
  for (std::size_t k = 0; k < n; ++k) h[k] = s[k + 1] - s[k];
  auto const end_slope = [&](double square, double step) {
    auto const v = [&](int k) { return energy_at(square + k * step); };
    return (48 * v(1) - 36 * v(2) + 16 * v(3) - 3 * v(4) - 25 * v(0)) / (12 * step);
  };
  auto const slope = slopes_at_knots(u, h, end_slope(least_, h[0] / 16), end_slope(greatest_, -h[n - 1] / 16));

  auto data = std::make_shared<Data>();
  data->first = first;
  data->last = source.last;
  data->rows.resize(rows);
  for (std::size_t row = 0, k = 0; row < rows; ++row) {
    double const from = knot(first_row_ + static_cast<std::int64_t>(row));
    double const centre = (from + knot(first_row_ + static_cast<std::int64_t>(row) + 1)) / 2;
    while (k + 1 < n && centre > s[k + 1]) ++k;
    double const mean = (u[k + 1] - u[k]) / h[k];
    double const c2 = (3 * mean - 2 * slope[k] - slope[k + 1]) / h[k];
    double const c3 = (slope[k] + slope[k + 1] - 2 * mean) / (h[k] * h[k]);
    double const e = from - s[k];  // zero, except for the intervals at the ends
    data->rows[row] = {
        {u[k] + e * (slope[k] + e * (c2 + e * c3)), slope[k] + e * (2 * c2 + e * 3 * c3), c2 + 3 * c3 * e, c3}};
  }
  rows_ = data->rows[0].c;
  data_ = data;
  data->error = measured(*this, source);
}

TableError Table::measured(Table const& table, Source const& source) {
  constexpr double places[] = {0.03, 0.1, 0.2113, 0.35, 0.5, 0.65, 0.7887, 0.9, 0.97};
  std::vector<double> energies, forces;
  struct Sample {
    double energy_error, energy, force_error, force;
  };
  std::vector<Sample> samples;
  auto const measure_between = [&](double begin, double end) {
    for (double const t : places) {
      double const square = begin + t * (end - begin), r = std::sqrt(square);
      if (!(r > source.first && r < source.last)) continue;
      double const energy = source.value(r);
      auto const value = table.at(square);
      auto const force = source.slope(r);
      double const of_table = 2 * r * value.slope;
      samples.push_back({std::fabs(value.energy - energy), std::fabs(energy),
                         std::fabs(of_table - force.value_or(of_table)), std::fabs(force.value_or(of_table))});
    }
  };
  for (std::size_t k = 0; k < table.intervals(); ++k) {
    auto const row = table.first_row_ + static_cast<std::int64_t>(k);
    measure_between(std::max(table.knot(row), table.least_), std::min(table.knot(row + 1), table.greatest_));
  }
  // The medians, over evenly spaced distances.
  int const distances = 1000;
  for (int k = 0; k < distances; ++k) {
    double const r = source.first + (source.last - source.first) * (k + 0.5) / distances;
    energies.push_back(std::fabs(source.value(r)));
    if (auto const force = source.slope(r)) forces.push_back(std::fabs(*force));
  }
  double const typical_energy = median(energies), typical_force = median(forces);
  TableError worst;
  auto const relative = [](double error, double size) { return error > 0 ? error / size : 0; };
  for (auto const& s : samples) {
    worst.energy = std::max(worst.energy, s.energy_error);
    worst.force = std::max(worst.force, s.force_error);
    worst.relative = std::max({worst.relative, relative(s.energy_error, s.energy + typical_energy),
                               relative(s.force_error, s.force + typical_force)});
  }
  double const margin = 1.05;
  return {margin * worst.energy, margin * worst.force, margin * worst.relative};
}

Table Table::within(Source const& source, Tolerance tolerance) {
  if (!std::isfinite(tolerance.relative) || tolerance.relative <= 0)
    throw Error(fmt::format("table: tolerance {:.6g} must be positive", tolerance.relative));
  for (std::size_t n = 16;; n *= 2) {
    Table table(source, PerOctave{n});
    if (table.error().relative <= tolerance.relative) return table;
    if (n == most_per_octave || 2 * table.intervals() > most_intervals)
      throw Error(
          fmt::format("table: {} intervals from distance {:.6g} to {:.6g} still have the relative error {:.3g}, "
                      "above the tolerance {:.3g}",
                      table.intervals(), source.first, source.last, table.error().relative, tolerance.relative));
  }
}

namespace {

struct Spline {
  std::shared_ptr<PointSpline const> spline;
  explicit Spline(std::span<TablePoint const> points, SplineEnds ends) {
    check_points(points);
    for (auto const& slope : {ends.first_slope, ends.last_slope})
      if (slope && !std::isfinite(*slope)) throw Error("table: the slope at an end of the spline must be finite");
    spline = std::make_shared<PointSpline>(points, ends);
  }
  auto energy() const {
    return [s = spline](double r) { return s->energy(r); };
  }
  auto slope() const {
    return [s = spline](double r) { return s->slope(r); };
  }
};

}  // namespace

Table::Table(Energy const& energy, double first, double last, Tolerance tolerance)
    : Table(within({energy, {}, first, last}, tolerance)) {}

Table::Table(Energy const& energy, double first, double last, PerOctave fineness)
    : Table(Source{energy, {}, first, last}, fineness) {}

Table::Table(std::span<TablePoint const> points, SplineEnds ends, Tolerance tolerance)
    : Table([&] {
        Spline const spline(points, ends);
        return within({spline.energy(), spline.slope(), points.front().distance, points.back().distance}, tolerance);
      }()) {}

Table::Table(std::span<TablePoint const> points, SplineEnds ends, PerOctave fineness)
    : Table([&] {
        Spline const spline(points, ends);
        return Table(Source{spline.energy(), spline.slope(), points.front().distance, points.back().distance},
                     fineness);
      }()) {}

Table Table::from_file(std::string const& path, SplineEnds ends, Tolerance tolerance) {
  std::vector<TablePoint> points;
  for (auto const& [distance, energy] : read_two_columns(path, "a distance", "an energy", false))
    points.push_back({distance, energy});
  try {
    return Table(points, ends, tolerance);
  } catch (Error const& error) {
    throw Error(fmt::format("{}: {}", path, error.what()));
  }
}

}  // namespace boltzmann
