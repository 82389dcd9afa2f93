// Splitting numbers so that they can be added without rounding: plain memory and a function pointer.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#include <cstddef>

namespace boltzmann {

inline constexpr std::size_t split_most = 1024, split_unit = 16;

/// At most split_most numbers, a multiple of split_unit.
struct SplitTask {
  double const* numbers = nullptr;
  double* rest = nullptr;  ///< what the two sums lack, number by number; may be the array of the numbers
  std::size_t count = 0;
  double sums[2] = {};      ///< exact sums of two parts of each number
  double largest_rest = 0;  ///< in magnitude: 0 if the two sums are complete. NaN if nothing was done: a number is not
                            ///< finite, or beyond 2^1000
};

using SplitKernel = void (*)(SplitTask& task);

template <InstructionSet set>
SplitKernel split_kernel();

}  // namespace boltzmann
