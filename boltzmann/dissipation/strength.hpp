// Strength: the friction and noise between two particles, for one pair or for a pack of pairs.
#pragma once

#include <boltzmann/dissipation/dissipation_kernels.hpp>

namespace boltzmann {

/// Friction gamma_ij dt and noise sigma_ij sqrt(dt), without chi. If friction depends on the pair's temperature,
/// `by_change` is the factor of its relative change (TypedFriction::At::change), times gamma_0 dt: Eq 4 of the source,
/// corrected (see Convention). Ti, Tj are internal temperatures and Ci, Cj heat capacities. Arguments: 1/Ti + 1/Tj;
/// their product 1/(Ti Tj); the `curvatures` 1/(Ti^2 Ci) + 1/(Tj^2 Cj), used only by constant_friction; 1/mi + 1/mj;
/// the square of the relative velocity in this number of directions. The deterministic convention alone uses the last
/// two.
template <class Real>
struct Strength {
  Real friction = 0.0, noise = 0.0, by_change = 0.0;

  [[gnu::always_inline]] Strength(PairNoise const& n, Real inverse_temperatures, Real product, Real curvatures,
                                  Real inverse_masses, Real square, double directions) {
    switch (n.convention) {
      case Convention::fixed_temperature:
        friction = n.friction;
        noise = n.amplitude;
        break;
      case Convention::constant_friction: {
        Real const root = rsqrt(0.5 * inverse_temperatures), inverse = root * root;  // of k beta
        by_change = n.friction * (0.25 * n.boltzmann_constant * curvatures * (inverse * inverse));
        friction = n.friction * (1.0 + 0.25 * n.boltzmann_constant * curvatures * (inverse * inverse));
        noise = n.amplitude * root;
        break;
      }
      case Convention::constant_noise:
        friction = (0.5 * n.friction * n.temperature) * inverse_temperatures;
        noise = n.amplitude;
        break;
      case Convention::deterministic: {
        // The pair's kinetic temperature, weighted so that the exchange is in balance for Maxwell's velocities.
        Real const outside = square / (inverse_masses * (n.boltzmann_constant * (directions + 2)));
        Real const inside = 0.5 * inverse_temperatures / product;
        friction = (n.friction / n.temperature) * (outside - inside);
        noise = 0.0;
        break;
      }
    }
  }
};

}  // namespace boltzmann
