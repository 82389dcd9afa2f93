// Smooth kernels of Lucy's weight.
#include <boltzmann/schemes/smooth/kernel_table.hpp>

namespace boltzmann {

template <>
SmoothKernelTable const& smooth_kernels<this_set, Lucy>() {
  return detail::SmoothTable<this_set, Lucy>::table;
}

}  // namespace boltzmann
