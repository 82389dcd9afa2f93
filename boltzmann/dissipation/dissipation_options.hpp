// Dissipation options: the kinds of friction and noise that scenarios name, with their keys.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// One kind of friction between pairs, and how all of a scenario act together.
struct DissipationOptions {
  DissipationLaw dissipation;
  DissipationMethod method = DissipationMethod::simultaneous;
  bool corrector = false, metropolis = false;
};
OptionTable const& dissipation_options();

/// A heat bath on each particle (see LangevinBath).
struct BathOptions {
  double temperature = 0, rate = 0;
};
OptionTable const& bath_options();

struct DissipationKind {
  std::string name, doc, equation;
  OptionTable const& options;
};
std::vector<DissipationKind> const& dissipation_kinds();

}  // namespace boltzmann
