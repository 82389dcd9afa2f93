// Planned run: warnings of diagnoses before a run starts. Private to this module, and used by `bzm check`.
#pragma once

#include <boltzmann/recording/recording.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace boltzmann {

/// Lines that begin with "warning: ", for a run of this many steps from the current one: diagnoses that get no samples
/// or too few, and gas whose collapse will need shorter time steps.
std::vector<std::string> planned_warnings(Recording const& recording, std::int64_t steps);

}  // namespace boltzmann
