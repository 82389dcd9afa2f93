// The kernels of the neighbour search, by instruction set. Private to the library's sources.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/neighbours/near_task.hpp>

namespace boltzmann {

template <InstructionSet>
NeighbourKernels const& neighbour_kernels_of();

/// The kernels of the set in use.
NeighbourKernels const& neighbour_kernels();

}  // namespace boltzmann
