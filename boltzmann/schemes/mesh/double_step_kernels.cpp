// The kernels of whole steps in double precision, for every dimension and order.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/mesh/fused_step.hpp>

namespace boltzmann {
namespace {

constexpr int W = native_width<double>;

template <int D, int p>
constexpr StepKernels<double> kernels{detail::fused_step<detail::StepPass::deposit, D, p, double, W>,
                                      detail::fused_step<detail::StepPass::advance, D, p, double, W>,
                                      detail::fused_step<detail::StepPass::finish, D, p, double, W>};

constexpr StepKernelTable<double> table{{{kernels<1, 1>, kernels<1, 2>, kernels<1, 3>},
                                         {kernels<2, 1>, kernels<2, 2>, kernels<2, 3>},
                                         {kernels<3, 1>, kernels<3, 2>, kernels<3, 3>}}};

}  // namespace

template <>
StepKernelTable<double> const& double_steps<this_set>() {
  return table;
}

}  // namespace boltzmann
