// The invariant law of internal energies, panel by panel.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/incomplete_gamma.hpp>
#include <boltzmann/core/random.hpp>
#include <boltzmann/laws/invariant_law.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

namespace boltzmann {
namespace {

constexpr double negligible = -750;  // exp of it is zero
constexpr double max_terms = 1e7;    // heat capacities over k above which gamma functions take too long
constexpr double sharpest = 1e16;    // above it, deviations of energies are lost in rounding
constexpr double far = 12;           // standard deviations; the law has 1e-32 of its mass beyond

/// The points and weights of Gauss-Legendre quadrature on (-1, 1): exact for polynomials of degree 2 N - 1.
template <int N>
struct GaussLegendre {
  std::array<double, N> point, weight;

  GaussLegendre() {
    for (int i = 0; i < N; ++i) {
      double x = std::cos(std::numbers::pi * (i + 0.75) / (N + 0.5)), slope = 0;
      for (int correction = 0; correction < 8; ++correction) {
        double last = 1, value = x;
        for (int n = 2; n <= N; ++n) {
          double const next = ((2 * n - 1) * x * value - (n - 1) * last) / n;
          last = value;
          value = next;
        }
        slope = N * (x * value - last) / (x * x - 1);
        x -= value / slope;
      }
      point[i] = x;
      weight[i] = 2 / ((1 - x * x) * slope * slope);
    }
  }
};

/// alpha [ln(T / T0) - (T - T0) / T0], for the heat capacity alpha k.
double exponent_of(double alpha, double temperature, double bath) {
  double const x = (temperature - bath) / bath;
  return alpha * (std::log1p(x) - x);
}

}  // namespace

InvariantLaw::InvariantLaw(StateLaw const& law, double temperature, double boltzmann_constant)
    : law_(law), bath_(temperature), k_(boltzmann_constant) {
  if (!(temperature > 0) || !std::isfinite(temperature))
    throw Error(fmt::format("internal energies: the temperature must be positive, it is {}", temperature));
  if (!(boltzmann_constant > 0) || !std::isfinite(boltzmann_constant))
    throw Error(
        fmt::format("internal energies: the Boltzmann constant must be positive, it is {}", boltzmann_constant));
  double const at_bath = law.heat_capacity(bath_) / k_;
  if (at_bath > sharpest) {
    sharp_ = std::min(std::sqrt(at_bath), 1e150);
  } else if (law.constant()) {
    // Sharp laws use panels around the middle, since gamma functions need more terms the sharper they are.
    double const alpha = at_bath, half = alpha > 200 ? far / std::sqrt(alpha) : 0;
    cover(bath_ * (1 - half), bath_ * (1 + half));
  } else {
    double first = law.temperature_.front(), last = law.temperature_.back();
    if (double const alpha = law.capacity_.front() / k_; alpha > max_terms)
      first = std::min(first, bath_ * (1 - far / std::sqrt(alpha)));
    if (double const alpha = law.capacity_.back() / k_; alpha > max_terms)
      last = std::max(last, bath_ * (1 + far / std::sqrt(alpha)));
    cover(first, last);
  }
}

/// Panels from the first to the last temperature, and the ends beside them.
void InvariantLaw::cover(double first, double last) {
  double const low_capacity = law_.heat_capacity(first), high_capacity = law_.heat_capacity(last);
  double const middle = std::clamp(bath_, first, last);
  double const top = middle < bath_   ? exponent_of(high_capacity / k_, last, bath_)
                     : middle > bath_ ? exponent_of(low_capacity / k_, first, bath_)
                                      : 0;
  low_exponent_ = high_exponent_ = top;
  if (first < middle) add_panels(middle, first, top);
  std::reverse(panels_.begin(), panels_.end());
  if (middle < last) add_panels(middle, last, top);

  low_ = end(first, low_capacity, low_exponent_, true);
  high_ = end(last, high_capacity, high_exponent_, false);
  double below = low_.mass;
  for (Panel& panel : panels_) {
    panel.mass = integral(panel, panel.width);
    panel.below = below;
    below += panel.mass;
  }
  double above = high_.mass;
  for (auto panel = panels_.rbegin(); panel != panels_.rend(); ++panel) {
    panel->above = above;
    above += panel->mass;
  }
  total_ = low_.mass + above;
  low_.others = above;
  high_.others = below;
}

/// From the maximum outwards, so that exponents are sums of small numbers. Within a panel the exponent changes by a few
/// units and the temperature by a quarter at most, and there is no point of the table.
void InvariantLaw::add_panels(double from, double to, double exponent) {
  bool const up = to > from;
  double& reached = up ? high_exponent_ : low_exponent_;
  std::vector<double> const& points = law_.temperature_;
  double t = from;
  while ((up ? t < to : t > to) && exponent > negligible) {
    double edge = to;
    if (!law_.constant()) {
      if (up)
        edge = t < points.back() ? *std::upper_bound(points.begin(), points.end() - 1, t) : to;
      else
        edge = t > points.front() ? *(std::lower_bound(points.begin() + 1, points.end(), t) - 1) : to;
    }
    double const lowest = up ? t : std::max(edge, 0.8 * t), highest = up ? std::min(edge, 1.25 * t) : t;
    double const alpha = std::max(law_.heat_capacity(lowest), law_.heat_capacity(highest)) / k_;
    double const steepest = alpha * std::abs(1 / t - 1 / bath_);
    double width = std::min(highest - lowest, lowest / std::sqrt(alpha));
    if (steepest * width > 2) width = 2 / steepest;
    double const next = width == highest - lowest ? (up ? highest : lowest) : (up ? t + width : t - width);
    if (next == t) break;
    Panel panel{up ? t : next, std::abs(next - t), 0, 0, 0};
    panel.capacity = law_.heat_capacity(panel.start);
    panel.slope = (law_.heat_capacity(up ? next : t) - panel.capacity) / panel.width;
    double const change = exponent_in(panel, panel.width);
    panel.exponent = up ? exponent : exponent - change;
    exponent = up ? exponent + change : panel.exponent;
    panels_.push_back(panel);
    t = next;
  }
  reached = t == to ? exponent : 2 * negligible;  // the rest is negligible
}

/// The exponent at start + t: the integral of Cv(T) (1 / T - 1 / T0) / k, plus that at the start.
double InvariantLaw::exponent_in(Panel const& panel, double t) const {
  double const x = t / panel.start;
  double const constant_part = panel.capacity - panel.slope * panel.start;
  return panel.exponent +
         (constant_part * (std::log1p(x) - t / bath_) + panel.slope * t * (1 - (panel.start + 0.5 * t) / bath_)) / k_;
}

/// The integral of the density in energies, in units of k T, over temperatures from the start on.
double InvariantLaw::integral(Panel const& panel, double width) const {
  static GaussLegendre<10> const rule;
  double sum = 0;
  for (std::size_t i = 0; i < rule.point.size(); ++i) {
    double const t = 0.5 * width * (1 + rule.point[i]);
    sum += rule.weight[i] * (panel.capacity + panel.slope * t) * std::exp(exponent_in(panel, t));
  }
  return 0.5 * width * sum / (k_ * bath_);
}

double InvariantLaw::scaled(double temperature, End const& end) const { return end.alpha * temperature / bath_; }

/// With y = alpha T / T0 the density is y^alpha e^-y.
InvariantLaw::End InvariantLaw::end(double temperature, double capacity, double exponent, bool low) const {
  double const alpha = capacity / k_;
  End result{temperature, alpha};
  if (alpha > max_terms) return result;  // far from the bath: negligible
  double const y = scaled(temperature, result);
  result.log_below = log_lower_gamma(alpha + 1, y);
  result.log_above = log_upper_gamma(alpha + 1, y);
  result.mass = std::exp(exponent - exponent_of(alpha, temperature, bath_) +
                         (low ? result.log_below : result.log_above) - log_poisson(alpha, alpha));
  return result;
}

std::size_t InvariantLaw::panel_at(double temperature) const {
  auto const above = std::upper_bound(panels_.begin() + 1, panels_.end(), temperature,
                                      [](double t, Panel const& panel) { return t < panel.start; });
  return static_cast<std::size_t>(above - panels_.begin()) - 1;
}

double InvariantLaw::distribution(double energy) const {
  if (std::isnan(energy)) return energy;
  if (!(energy > 0)) return 0;
  double const temperature = law_.temperature(energy);
  if (sharp_ > 0) return 0.5 * std::erfc(-(temperature - bath_) / bath_ * sharp_ / std::numbers::sqrt2);
  if (temperature <= low_.temperature) {
    if (low_.mass == 0) return 0;
    double const log_part = log_lower_gamma(low_.alpha + 1, scaled(temperature, low_)) - low_.log_below;
    return std::exp(log_part) * low_.mass / total_;
  }
  if (temperature >= high_.temperature) {
    if (high_.mass == 0) return 1;
    double const y = scaled(temperature, high_);
    if (temperature >= bath_)
      return 1 - std::exp(log_upper_gamma(high_.alpha + 1, y) - high_.log_above) * high_.mass / total_;
    double const between = std::exp(log_lower_gamma(high_.alpha + 1, y)) - std::exp(high_.log_below);
    return (high_.others + between * std::exp(-high_.log_above) * high_.mass) / total_;
  }
  Panel const& panel = panels_[panel_at(temperature)];
  double const part = integral(panel, std::clamp(temperature - panel.start, 0.0, panel.width));
  return temperature < bath_ ? (panel.below + part) / total_ : 1 - (panel.above + (panel.mass - part)) / total_;
}

double InvariantLaw::quantile(double u) const {
  if (!(u > 0 && u < 1)) throw Error(fmt::format("internal energies: there is no quantile of {} outside (0, 1)", u));
  if (sharp_ > 0) return law_.energy(bath_ + Normal(0, 1).quantile(u) / sharp_ * bath_);
  double const below = u * total_, above = (1 - u) * total_;
  if (below < low_.mass) {
    double y = 0;  // from the nearer side
    if (u < 0.5) {
      y = lower_gamma_quantile(low_.alpha + 1, low_.log_below + std::log(below / low_.mass));
    } else {
      double const rest = std::exp(low_.log_below) * std::max(0.0, above - low_.others) / low_.mass;
      y = upper_gamma_quantile(low_.alpha + 1, std::log(std::exp(low_.log_above) + rest));
    }
    return law_.energy(y / low_.alpha * bath_);
  }
  if (above < high_.mass || panels_.empty()) {
    double y = 0;
    if (u < 0.5) {
      double const rest = std::exp(high_.log_above) * std::max(0.0, below - high_.others) / high_.mass;
      y = lower_gamma_quantile(high_.alpha + 1, std::log(std::exp(high_.log_below) + rest));
    } else {
      y = upper_gamma_quantile(high_.alpha + 1, high_.log_above + std::log(above / high_.mass));
    }
    return law_.energy(y / high_.alpha * bath_);
  }
  auto panel = u < 0.5 ? std::upper_bound(panels_.begin() + 1, panels_.end(), below,
                                          [](double mass, Panel const& p) { return mass < p.below; }) -
                             1
                       : std::partition_point(panels_.begin(), panels_.end() - 1,
                                              [&](Panel const& p) { return p.above > above; });
  double const target =
      std::clamp(u < 0.5 ? below - panel->below : panel->mass - (above - panel->above), 0.0, panel->mass);
  // Newton's method in a shrinking bracket.
  double low = 0, high = panel->width, t = panel->width * (panel->mass > 0 ? target / panel->mass : 0);
  for (int iteration = 0; iteration < 60; ++iteration) {
    double const excess = integral(*panel, t) - target;
    (excess < 0 ? low : high) = t;
    double const density = (panel->capacity + panel->slope * t) * std::exp(exponent_in(*panel, t)) / (k_ * bath_);
    double next = t - excess / density;
    if (!(next >= low && next <= high)) next = 0.5 * (low + high);
    bool const there = std::abs(next - t) <= 1e-15 * (panel->start + t);
    t = next;
    if (there) break;
  }
  return law_.energy(panel->start + t);
}

}  // namespace boltzmann
