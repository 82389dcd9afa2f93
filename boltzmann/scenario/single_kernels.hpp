// The laws of scenarios that can be summed in single precision. Private to this room.
#pragma once

#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/scenario/law_rows.hpp>

#include <array>

namespace boltzmann {

/// Of all pairs, for the rows of the law in their order (VortexRows).
struct SingleKernels {
  std::array<PairKernel, pair_layouts<VortexRows>> plain, algebraic;
};

/// Kernel units define it, once for each instruction set.
template <InstructionSet set>
SingleKernels const& single_kernels();

}  // namespace boltzmann
