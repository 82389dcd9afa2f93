// Kernels of the Morse law.
#include <boltzmann/laws/morse.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, Morse, NewtonRows>();

}  // namespace boltzmann
