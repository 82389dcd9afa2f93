// Smooth kernels of the cubic spline.
#include <boltzmann/schemes/smooth/kernel_table.hpp>

namespace boltzmann {

template <>
SmoothKernelTable const& smooth_kernels<this_set, CubicSpline>() {
  return detail::SmoothTable<this_set, CubicSpline>::table;
}

}  // namespace boltzmann
