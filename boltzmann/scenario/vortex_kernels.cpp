// Kernels of vortices.
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, BiotSavart, VortexRows>();

}  // namespace boltzmann
