// Kernels of embedded atoms and of atoms with bonds.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/many_body/bonded_passes.hpp>
#include <boltzmann/schemes/many_body/embedded_passes.hpp>
#include <boltzmann/schemes/many_body/many_body_kernels.hpp>
#include <boltzmann/schemes/many_body/over_near.hpp>

namespace boltzmann {
namespace detail {

template <int W, class P, class SumLaw, class ForceLaw>
constexpr ManyBodyKernels atom_passes() {
  ManyBodyKernels kernels;
  kernels.sums = over_near<Pass::influence, true, W, P, SumLaw>;
  kernels.sums_reversible = over_near<Pass::reversible, true, W, P, SumLaw>;
  kernels.forces = over_near<Pass::influence, false, W, P, ForceLaw>;
  kernels.forces_reversible = over_near<Pass::reversible, false, W, P, ForceLaw>;
  kernels.measure = over_near<Pass::measure, false, W, P, ForceLaw>;
  return kernels;
}

template <int W, int D>
constexpr ManyBodyKernels embedded_passes =
    atom_passes<W, EmbeddedPoint<D>, DensityOfAtoms<false>, ForceOnAtoms<false>>();
template <int W, int D>
constexpr ManyBodyKernels alloy_passes = atom_passes<W, AlloyPoint<D>, DensityOfAtoms<true>, ForceOnAtoms<true>>();
template <int W, int D>
constexpr ManyBodyKernels bonded_passes = atom_passes<W, BondedPoint<D>, SumsOfBonds, ForceOnBonds>();

template <InstructionSet set>
struct ManyBodyTable {
  static constexpr int W = native_width<double>;
  static constexpr ManyBodyKernelTable table{{embedded_passes<W, 1>, embedded_passes<W, 2>, embedded_passes<W, 3>},
                                             {alloy_passes<W, 1>, alloy_passes<W, 2>, alloy_passes<W, 3>},
                                             {bonded_passes<W, 1>, bonded_passes<W, 2>, bonded_passes<W, 3>}};
};

}  // namespace detail

template <>
ManyBodyKernelTable const& many_body_kernels<this_set>() {
  return detail::ManyBodyTable<this_set>::table;
}

}  // namespace boltzmann
