// The kernels of atoms with many-body forces: two passes over neighbour lists, in 1D, 2D and 3D.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// The first pass stores the entries of a row that are within the cut-off, in order, with padding. The caller allocates
/// room for the row and its padding.
struct AtomTask : PairTask {
  std::uint32_t* const* near = nullptr;
  std::uint32_t* near_length = nullptr;
  std::uint32_t sentinel = 0;
};

using AtomKernel = void (*)(void const* law, AtomTask const& task, std::size_t begin, std::size_t end);

/// `law` points to the parameters of the passes: EmbeddedTables or StillingerWeber. Sums are stored in the order of
/// rows, forces by particle number.
struct ManyBodyKernels {
  AtomKernel sums = nullptr, sums_reversible = nullptr;
  AtomKernel forces = nullptr, forces_reversible = nullptr, measure = nullptr;
};

struct ManyBodyKernelTable {
  ManyBodyKernels embedded[3], alloy[3], bonded[3];
};

template <InstructionSet set>
ManyBodyKernelTable const& many_body_kernels();

}  // namespace boltzmann
