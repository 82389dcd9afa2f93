// Planned run: what diagnoses should say of a run before it begins. Private to this room, and for `bzm check`.
#pragma once

#include <boltzmann/recording/recording.hpp>

#include <cstdint>
#include <string>
#include <vector>

namespace boltzmann {

/// Lines that begin with "warning: ": diagnoses that get nothing, or too little, in a run of so many steps from here,
/// and gas whose collapse will need shorter steps.
std::vector<std::string> planned_warnings(Recording const& recording, std::int64_t steps);

}  // namespace boltzmann
