// Sedov's point blast, by quadrature from the shock inwards.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/exact/checks.hpp>
#include <boltzmann/exact/sedov.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>

// With x = r/R, W = u/(x R'), s = ln x, L = ln(density), mass and momentum along the flow and R R'' = -(D/2) R'^2 give
// dW/ds and dL/ds. The energy within a surface that moves at constant x is conserved, W (rho u^2/2 + gamma p/(gamma -
// 1)) = rho u^2/2 + p/(gamma - 1). This gives the pressure, so that both slopes are functions of W alone. W falls from
// 2/(gamma + 1) at the shock to 1/gamma in the middle; with y = ln(gamma W - 1) both s and L become straight there.
namespace boltzmann::exact {
namespace {

constexpr char const* name_of_blast = "Sedov's blast";
constexpr double knot_spacing = 0.005;
constexpr int knot_count = 8000;  // gamma W - 1 falls by exp(-40): W is 1/gamma to the last bit

/// y(t) for t from 0 to 1, from values and slopes (by t) at both ends.
double hermite(double t, double value, double slope, double next, double next_slope) {
  double const rest = 1 - t;
  return rest * rest * ((1 + 2 * t) * value + t * slope) + t * t * ((3 - 2 * t) * next - rest * next_slope);
}

}  // namespace

SedovBlast::SedovBlast(int dimension, double gamma) : dimension_(dimension), gamma_(gamma) {
  if (dimension < 1 || dimension > 3)
    throw Error(fmt::format("{}: the dimension must be 1, 2 or 3, it is {}", name_of_blast, dimension));
  if (!(gamma > 1) || !std::isfinite(gamma))
    throw Error(fmt::format("{}: gamma must be a number above 1, it is {}", name_of_blast, gamma));
  if (dimension == 3 && gamma >= 7)
    throw Error(fmt::format("{}: in 3D gamma must be below 7, beyond which the middle is empty; it is {}",
                            name_of_blast, gamma));
  double const n = dimension, surface = dimension == 1 ? 2 : dimension == 2 ? 2 * pi : 4 * pi;
  using Sums = std::array<double, 4>;  // position, density, and the kinetic and the thermal energy further out
  auto const slopes = [&](double y, Sums const& at) {
    Knot const here = knot(y, at[0], at[1]);
    double const w = (1 + std::exp(y)) / gamma, volume = std::exp(n * at[0]) * here.place_slope;
    return Sums{here.place_slope, here.density_slope, -0.5 * std::exp(at[1] + 2 * at[0]) * w * w * volume,
                -pressure(y, at[0], at[1]) / (gamma - 1) * volume};
  };
  auto const moved = [](Sums const& from, Sums const& slope, double by) {
    Sums to;
    for (std::size_t i = 0; i < to.size(); ++i) to[i] = from[i] + by * slope[i];
    return to;
  };
  double const start = std::log((gamma - 1) / (gamma + 1)), h = -knot_spacing;
  Sums sums{0, -start, 0, 0};
  knots_.reserve(knot_count + 1);
  for (int k = 0;; ++k) {
    double const y = start + k * h;
    knots_.push_back(knot(y, sums[0], sums[1]));
    if (k == knot_count) break;
    Sums const a = slopes(y, sums), b = slopes(y + h / 2, moved(sums, a, h / 2)),
               c = slopes(y + h / 2, moved(sums, b, h / 2)), d = slopes(y + h, moved(sums, c, h));
    for (std::size_t i = 0; i < sums.size(); ++i) sums[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
  }
  Knot const& last = knots_.back();  // further in the pressure is constant
  double const core = pressure(last.y, last.place, last.density) / (gamma - 1) * std::exp(n * last.place) / n;
  double const energy = sums[2] + sums[3] + core;
  kinetic_share_ = sums[2] / energy;
  alpha_ = 4 / ((n + 2) * (n + 2)) * surface * energy;
  xi_ = std::pow(alpha_, -1 / (n + 2));
}

double SedovBlast::pressure(double y, double place, double density) const {
  double const w = (1 + std::exp(y)) / gamma_;
  return 0.5 * (gamma_ - 1) * w * w * (1 - w) * std::exp(density + 2 * place - y);
}

SedovBlast::Knot SedovBlast::knot(double y, double place, double density) const {
  double const n = dimension_, above = std::exp(y), w = (1 + above) / gamma_;
  double const y_slope = gamma_ * w * (1 + n / 2 - w * (1 + n * (gamma_ - 1) / 2)) /
                         (0.5 * gamma_ * (gamma_ - 1) * w * w - (1 - w) * above);  // by ln x
  return {y, place, density, 1 / y_slope, (n * w / y_slope + above / gamma_) / (1 - w)};
}

double SedovBlast::radius(double energy, double density, double time) const {
  check_positive(name_of_blast, "energy", energy);
  check_positive(name_of_blast, "density", density);
  check_not_negative(name_of_blast, "time", time);
  return xi_ * std::pow(energy / density * time * time, 1.0 / (dimension_ + 2));
}

double SedovBlast::shock_speed(double energy, double density, double time) const {
  check_positive(name_of_blast, "time", time);
  return 2.0 / (dimension_ + 2) * radius(energy, density, time) / time;
}

GasState SedovBlast::state(double distance, double time, double energy, double density) const {
  check_not_negative(name_of_blast, "distance", distance);
  double const speed = shock_speed(energy, density, time);
  BlastPoint const p = at(distance / radius(energy, density, time));
  return {density * p.density, speed * p.velocity, density * speed * speed * p.pressure};
}

BlastPoint SedovBlast::at(double part) const {
  check_not_negative(name_of_blast, "part of the radius", part);
  if (part > 1) return {part, 0, 1, 0};
  double const place = std::log(part);
  auto const inner =
      std::partition_point(knots_.begin(), knots_.end(), [&](Knot const& k) { return k.place >= place; });
  if (inner == knots_.end()) {
    Knot const& last = knots_.back();
    double const density =
        std::exp(last.density) * std::pow(part / std::exp(last.place), last.density_slope / last.place_slope);
    return {part, part / gamma_, density, pressure(last.y, last.place, last.density)};
  }
  if (inner == knots_.begin()) {
    Knot const& shock = knots_.front();
    return {part, 2 / (gamma_ + 1), std::exp(shock.density), pressure(shock.y, 0, shock.density)};
  }
  Knot const &from = *(inner - 1), &to = *inner;
  double const length = to.place - from.place, t = (place - from.place) / length;
  double const y = hermite(t, from.y, length / from.place_slope, to.y, length / to.place_slope);
  double const density = hermite(t, from.density, length * from.density_slope / from.place_slope, to.density,
                                 length * to.density_slope / to.place_slope);
  return {part, part * (1 + std::exp(y)) / gamma_, std::exp(density), pressure(y, place, density)};
}

}  // namespace boltzmann::exact
