// The kernels of atoms that feel their surroundings: two passes over lists of neighbours, in 1D, 2D and 3D.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// The first pass writes which entries of a row are within the cut-off, in their order, and pads them; there is room for
/// the row and its padding.
struct AtomTask : PairTask {
  std::uint32_t* const* near = nullptr;
  std::uint32_t* near_length = nullptr;
  std::uint32_t sentinel = 0;
};

using AtomKernel = void (*)(void const* law, AtomTask const& task, std::size_t begin, std::size_t end);

/// `law` is what the passes know: EmbeddedTables, or StillingerWeber. Sums are stored in the order of rows, forces are
/// added by number.
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
