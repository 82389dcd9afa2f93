// NoseHooverChain: the deterministic bath of Nose and Hoover with a chain (G. J. Martyna, M. L. Klein and M. Tuckerman,
// J. Chem. Phys. 97, 2635 (1992)), by the splitting of G. J. Martyna, M. E. Tuckerman, D. J. Tobias and M. L. Klein,
// Mol. Phys. 87, 1117 (1996).
#pragma once

#include <boltzmann/dissipation/rescaling_bath.hpp>

#include <vector>

namespace boltzmann {

/// dv = -u1 v dt, Q1 du1/dt = 2 K - f k T - Q1 u1 u2, Qj duj/dt = Q(j-1) u(j-1)^2 - k T - Qj uj u(j+1), with
/// Q1 = f k T / rate^2 and Qj = k T / rate^2. Energy + bath_energy() is conserved at a constant temperature; heat() is
/// what the bath has given. Over a step it is split by the sixth-order weights of Suzuki and Yoshida. A system that is
/// not ergodic by itself (few harmonic particles) may need a longer chain, or a stochastic bath.
class NoseHooverChain final : public RescalingBath {
 public:
  /// `length`: of the chain, 1 or more. Error otherwise, or if the temperature is not above 0.
  NoseHooverChain(double temperature, double rate, double boltzmann_constant, int length = 3);

  /// Refused: it needs the same particles all the time. Error.
  void within(Block const& block) override;
  void settle(Surroundings const& surroundings) override;
  /// The sum of Qj uj^2 / 2, f k T times the integral of u1 and k T times those of the others.
  double bath_energy() const;
  std::vector<double> state() const override;
  void restore(std::span<double const> state) override;
  std::string kind() const override { return "nose-hoover"; }

 protected:
  double factor(double kinetic, double degrees, double kT, StepContext const& context) override;

 private:
  std::vector<double> rates_, integrals_;  // u, and their integrals over time
  double degrees_ = 0, kT_ = 0;
};

}  // namespace boltzmann
