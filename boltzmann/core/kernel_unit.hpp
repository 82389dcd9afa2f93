// Kernel units: sources named *_kernels.cpp, which the build compiles once for every instruction set. Private to the
// library's sources.
//
// In such a unit BOLTZMANN_INSTRUCTION_SET is the set's name (x86_64_v4), for use as a namespace or, as `this_set`, in
// a template argument. All exported names carry it. A unit holds only kernels and constant tables of pointers to them.
// A std::vector<double> in it would emit functions that the linker may pick for all other units, and the program would
// crash on an older processor. So every emitted symbol must carry the set or the width W of its packs in its name;
// tests/core/instruction_set_test.cpp checks the object files.
// An ordinary unit declares `template <InstructionSet> Table const& table();`, the kernel unit defines `template <>
// Table const& table<this_set>()`, and for_instruction_set() (kernel_dispatch.hpp) uses the table of the set in use.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#if !defined(BOLTZMANN_INSTRUCTION_SET)
#define BOLTZMANN_INSTRUCTION_SET native
#endif

namespace boltzmann {

/// The set that a kernel unit is being compiled for.
constexpr InstructionSet this_set = InstructionSet::BOLTZMANN_INSTRUCTION_SET;

}  // namespace boltzmann
