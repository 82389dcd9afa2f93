// Kernels of the laws of pendulums.
#include <boltzmann/laws/pendulum.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, PendulumCoupling, PendulumRows>();
template LawKernels law_kernels<this_set, PendulumGravity, OnPendulum>();

}  // namespace boltzmann
