// The version of the program, as in files and `bzm --version`. It must be the same as in CMakeLists.txt.
#pragma once

namespace boltzmann {

inline constexpr char const* program_version = "0.1.0";

}  // namespace boltzmann
