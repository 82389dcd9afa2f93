// Images in a cylinder, W targets at a time.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/cylinder/image_kernel.hpp>
#include <boltzmann/schemes/pair/over_all.hpp>

namespace boltzmann {

template <>
PairKernel image_kernel<this_set>() {
  return detail::over_all<detail::Pass::influence, native_width<double>, Tracer<2>, Vortex<2>, ImageLaw>;
}

}  // namespace boltzmann
