// Schema: the allowed contents of a scenario, for completion and validation in editors.
#pragma once

#include <string>

namespace boltzmann {

/// A JSON Schema (draft 7) of scenario files, made from the tables of options. It knows every key, its word list and
/// its documentation; units, rules across keys and fields of classes are left to `bzm check`.
std::string scenario_schema();

}  // namespace boltzmann
