// Smooth kernels of the quintic spline.
#include <boltzmann/schemes/smooth/kernel_table.hpp>

namespace boltzmann {

template <>
SmoothKernelTable const& smooth_kernels<this_set, QuinticSpline>() {
  return detail::SmoothTable<this_set, QuinticSpline>::table;
}

}  // namespace boltzmann
