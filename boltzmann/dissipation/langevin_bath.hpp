// Langevin dissipation: friction and noise from a heat bath on each particle, the way to bring a body to a temperature.
#pragma once

#include <boltzmann/dissipation/dissipation.hpp>

namespace boltzmann {

/// dv = -rate v dt + sqrt(2 rate k T / m) dW, solved exactly over a step (Ornstein-Uhlenbeck): with leap-frog it
/// samples exp(-H / kT) to second order in the step. Momentum is not conserved. Noise depends on the seed, the step and
/// the particle's number alone.
class LangevinBath final : public Dissipation {
 public:
  /// `temperature` (zero or more), `rate` (per time, positive), Boltzmann's constant in the simulation's units. Error
  /// otherwise.
  LangevinBath(double temperature, double rate, double boltzmann_constant);
  /// Lets it act on an ensemble. Error if its class has no mass and velocity.
  void on(AnyEnsemble& ensemble);

  std::vector<AnyEnsemble*> ensembles() const override { return ensembles_; }
  void check() override;
  void advance(StepContext const& context) override;
  double heat() const override { return heat_; }
  std::vector<std::string> warnings(double step_size) override;
  std::vector<double> state() const override { return {heat_}; }
  void restore(std::span<double const> state) override;

 private:
  double temperature_, rate_, boltzmann_constant_;
  double heat_ = 0;
  std::vector<AnyEnsemble*> ensembles_;
};

}  // namespace boltzmann
