// Kernels of the Rydberg law.
#include <boltzmann/laws/rydberg.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, Rydberg, NewtonRows>();

}  // namespace boltzmann
