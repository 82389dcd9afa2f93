// Dissipation options: the kinds of friction and noise in scenarios, with their keys.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// One kind of friction between pairs, and the method for all kinds of a scenario.
struct DissipationOptions {
  DissipationLaw dissipation;
  DissipationMethod method = DissipationMethod::simultaneous;
  bool corrector = false, metropolis = false;
};
OptionTable const& dissipation_options();

/// A heat bath (see HeatBath), on each particle or on the total kinetic energy.
struct BathOptions {
  double temperature = 0, rate = 0;
  std::optional<std::array<double, 3>> low, high;  ///< of the block in which it acts
  int chain = 3;                                   ///< links of a Nose-Hoover chain
};
OptionTable const& bath_options();
/// The options of a bath that acts before the run.
OptionTable const& equilibration_bath_options();

struct DissipationKind {
  std::string name, doc, equation;
  OptionTable const& options;
};
std::vector<DissipationKind> const& dissipation_kinds();

}  // namespace boltzmann
