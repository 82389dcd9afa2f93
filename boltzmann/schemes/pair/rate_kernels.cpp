// Evaluates the rates of fields, for one instruction set.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/schemes/pair/rate_kernels.hpp>

#include <cstddef>

namespace boltzmann {
namespace detail {

/// Particles become columns a block at a time; what the program gives is added to the rates.
template <int W, int D>
void rates_over_particles(void const* the_law, ExternalTask const& task, std::size_t begin, std::size_t end) {
  auto const& law = *static_cast<RateProgram const*>(the_law);
  FormulaProgram const& program = law.program;
  Workspace<W> work;
  work.set_constants(program);
  work.set_scalar(program.first_row_input(), task.time);
  run_row<W>(work, program);
  for (std::size_t from = begin; from < end; from += block_pairs) {
    std::size_t const count = end - from < block_pairs ? end - from : block_pairs, packs = (count + W - 1) / W;
    std::size_t const of_p = law.of_p.size();
    auto const gather = [&](std::size_t f, double const* numbers, std::size_t stride) {
      double* const column = work.column(f);
      for (std::size_t k = 0; k < count; ++k) column[k] = numbers[k * stride];
      for (std::size_t k = count; k < packs * W; ++k) column[k] = column[0];
    };
    for (std::size_t f = 0; f < of_p; ++f)
      gather(f, task.rows + from * task.row_stride + static_cast<std::size_t>(law.of_p[f]), task.row_stride);
    for (std::size_t s = 0; s < law.sums.size(); ++s)
      gather(of_p + s, task.influence + law.sums[s].rate * task.rate_stride + from * D + law.sums[s].component, D);
    run_program<W>(work, program, packs);
    for (std::size_t r = 0; r < program.results.size(); ++r) {
      Operand const operand = program.results[r];
      double const* const result = work.place(operand);
      double* const rate =
          task.influence + law.results[r].rate * task.rate_stride + from * D + law.results[r].component;
      if (operand.scalar)
        for (std::size_t k = 0; k < count; ++k) rate[k * D] += result[0];
      else
        for (std::size_t k = 0; k < count; ++k) rate[k * D] += result[k];
    }
  }
}

template <InstructionSet set>
struct RateTable {
  static constexpr int W = native_width<double>;
  static constexpr RateKernelTable table{
      {rates_over_particles<W, 1>, rates_over_particles<W, 2>, rates_over_particles<W, 3>}};
};

}  // namespace detail

template <>
RateKernelTable const& rate_kernels<this_set>() {
  return detail::RateTable<this_set>::table;
}

}  // namespace boltzmann
