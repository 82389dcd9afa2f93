// Sedov's point blast: the self-similar flow behind a strong shock, integrated from the shock inwards.
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <vector>

namespace boltzmann {

/// The flow at r = part * R, with R the radius of the shock and R' its speed: velocity / R', density / that before the
/// shock, pressure / (that density R'^2).
struct BlastPoint {
  double part, velocity, density, pressure;
};

/// In D dimensions, in cold gas of uniform density. R = xi (E t^2 / density)^(1/(D+2)).
class SedovBlast {
 public:
  SedovBlast(int dimension, double gamma) : dimension_(dimension), gamma_(gamma) {
    constexpr int steps = 20000;
    double const surface = dimension == 1 ? 2 : dimension == 2 ? 2 * std::numbers::pi : 4 * std::numbers::pi;
    std::array<double, 3> y{2 / (gamma + 1), (gamma + 1) / (gamma - 1), 2 / (gamma + 1)};
    double kinetic = 0, thermal = 0, moment = 0;
    double const h = -1.0 / steps;
    for (int k = 0; k < steps; ++k) {
      double const x = 1 + k * h;
      points_.push_back({x, y[0], y[1], y[2]});
      auto const shell = [&](double part, std::array<double, 3> const& at) {
        double const volume = surface * std::pow(part, dimension - 1) / steps;
        kinetic += 0.5 * 0.5 * at[1] * at[0] * at[0] * volume;
        thermal += 0.5 * at[2] / (gamma - 1) * volume;
        moment += 0.5 * at[1] * part * volume;
      };
      if (k == steps - 1) {  // the centre: pressure alone
        thermal += y[2] / (gamma - 1) * surface * std::pow(x, dimension) / dimension;
        break;
      }
      shell(x, y);
      auto const moved = [&](std::array<double, 3> const& slope, double by) {
        return std::array{y[0] + by * slope[0], y[1] + by * slope[1], y[2] + by * slope[2]};
      };
      auto const a = slopes(x, y), b = slopes(x + h / 2, moved(a, h / 2)), c = slopes(x + h / 2, moved(b, h / 2)),
                 d = slopes(x + h, moved(c, h));
      for (std::size_t i = 0; i < 3; ++i) y[i] += h / 6 * (a[i] + 2 * b[i] + 2 * c[i] + d[i]);
      shell(x + h, y);
    }
    std::reverse(points_.begin(), points_.end());
    double const n = dimension;
    xi_ = std::pow(4 / ((n + 2) * (n + 2)) * (kinetic + thermal), -1 / (n + 2));
    kinetic_share_ = kinetic / (kinetic + thermal);
    moved_ = moment - surface / (n + 1);
  }

  double xi() const { return xi_; }
  /// The kinetic part of the energy.
  double kinetic_share() const { return kinetic_share_; }
  double radius(double energy, double density, double time) const {
    return xi_ * std::pow(energy * time * time / density, 1.0 / (dimension_ + 2));
  }
  /// The radius from how far the gas has been moved outwards: Sum m (r - r at the start) / density.
  double radius_of_displacement(double moved_volume) const {
    return std::pow(moved_volume / moved_, 1.0 / (dimension_ + 1));
  }
  /// Behind the shock; before it the gas is at rest.
  BlastPoint at(double part) const {
    if (part > 1) return {part, 0, 1, 0};
    auto const k = static_cast<std::size_t>(part * static_cast<double>(points_.size() - 1));
    return points_[std::min(k, points_.size() - 1)];
  }

 private:
  /// Of velocity, density and pressure: mass, momentum and entropy along the flow, with R R'' = -(D/2) R'^2.
  std::array<double, 3> slopes(double x, std::array<double, 3> const& y) const {
    auto const [u, rho, p] = y;
    double const n = dimension_, a = u - x, spread = (n - 1) * u / x;
    double const du = (n * p - gamma_ * p * spread - 0.5 * n * a * rho * u) / (gamma_ * p - a * a * rho);
    return {du, -rho * (du + spread) / a, rho * (0.5 * n * u - a * du)};
  }

  int dimension_;
  double gamma_, xi_ = 0, kinetic_share_ = 0, moved_ = 0;
  std::vector<BlastPoint> points_;
};

}  // namespace boltzmann
