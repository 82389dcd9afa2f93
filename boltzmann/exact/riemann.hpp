// The Riemann problem of an ideal gas, solved exactly: two uniform states that meet at x = 0 at time 0.
#pragma once

#include <boltzmann/exact/gas_state.hpp>

namespace boltzmann::exact {

/// The waves between two states, a shock or a rarefaction on each side and the contact between them (E. F. Toro,
/// *Riemann Solvers and Numerical Methods for Fluid Dynamics*, 3rd edition, 2009, chapter 4). Any consistent units.
class Riemann {
 public:
  /// `gamma` is the ratio of specific heats. Errors: a density or pressure that is not positive, a velocity that is not
  /// finite, gamma <= 1, and states that separate so fast that a vacuum opens between them.
  Riemann(GasState const& left, GasState const& right, double gamma);

  /// The state at x and t. The solution depends on x / t alone: at(speed, 1) is the state at x / t = speed. At t = 0,
  /// and at the contact, it is the state to the left of the jump. Error: a negative or infinite time.
  GasState at(double x, double time) const;

  /// Pressure and velocity on both sides of the contact.
  double star_pressure() const { return star_pressure_; }
  double star_velocity() const { return star_velocity_; }
  /// Densities on the left and on the right of the contact.
  double left_density() const { return star_density(left_); }
  double right_density() const { return star_density(right_); }
  /// The velocity of the shock that moves to the right. NaN if that wave is a rarefaction.
  double shock_speed() const;

 private:
  struct Jump {
    double value, slope;
  };
  double sound(GasState const& state) const;
  double mass_flux(GasState const& state) const;
  Jump jump(GasState const& state, double pressure) const;
  double star_density(GasState const& state) const;
  GasState left_of_contact(GasState const& state, double contact, double speed) const;

  GasState left_, right_;
  double gamma_, star_pressure_, star_velocity_;
};

/// Sod's shock tube (J. Comput. Phys. 27, 1, 1978): density and pressure are 1 on the left, 1/8 and 1/10 on the right,
/// and both gases are at rest. Error: gamma <= 1.
Riemann sod(double gamma = 1.4);

}  // namespace boltzmann::exact
