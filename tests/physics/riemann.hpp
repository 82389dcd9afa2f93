// The Riemann problem of an ideal gas, solved exactly: two uniform states that meet at x = 0 at time 0.
#pragma once

#include <cmath>

namespace boltzmann {

struct GasState {
  double density, velocity, pressure;
};

/// The waves between two states: a shock or a rarefaction on each side, and the contact between them. No vacuum.
class Riemann {
 public:
  Riemann(GasState const& left, GasState const& right, double gamma) : left_(left), right_(right), gamma_(gamma) {
    // Newton's iteration for the pressure at which both waves leave matter with one velocity.
    star_pressure_ = 0.5 * (left.pressure + right.pressure);
    for (int iteration = 0; iteration < 60; ++iteration) {
      auto const [f, df] = jump(left_, star_pressure_);
      auto const [g, dg] = jump(right_, star_pressure_);
      double const change = (f + g + right.velocity - left.velocity) / (df + dg);
      star_pressure_ = std::fmax(star_pressure_ - change, 1e-3 * star_pressure_);
    }
    star_velocity_ = left.velocity - jump(left_, star_pressure_).value;
  }

  double star_pressure() const { return star_pressure_; }
  double star_velocity() const { return star_velocity_; }
  double left_density() const { return star_density(left_); }
  double right_density() const { return star_density(right_); }
  /// Of the shock that runs to the right. NaN if a rarefaction does.
  double shock_speed() const {
    if (star_pressure_ <= right_.pressure) return std::nan("");
    return right_.velocity + mass_flux(right_) / right_.density;
  }

  /// The state at x/t.
  GasState at(double speed) const {
    if (speed > star_velocity_) {
      GasState const mirrored = wave({right_.density, -right_.velocity, right_.pressure}, -star_velocity_, -speed);
      return {mirrored.density, -mirrored.velocity, mirrored.pressure};
    }
    return wave(left_, star_velocity_, speed);
  }

 private:
  struct Jump {
    double value, slope;
  };
  double sound(GasState const& s) const { return std::sqrt(gamma_ * s.pressure / s.density); }
  double mass_flux(GasState const& s) const {
    return std::sqrt(s.density * ((gamma_ + 1) * star_pressure_ + (gamma_ - 1) * s.pressure) / 2);
  }
  /// How much velocity a wave from a state to the pressure p takes away, and d/dp.
  Jump jump(GasState const& s, double p) const {
    if (p > s.pressure) {
      double const a = 2 / ((gamma_ + 1) * s.density), b = (gamma_ - 1) / (gamma_ + 1) * s.pressure;
      double const root = std::sqrt(a / (p + b));
      return {(p - s.pressure) * root, root * (1 - 0.5 * (p - s.pressure) / (p + b))};
    }
    double const ratio = p / s.pressure, power = (gamma_ - 1) / (2 * gamma_);
    return {2 * sound(s) / (gamma_ - 1) * (std::pow(ratio, power) - 1),
            std::pow(ratio, -(gamma_ + 1) / (2 * gamma_)) / (s.density * sound(s))};
  }
  double star_density(GasState const& s) const {
    double const ratio = star_pressure_ / s.pressure, k = (gamma_ - 1) / (gamma_ + 1);
    return ratio > 1 ? s.density * (ratio + k) / (k * ratio + 1) : s.density * std::pow(ratio, 1 / gamma_);
  }
  /// Left of the contact.
  GasState wave(GasState const& s, double contact, double speed) const {
    GasState const star{star_density(s), contact, star_pressure_};
    if (star_pressure_ > s.pressure) return speed < s.velocity - mass_flux(s) / s.density ? s : star;
    double const c = sound(s);
    if (speed < s.velocity - c) return s;
    if (speed > contact - sound(star)) return star;
    double const fan = 2 / (gamma_ + 1) * (1 + (gamma_ - 1) / 2 * (s.velocity - speed) / c);  // c / c0
    return {s.density * std::pow(fan, 2 / (gamma_ - 1)), 2 / (gamma_ + 1) * (c + (gamma_ - 1) / 2 * s.velocity + speed),
            s.pressure * std::pow(fan, 2 * gamma_ / (gamma_ - 1))};
  }

  GasState left_, right_;
  double gamma_, star_pressure_, star_velocity_;
};

}  // namespace boltzmann
