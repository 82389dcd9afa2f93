// Flow options: the kinds of friction and noise that scenarios name, with their keys.
#pragma once

#include <boltzmann/core/options.hpp>
#include <boltzmann/flows/dissipative_flow.hpp>

#include <string>
#include <vector>

namespace boltzmann {

/// One kind of friction between pairs, and how all of a scenario act together.
struct DissipationOptions {
  Dissipation dissipation;
  FlowMethod method = FlowMethod::order_free;
  bool corrector = false, metropolis = false;
};
OptionTable const& dissipation_options();

/// A heat bath on each particle (see LangevinFlow).
struct BathOptions {
  double temperature = 0, rate = 0;
};
OptionTable const& bath_options();

struct FlowKind {
  std::string name, doc, equation;
  OptionTable const& options;
};
std::vector<FlowKind> const& flow_kinds();

}  // namespace boltzmann
