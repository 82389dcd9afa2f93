// Kernels of what comes from outside: drag, tether, uniform fields (electric, magnetic), a uniform stream.
#include <boltzmann/laws/drag.hpp>
#include <boltzmann/laws/magnetic.hpp>
#include <boltzmann/laws/tether.hpp>
#include <boltzmann/laws/uniform.hpp>
#include <boltzmann/scenario/law_kernels.hpp>

namespace boltzmann {

template LawKernels law_kernels<this_set, Drag, OnNewton>();
template LawKernels law_kernels<this_set, Tether, OnTethered>();
template LawKernels law_kernels<this_set, UniformGravity<1>, OnNewtonIn<1>>();
template LawKernels law_kernels<this_set, UniformGravity<2>, OnNewtonIn<2>>();
template LawKernels law_kernels<this_set, UniformGravity<3>, OnNewtonIn<3>>();
template LawKernels law_kernels<this_set, UniformElectricField<1>, OnCoulombIn<1>>();
template LawKernels law_kernels<this_set, UniformElectricField<2>, OnCoulombIn<2>>();
template LawKernels law_kernels<this_set, UniformElectricField<3>, OnCoulombIn<3>>();
template LawKernels law_kernels<this_set, UniformMagneticField<2>, OnCoulombIn<2>>();
template LawKernels law_kernels<this_set, UniformMagneticField<3>, OnCoulombIn<3>>();
template LawKernels law_kernels<this_set, UniformFlow<1>, OnFlowIn<1>>();
template LawKernels law_kernels<this_set, UniformFlow<2>, OnFlowIn<2>>();
template LawKernels law_kernels<this_set, UniformFlow<3>, OnFlowIn<3>>();

}  // namespace boltzmann
