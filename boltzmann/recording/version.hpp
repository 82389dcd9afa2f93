// The version of the program, as files and `bzm --version` say it; the same as in CMakeLists.txt.
#pragma once

namespace boltzmann {

inline constexpr char const* program_version = "0.1.0";

}  // namespace boltzmann
