// The kernels of laws given as formulas, for one instruction set.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/pair/over_columns.hpp>

namespace boltzmann {
namespace detail {

template <InstructionSet set>
struct FormulaTable {
  static constexpr int W = native_width<double>;
  static constexpr int code_width = detail::rounds_as_machine_code<W> ? W : 0;
  static constexpr FormulaKernelTable table{
      {formula_pair_kernels<W, 1>(), formula_pair_kernels<W, 2>(), formula_pair_kernels<W, 3>()},
      {formula_external_kernels<W, 1>(), formula_external_kernels<W, 2>(), formula_external_kernels<W, 3>()},
      code_width};
};

}  // namespace detail

template <>
FormulaKernelTable const& formula_kernels<this_set>() {
  return detail::FormulaTable<this_set>::table;
}

}  // namespace boltzmann
