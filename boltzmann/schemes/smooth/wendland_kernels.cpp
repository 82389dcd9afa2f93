// Smooth kernels of Wendland's weight.
#include <boltzmann/schemes/smooth/kernel_table.hpp>

namespace boltzmann {

template <>
SmoothKernelTable const& smooth_kernels<this_set, Wendland>() {
  return detail::SmoothTable<this_set, Wendland>::table;
}

}  // namespace boltzmann
