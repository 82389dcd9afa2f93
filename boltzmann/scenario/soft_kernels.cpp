// Kernels of the soft repulsion.
#include <boltzmann/laws/soft.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, BetweenNewton<Soft>, NewtonRows>();

}  // namespace boltzmann
