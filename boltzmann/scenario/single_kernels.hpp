// The laws of scenarios that can be summed in single precision. Private to this module.
#pragma once

#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/scenario/law_rows.hpp>

#include <array>

namespace boltzmann {

/// For all pairs, for the rows of the law in their order (VortexRows).
struct SingleKernels {
  std::array<PairKernel, pair_layouts<VortexRows>> plain, algebraic;
};

/// Defined by kernel units, once per instruction set.
template <InstructionSet set>
SingleKernels const& single_kernels();

}  // namespace boltzmann
