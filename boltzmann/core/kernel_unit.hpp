// Kernel units: sources named *_kernels.cpp, which the build compiles once for every instruction set. Private to the
// library's sources.
//
// In such a unit BOLTZMANN_INSTRUCTION_SET is the set's name (x86_64_v4), to be used as a namespace or, as `this_set`,
// in a template argument: whatever the unit exports carries it in its name. A unit holds kernels and constant tables of
// pointers to them, nothing else: a std::vector<double> in it would leave functions that the linker takes for those
// of all other units, and the program would die on an older processor. So all that is emitted must carry the set or the
// width W of its packs in its name; tests/core/instruction_set_test.cpp looks at the objects and says what does not.
// An ordinary unit declares `template <InstructionSet> Table const& table();`, the kernel unit defines `template <>
// Table const& table<this_set>()`, and for_instruction_set() (kernel_dispatch.hpp) takes the table of the set that is
// in use.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#if !defined(BOLTZMANN_INSTRUCTION_SET)
#define BOLTZMANN_INSTRUCTION_SET native
#endif

namespace boltzmann {

/// The set that a kernel unit is being compiled for.
constexpr InstructionSet this_set = InstructionSet::BOLTZMANN_INSTRUCTION_SET;

}  // namespace boltzmann
