// The sums of flow_laws.hpp over all vortices, compiled for every instruction set. Private to this module and
// multipoles.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// Rows are those of Vortex<D>. Indexed by VortexCore.
struct FlowKernels {
  PairKernel slopes[3];  ///< SlopedFlow at each target
  PairKernel sums[3];    ///< FlowSums
};

/// By [dimension - 2].
struct FlowKernelTable {
  FlowKernels of[2];
};
template <InstructionSet set>
FlowKernelTable const& flow_kernels();

}  // namespace boltzmann
