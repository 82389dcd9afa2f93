// Kernels that advance fields with rates of their own by one stage of a method: plain memory and function pointers.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#include <cstddef>

namespace boltzmann {

/// One number of each of some consecutive particles.
struct FieldColumn {
  double* x;  ///< in the first row
  double const* rate;
  std::size_t rate_step;  ///< doubles from rate to rate
  double* start;          ///< at the start of the step, contiguous; for leap-frog: the rate there
  double* sum;            ///< weighted sum of rates so far, contiguous; for rk4
};
struct FieldBlock {
  FieldColumn const* columns;
  std::size_t numbers;  ///< of a particle: columns
  std::size_t row;      ///< doubles from row to row
  std::size_t particles;
};

/// Advances all of them through a stage of a step of length dt; false if a number is not finite afterwards.
using FieldKernel = bool (*)(FieldBlock const& block, double dt);

/// By stage.
struct FieldKernelTable {
  FieldKernel euler, leap_frog[2], rk2[2], rk4[4];
};
template <InstructionSet set>
FieldKernelTable const& field_kernels();

}  // namespace boltzmann
