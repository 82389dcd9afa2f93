// The kernels of viscosity and conduction over neighbour lists, in one dimension.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// `law` is a PassParameters. Sums are stored in the order of rows.
struct TransportPasses {
  PairKernel motion = nullptr;  ///< MotionSum
  PairKernel rates = nullptr;   ///< TransportSum
  PairKernel stress = nullptr;  ///< StressSum
};
struct TransportKernels {
  TransportPasses same;      ///< all particles have one range
  TransportPasses variable;  ///< each has its own
};
/// In 1D, 2D, 3D.
struct TransportKernelTable {
  TransportKernels in[3];
};

template <InstructionSet set>
TransportKernelTable const& transport_kernels();

/// The table for the selected instruction set.
TransportKernelTable const& transport_kernels();

}  // namespace boltzmann
