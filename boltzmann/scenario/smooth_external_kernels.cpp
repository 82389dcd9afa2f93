// Kernels of what comes from outside to smooth particles: drag, gravity.
#include <boltzmann/laws/drag.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/scenario/law_kernels.hpp>
#include <boltzmann/schemes/smooth/force_on.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, ForceOn<Drag>, OnSmooth>();
template LawKernels law_kernels<this_set, ForceOn<UniformGravity<1>>, OnSmoothIn<1>>();
template LawKernels law_kernels<this_set, ForceOn<UniformGravity<2>>, OnSmoothIn<2>>();
template LawKernels law_kernels<this_set, ForceOn<UniformGravity<3>>, OnSmoothIn<3>>();

}  // namespace boltzmann
