// Kernels of embedded atoms and of atoms with bonds.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/many_body/bonded_passes.hpp>
#include <boltzmann/schemes/many_body/embedded_passes.hpp>
#include <boltzmann/schemes/many_body/many_body_kernels.hpp>
#include <boltzmann/schemes/pair/over_list.hpp>

namespace boltzmann {
namespace detail {

/// A pass over lists, by what its law knows.
template <Pass pass, int W, class P, class Law>
[[gnu::flatten]] void atom_pass(void const* known, PairTask const& task, std::size_t begin, std::size_t end) {
  using Known = std::remove_cvref_t<decltype(Law::known)>;
  Law const law{*static_cast<Known const*>(known)};
  over_list<pass, W, P, P, Law>(&law, task, begin, end);
}

template <int W, class P, class SumLaw, class ForceLaw>
constexpr ManyBodyKernels atom_passes() {
  ManyBodyKernels kernels;
  kernels.sums = atom_pass<Pass::influence, W, P, SumLaw>;
  kernels.sums_reversible = atom_pass<Pass::reversible, W, P, SumLaw>;
  kernels.forces = atom_pass<Pass::influence, W, P, ForceLaw>;
  kernels.forces_reversible = atom_pass<Pass::reversible, W, P, ForceLaw>;
  kernels.measure = atom_pass<Pass::measure, W, P, ForceLaw>;
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
