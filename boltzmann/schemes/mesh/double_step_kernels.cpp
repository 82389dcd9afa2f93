// The kernels of whole steps in double precision.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/mesh/fused_step.hpp>

namespace boltzmann {

template <>
StepKernelTable<double> const& double_steps<this_set>() {
  return detail::step_table<double, native_width<double>>;
}

}  // namespace boltzmann
