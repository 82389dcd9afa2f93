// Langevin dissipation: friction and noise of a heat bath on each particle, to bring a body to a temperature.
#pragma once

#include <boltzmann/dissipation/heat_bath.hpp>

namespace boltzmann {

/// dv = -rate v dt + sqrt(2 rate k T / m) dW, solved exactly over a step (Ornstein-Uhlenbeck): with leap-frog it
/// samples exp(-H / kT) to second order in the step. Momentum is not conserved. Noise depends only on the seed, the
/// step and the particle's number.
class LangevinBath final : public HeatBath {
 public:
  using HeatBath::HeatBath;

  void advance(StepContext const& context) override;
  std::vector<std::string> warnings(double step_size) override;
  std::string kind() const override { return "langevin"; }
};

}  // namespace boltzmann
