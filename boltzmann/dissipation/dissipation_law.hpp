// Dissipation law: the parameters of one kind of friction and noise between two particles.
#pragma once

#include <boltzmann/core/words.hpp>

#include <memory>
#include <string>

namespace boltzmann {

/// The fluctuation-dissipation relation of friction gamma and noise sigma. With beta = (1/Ti + 1/Tj) / 2k:
enum class Convention {
  fixed_temperature,  ///< DPD: sigma^2 = 2 gamma k T with the T of a heat bath; energy is not conserved
  constant_noise,     ///< DPDE, convention A: sigma^2 = 2 gamma k T_ref for all pairs, their friction sigma^2 beta / 2
  constant_friction,  ///< DPDE, convention B': sigma^2 = 2 gamma / beta, and the friction
                      ///< gamma [1 + (1/(Ti^2 Ci) + 1/(Tj^2 Cj)) / (4 k beta^2)] which balances the change of noise
                      ///< with energy
  deterministic,      ///< no noise: friction gamma (T_ext - T_int) / T_ref, of either sign (section 4 of the source)
};

class TypedFriction;

Words<Convention> const& convention_words();
std::string to_string(Convention convention);
/// The reason why friction can't depend on the temperature of the pair with a convention other than constant_friction.
std::string why_no_temperature(Convention convention);

/// Friction, noise and heat conduction between two particles at distance r, with chi = (1 - r / range)^exponent up to
/// the range (Eq 1 to 4 of the DPDE source, corrected):
///   dp_i = -gamma_ij chi^2 v_ij dt + sigma_ij chi dW_ij,  p_j the opposite,
/// v_ij and dW_ij along the line of centres if it is projected, else full vectors; each internal energy gains half of
/// the energy that the motion loses. Conduction: d eps_i = kappa chi^2 (1/Ti - 1/Tj) dt + sqrt(2 k kappa) chi dW, eps_j
/// the opposite.
struct DissipationLaw {
  Convention convention = Convention::constant_friction;
  double friction = 0;     ///< gamma, mass per time
  double temperature = 0;  ///< of the heat bath, or T_ref if the convention has one; otherwise not used
  double range = 0;
  double exponent = 1;    ///< of chi, zero or more: friction decreases with twice this exponent
  bool projected = true;  ///< along the line of centres: angular momentum is conserved as well
  double conduction = 0;  ///< kappa, energy times temperature per time; 0: no heat conduction
  /// Formulas for chi and, optionally, for the friction; null: none. with_formulas() makes such a law.
  std::shared_ptr<TypedFriction const> typed = {};

  /// Error with one line if a parameter is invalid, or one is set that the convention does not use.
  void check() const;
};

}  // namespace boltzmann
