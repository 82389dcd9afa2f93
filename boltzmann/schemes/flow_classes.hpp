// Which of the shipped classes make flows and are carried by them: what messages say to whoever took another.
// (tests/scenario/flow_scenario_test.cpp compares the lists with the classes.)
#pragma once

#include <string_view>

namespace boltzmann {

constexpr std::string_view classes_with_vorticity = "Vortex, Inviscid, Viscous, Diffusive and Spreading";
constexpr std::string_view classes_carried_by_flows = "Tracer, Dye, Vortex, Inviscid, Viscous, Diffusive and Spreading";

}  // namespace boltzmann
