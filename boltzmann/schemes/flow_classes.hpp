// The shipped classes that make flows and those carried by flows; error messages suggest them.
// (tests/scenario/flow_scenario_test.cpp compares the lists with the classes.)
#pragma once

#include <string_view>

namespace boltzmann {

constexpr std::string_view classes_with_vorticity = "Vortex, Inviscid, Viscous, Diffusive and Spreading";
constexpr std::string_view classes_carried_by_flows = "Tracer, Dye, Vortex, Inviscid, Viscous, Diffusive and Spreading";

}  // namespace boltzmann
