// The kernels of atoms that feel their surroundings: two passes over lists of neighbours, in 1D, 2D and 3D.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// `law` is what the passes know: EmbeddedTables, or StillingerWeber. Sums are stored in the order of rows, forces are
/// added by number.
struct ManyBodyKernels {
  PairKernel sums = nullptr, sums_reversible = nullptr;
  PairKernel forces = nullptr, forces_reversible = nullptr, measure = nullptr;
};

struct ManyBodyKernelTable {
  ManyBodyKernels embedded[3], alloy[3], bonded[3];
};

template <InstructionSet set>
ManyBodyKernelTable const& many_body_kernels();

}  // namespace boltzmann
