// Collapse: whether gas will fall together under its gravity before a run ends.
#pragma once

#include <string>

namespace boltzmann {

class Simulation;

/// A line that begins with "warning: ", if steps of fixed size will be too long for the sound of smooth particles that fall
/// together within this time. Influences must be up to date.
std::string warn_of_collapse(Simulation const& simulation, double duration);

}  // namespace boltzmann
