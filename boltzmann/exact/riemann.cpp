// The Riemann problem of an ideal gas; equation numbers are those of Toro's book.
#include <boltzmann/core/error.hpp>
#include <boltzmann/exact/checks.hpp>
#include <boltzmann/exact/riemann.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>

namespace boltzmann::exact {
namespace {

constexpr char const* name_of_riemann = "Riemann problem";

void check_state(char const* side, GasState const& state) {
  check_positive(name_of_riemann, fmt::format("density on the {}", side), state.density);
  check_finite(name_of_riemann, fmt::format("velocity on the {}", side), state.velocity);
  check_positive(name_of_riemann, fmt::format("pressure on the {}", side), state.pressure);
}

}  // namespace

Riemann::Riemann(GasState const& left, GasState const& right, double gamma)
    : left_(left), right_(right), gamma_(gamma) {
  check_state("left", left);
  check_state("right", right);
  if (!(gamma > 1) || !std::isfinite(gamma))
    throw Error(fmt::format("{}: gamma must be a number above 1, it is {}", name_of_riemann, gamma));
  double const apart = right.velocity - left.velocity, fastest = 2 * (sound(left) + sound(right)) / (gamma - 1);
  if (apart >= fastest)  // (4.40)
    throw Error(
        fmt::format("{}: the gases part at a velocity of {:.6g}, and a vacuum opens between them; below {:.6g} "
                    "(2 (c_left + c_right)/(gamma - 1)) there is none",
                    name_of_riemann, apart, fastest));
  double const lower = std::min(left.pressure, right.pressure);
  auto const velocity_lost = [&](double pressure) {
    auto const [f, df] = jump(left_, pressure);
    auto const [g, dg] = jump(right_, pressure);
    return Jump{f + g + apart, df + dg};
  };
  if (velocity_lost(lower).value >= 0) {  // two rarefactions, (4.46)
    double const power = (gamma - 1) / (2 * gamma);
    star_pressure_ = lower * std::pow((sound(left) + sound(right) - 0.5 * (gamma - 1) * apart) /
                                          (sound(left) * std::pow(lower / left.pressure, power) +
                                           sound(right) * std::pow(lower / right.pressure, power)),
                                      1 / power);
  } else {
    // The function is concave: from below, Newton's iteration approaches the root monotonically.
    star_pressure_ = lower;
    for (int iteration = 0; iteration < 200; ++iteration) {
      auto const [value, slope] = velocity_lost(star_pressure_);
      star_pressure_ -= value / slope;
      if (std::abs(value) <= 1e-15 * slope * star_pressure_) break;
    }
  }
  star_velocity_ = 0.5 * (left.velocity + right.velocity) +
                   0.5 * (jump(right_, star_pressure_).value - jump(left_, star_pressure_).value);  // (4.9)
}

double Riemann::shock_speed() const {
  if (star_pressure_ <= right_.pressure) return std::nan("");
  return right_.velocity + mass_flux(right_) / right_.density;  // (4.58)
}

GasState Riemann::at(double x, double time) const {
  check_finite(name_of_riemann, "place", x);
  check_not_negative(name_of_riemann, "time", time);
  if (time == 0) return x > 0 ? right_ : left_;
  double const speed = x / time;
  if (speed > star_velocity_) {
    GasState const mirrored =
        left_of_contact({right_.density, -right_.velocity, right_.pressure}, -star_velocity_, -speed);
    return {mirrored.density, -mirrored.velocity, mirrored.pressure};
  }
  return left_of_contact(left_, star_velocity_, speed);
}

double Riemann::sound(GasState const& s) const { return std::sqrt(gamma_ * s.pressure / s.density); }

double Riemann::mass_flux(GasState const& s) const {
  return std::sqrt(s.density * ((gamma_ + 1) * star_pressure_ + (gamma_ - 1) * s.pressure) / 2);
}

/// The velocity change by a wave from a state to a pressure, and its derivative by the pressure: (4.6), (4.7).
Riemann::Jump Riemann::jump(GasState const& s, double pressure) const {
  if (pressure > s.pressure) {
    double const a = 2 / ((gamma_ + 1) * s.density), b = (gamma_ - 1) / (gamma_ + 1) * s.pressure;
    double const root = std::sqrt(a / (pressure + b)), rise = pressure - s.pressure;
    return {rise * root, root * (1 - 0.5 * rise / (pressure + b))};
  }
  double const ratio = pressure / s.pressure, power = (gamma_ - 1) / (2 * gamma_);
  return {2 * sound(s) / (gamma_ - 1) * (std::pow(ratio, power) - 1),
          std::pow(ratio, -(gamma_ + 1) / (2 * gamma_)) / (s.density * sound(s))};
}

double Riemann::star_density(GasState const& s) const {
  double const ratio = star_pressure_ / s.pressure, k = (gamma_ - 1) / (gamma_ + 1);
  return ratio > 1 ? s.density * (ratio + k) / (k * ratio + 1) : s.density * std::pow(ratio, 1 / gamma_);
}

GasState Riemann::left_of_contact(GasState const& s, double contact, double speed) const {
  GasState const star{star_density(s), contact, star_pressure_};
  if (star_pressure_ > s.pressure) return speed < s.velocity - mass_flux(s) / s.density ? s : star;
  double const c = sound(s);
  if (speed < s.velocity - c) return s;
  if (speed > contact - sound(star)) return star;
  double const fan = 2 / (gamma_ + 1) * (1 + (gamma_ - 1) / 2 * (s.velocity - speed) / c);  // c / that of s, (4.56)
  return {s.density * std::pow(fan, 2 / (gamma_ - 1)), 2 / (gamma_ + 1) * (c + (gamma_ - 1) / 2 * s.velocity + speed),
          s.pressure * std::pow(fan, 2 * gamma_ / (gamma_ - 1))};
}

Riemann sod(double gamma) { return {{1, 0, 1}, {0.125, 0, 0.1}, gamma}; }

}  // namespace boltzmann::exact
