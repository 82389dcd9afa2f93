// Connects ordinary units with the kernels of the instruction set in use. Private to the library's sources. Kernel
// units don't include it, so that another choice of sets recompiles none of them.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#include <kernel_sets.hpp>
#include <type_traits>

namespace boltzmann {

namespace detail {
template <InstructionSet first, InstructionSet... others, class Function>
decltype(auto) for_set(InstructionSet set, Function const& function) {
  if constexpr (sizeof...(others) > 0) {
    if (set != first) return for_set<others...>(set, function);
  }
  return function(std::integral_constant<InstructionSet, first>{});
}
}  // namespace detail

/// Calls function(std::integral_constant<InstructionSet, set>) for the set in use (instruction_set(); Error as there).
template <class Function>
decltype(auto) for_instruction_set(Function const& function) {
  return detail::for_set<BOLTZMANN_KERNEL_SETS>(instruction_set(), function);
}

}  // namespace boltzmann
