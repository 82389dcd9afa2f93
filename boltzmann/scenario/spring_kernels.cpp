// Kernels of springs.
#include <boltzmann/laws/spring.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, Spring, NewtonRows>();

}  // namespace boltzmann
