// Selects the kernels of the neighbour search by instruction set.
#include <boltzmann/core/kernel_dispatch.hpp>
#include <boltzmann/neighbours/neighbour_kernels.hpp>

namespace boltzmann {

NeighbourKernels const& neighbour_kernels() {
  return for_instruction_set([](auto set) -> NeighbourKernels const& { return neighbour_kernels_of<set>(); });
}

}  // namespace boltzmann
