// The kernels of whole steps in single precision.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/mesh/fused_step.hpp>

namespace boltzmann {

template <>
StepKernelTable<float> const& single_steps<this_set>() {
  return detail::step_table<float, native_width<float>>;
}

}  // namespace boltzmann
