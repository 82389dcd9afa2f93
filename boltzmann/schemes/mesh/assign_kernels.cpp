// The kernels of assignment and interpolation, for every dimension and order.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/core/pack.hpp>
#include <boltzmann/schemes/mesh/assign.hpp>

namespace boltzmann {
namespace {

constexpr int W = native_width<double>;

template <int D, int p>
constexpr AssignKernels kernels{detail::assign<D, p, W>, detail::interpolate<D, p, W>};

constexpr AssignKernelTable table{
    {{kernels<1, 1>, kernels<1, 2>, kernels<1, 3>, kernels<1, 4>, kernels<1, 5>, kernels<1, 6>, kernels<1, 7>},
     {kernels<2, 1>, kernels<2, 2>, kernels<2, 3>, kernels<2, 4>, kernels<2, 5>, kernels<2, 6>, kernels<2, 7>},
     {kernels<3, 1>, kernels<3, 2>, kernels<3, 3>, kernels<3, 4>, kernels<3, 5>, kernels<3, 6>, kernels<3, 7>}}};

}  // namespace

template <>
AssignKernelTable const& assign_kernels<this_set>() {
  return table;
}

}  // namespace boltzmann
