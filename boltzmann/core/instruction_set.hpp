// The instruction sets that one library supports, and which of them is in use.
#pragma once

#include <string>
#include <vector>

namespace boltzmann {

/// Targets of kernels: levels of the x86-64 psABI, or one machine.
enum class InstructionSet {
  native,     ///< the target of the compiler: the only set if the library was compiled once
  x86_64,     ///< every 64-bit x86: SSE2, 2 doubles at a time
  x86_64_v3,  ///< AVX2 and FMA, 4 at a time
  x86_64_v4,  ///< AVX-512 F, BW, CD, DQ and VL, 8 at a time
};

/// "native", "x86-64", "x86-64-v3", "x86-64-v4".
std::string to_string(InstructionSet set);

/// The sets that this library has kernels for, the best last.
std::vector<InstructionSet> compiled_instruction_sets();

/// The sets that this processor can run; none if the library was compiled for other machines only.
std::vector<InstructionSet> instruction_sets();

/// The set whose kernels run: the best one, or the one in the environment variable BOLTZMANN_INSTRUCTIONS. Chosen at
/// the first call. Error with the allowed words if there is no such set, if this processor can't run it, or if it can
/// run none.
InstructionSet instruction_set();

namespace detail {
/// The same for any word (null or empty: the best), any library and any processor.
InstructionSet choose_instruction_set(char const* word, std::vector<InstructionSet> const& compiled,
                                      std::vector<InstructionSet> const& available);
}  // namespace detail

}  // namespace boltzmann
