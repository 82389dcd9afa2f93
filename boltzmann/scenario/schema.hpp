// Schema: the allowed contents of a scenario, for completion and validation in editors.
#pragma once

#include <string>

namespace boltzmann {

/// A JSON Schema (draft 7) of scenario files, generated from the tables of options. It contains every key with its word
/// list and its documentation. `bzm check` checks units, rules across keys and fields of classes.
std::string scenario_schema();

}  // namespace boltzmann
