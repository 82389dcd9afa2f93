// Kernels that advance fields with rates of their own by a stage of a method: plain memory and function pointers.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#include <cstddef>

namespace boltzmann {

inline constexpr std::size_t most_field_numbers = 128;  ///< of a column

/// One number of each of some particles that follow each other, no more than most_field_numbers.
struct FieldColumn {
  double* x = nullptr;  ///< in the first row
  std::size_t row = 0;  ///< doubles from row to row
  double const* rate = nullptr;
  std::size_t rate_step = 1;  ///< doubles from rate to rate
  double* start = nullptr;    ///< at the start of the step, side by side; of leap-frog: the rate there
  double* sum = nullptr;      ///< of the weighted rates so far, side by side; for rk4
  std::size_t count = 0;
};

/// Advances the numbers through a stage of a step of length dt; false if one of them is not finite then.
using FieldKernel = bool (*)(FieldColumn const& column, double dt);

/// By stage.
struct FieldKernelTable {
  FieldKernel euler, leap_frog[2], rk2[2], rk4[4];
};
template <InstructionSet set>
FieldKernelTable const& field_kernels();

}  // namespace boltzmann
