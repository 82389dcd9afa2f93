// The kernels of angular laws given as formulas, for one instruction set.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/laws/angular_program.hpp>
#include <boltzmann/schemes/molecules/over_tuples.hpp>
#include <boltzmann/schemes/molecules/tuple_formula_kernels.hpp>

namespace boltzmann {
namespace detail {

/// Runs the program on a column of angles.
template <int W>
class AngularBlock<W, AngularProgram> {
 public:
  using Real = Pack<double, W>;
  static_assert(block_tuples <= block_pairs);

  explicit AngularBlock(AngularProgram const& law) : law_(law) {}
  void angle(std::size_t k, Real value) { store_pack<W>(work_.column(0) + k * W, value); }
  template <bool measure>
  void run(std::size_t packs) {
    program_ = measure ? &law_.measure : &law_.influence;
    if (!constants_) work_.set_constants(*program_), run_row<W>(work_, *program_);
    constants_ = true;
    run_program<W>(work_, *program_, packs);
  }
  Real slope(std::size_t k) { return result(0, k); }
  Real energy(std::size_t k) { return result(1, k); }

 private:
  Real result(std::size_t which, std::size_t k) {
    Operand const operand = program_->results[which];
    return load_pack<W>(work_.place(operand) + k * stride_of<W>(operand));
  }

  AngularProgram const& law_;
  FormulaProgram const* program_ = nullptr;
  bool constants_ = false;
  Workspace<W> work_;
};

template <InstructionSet set>
struct TupleFormulaTable {
  static constexpr int W = native_width<double>;
  static constexpr TupleFormulaKernels table{
      {tuple_kernels<AngleOf<2>, AngularProgram, W>(), tuple_kernels<AngleOf<3>, AngularProgram, W>()},
      tuple_kernels<DihedralOf, AngularProgram, W>(),
      rounds_as_machine_code<W> ? W : 0};
};

}  // namespace detail

template <>
TupleFormulaKernels const& tuple_formula_kernels<this_set>() {
  return detail::TupleFormulaTable<this_set>::table;
}

}  // namespace boltzmann
