// The kernels of whole steps in single precision, for every dimension and order.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/mesh/fused_step.hpp>

namespace boltzmann {
namespace {

constexpr int W = native_width<float>;

template <int D, int p>
constexpr StepKernels<float> kernels{detail::fused_step<detail::StepPass::deposit, D, p, float, W>,
                                     detail::fused_step<detail::StepPass::advance, D, p, float, W>,
                                     detail::fused_step<detail::StepPass::finish, D, p, float, W>};

constexpr StepKernelTable<float> table{{{kernels<1, 1>, kernels<1, 2>, kernels<1, 3>},
                                        {kernels<2, 1>, kernels<2, 2>, kernels<2, 3>},
                                        {kernels<3, 1>, kernels<3, 2>, kernels<3, 3>}}};

}  // namespace

template <>
StepKernelTable<float> const& single_steps<this_set>() {
  return table;
}

}  // namespace boltzmann
