// Kernels of the Lennard-Jones law.
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, LennardJones, NewtonRows>();

}  // namespace boltzmann
