// NoseHooverChain: the deterministic Nose-Hoover bath with a chain (G. J. Martyna, M. L. Klein and M. Tuckerman, J.
// Chem. Phys. 97, 2635 (1992)), by the splitting of G. J. Martyna, M. E. Tuckerman, D. J. Tobias and M. L. Klein, Mol.
// Phys. 87, 1117 (1996).
#pragma once

#include <boltzmann/dissipation/rescaling_bath.hpp>
#include <boltzmann/dissipation/thermostat_chain.hpp>

#include <vector>

namespace boltzmann {

/// A ThermostatChain on the total kinetic energy. Energy + bath_energy() is conserved at a constant temperature; heat()
/// is the energy that the bath has given. A system that is not ergodic by itself (few harmonic particles) may need a
/// longer chain, or a stochastic bath.
class NoseHooverChain final : public RescalingBath {
 public:
  /// `length`: of the chain, 1 or more. Error otherwise, or if the temperature is not above 0.
  NoseHooverChain(double temperature, double rate, double boltzmann_constant, int length = 3);

  /// Error: it needs the same particles all the time.
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
  ThermostatChain chain_;
  double degrees_ = 0, kT_ = 0;
};

}  // namespace boltzmann
