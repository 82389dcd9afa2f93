// Kernels of Green's function of the Laplacian: charges and masses.
#include <boltzmann/laws/laplace.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, LaplaceLaw, CoulombRows>();
template LawKernels law_kernels<this_set, LaplaceLaw, KeplerRows>();

}  // namespace boltzmann
