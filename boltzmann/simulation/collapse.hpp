// Collapse: predicts whether a gas will collapse under its gravity before a run ends.
#pragma once

#include <string>

namespace boltzmann {

class Simulation;

/// A line that begins with "warning: " if fixed steps will be too long for the sound of smooth particles that collapse
/// within this time. Influences must be up to date.
std::string warn_of_collapse(Simulation const& simulation, double duration);

}  // namespace boltzmann
