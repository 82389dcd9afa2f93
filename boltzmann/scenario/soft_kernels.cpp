// Kernels of the soft repulsion.
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, Soft, NewtonRows>();

}  // namespace boltzmann
