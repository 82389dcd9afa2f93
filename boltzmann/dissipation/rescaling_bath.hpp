// RescalingBath: baths that scale the velocities of all their particles by one factor, so that they act on the kinetic
// energy only: stochastic velocity rescaling and Nose-Hoover chains.
#pragma once

#include <boltzmann/dissipation/heat_bath.hpp>

#include <array>

namespace boltzmann {

/// Degrees of freedom are those of particles/degrees_of_freedom.hpp. If all other parts conserve the total momentum
/// along an axis, and all particles with mass are in the bath, the bath conserves it, too: velocities are relative to
/// the common one, and there is one degree of freedom less.
class RescalingBath : public HeatBath {
 public:
  using HeatBath::HeatBath;

  bool keeps_momentum() const override { return takes_all_; }
  bool asks_for_surroundings() const override { return true; }
  /// Error if no degree of freedom is left, or no particle moves at a temperature above zero.
  void settle(Surroundings const& surroundings) override;
  void advance(StepContext const& context) override;
  /// Degrees of freedom of its particles in the current state, inside its block.
  double degrees_of_freedom() const;
  /// Relative to the common velocity along axes with conserved momentum, and to the flow of a sheared box.
  double kinetic_energy() const;

 protected:
  /// The factor of all velocities over this step, for this kinetic energy, number of degrees of freedom and k T.
  virtual double factor(double kinetic, double degrees, double kT, StepContext const& context) = 0;

 private:
  struct Motion {
    double freedom = 0, kinetic = 0;  // freedom: before the conserved momentum is subtracted
    std::array<double, 3> common{};   // the conserved common velocity
  };
  Motion motion() const;
  double degrees(Motion const& motion) const;

  bool takes_all_ = false;
  std::array<bool, 3> kept_{};
};

}  // namespace boltzmann
