// VelocityRescaling: stochastic velocity rescaling (G. Bussi, D. Donadio and M. Parrinello, J. Chem. Phys. 126, 014101
// (2007)): a bath on the kinetic energy that samples the canonical ensemble and hardly disturbs the motion.
#pragma once

#include <boltzmann/dissipation/rescaling_bath.hpp>

namespace boltzmann {

/// dK = rate (K0 - K) dt + 2 sqrt(K K0 rate / f) dW with K0 = f k T / 2, solved exactly over a step (their Eq. A7): K
/// has the Gamma distribution of shape f / 2 for any step. f is degrees_of_freedom(). Noise depends only on the seed
/// and the step. At temperature 0 kinetic energy decays by exp(-rate t).
class VelocityRescaling final : public RescalingBath {
 public:
  using RescalingBath::RescalingBath;
  std::string kind() const override { return "velocity-rescaling"; }

 protected:
  double factor(double kinetic, double degrees, double kT, StepContext const& context) override;
};

}  // namespace boltzmann
