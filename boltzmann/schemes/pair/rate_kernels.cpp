// Evaluates the rates of fields, for one instruction set.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/schemes/pair/gather_numbers.hpp>
#include <boltzmann/schemes/pair/rate_kernels.hpp>

#include <cstddef>

namespace boltzmann {
namespace detail {

/// Copies numbers `first` to `first + count` of a block of rows into columns. The last pack is padded with the first
/// particle.
template <int W, std::size_t first, std::size_t count>
void gather_rows(double const* rows, std::size_t stride, std::size_t particles, double* const* to) {
  auto const pack = [&](std::size_t k, auto const& row) __attribute__((always_inline)) {
    gather_numbers<W, first, count>(
        row, [&](std::size_t n, Pack<double, W> x) __attribute__((always_inline)) { store_pack<W>(to[n] + k, x); });
  };
  std::size_t k = 0;
  for (; k + W <= particles; k += W)
    pack(k, [&](int lane) { return rows + (k + static_cast<std::size_t>(lane)) * stride; });
  if (k < particles)
    pack(k, [&](int lane) {
      std::size_t const i = k + static_cast<std::size_t>(lane);
      return rows + (i < particles ? i : 0) * stride;
    });
}
template <int W>
using GatherRows = void (*)(double const*, std::size_t, std::size_t, double* const*);
template <int W>
inline constexpr auto gather_rows_of = for_stretches_of_a_block(
    []<std::size_t first, std::size_t count>() -> GatherRows<W> { return gather_rows<W, first, count>; });

/// Copies fields of `count` particles into columns, block by block of their rows.
template <int W>
void gather_fields(Workspace<W>& work, std::vector<int> const& fields, double const* rows, std::size_t stride,
                   std::size_t count) {
  for (std::size_t f = 0; f < fields.size();) {
    std::size_t const block = static_cast<std::size_t>(fields[f]) / row_block;
    std::size_t const first = static_cast<std::size_t>(fields[f]) % row_block;
    double* to[row_block] = {work.nowhere, work.nowhere, work.nowhere, work.nowhere};
    std::size_t end = first;
    for (; f < fields.size() && static_cast<std::size_t>(fields[f]) / row_block == block; ++f) {
      std::size_t const number = static_cast<std::size_t>(fields[f]) % row_block;
      to[number] = work.column(f), end = number + 1;
    }
    gather_rows_of<W>[first][end - first - 1](rows + block * row_block, stride, count, to);
  }
}

/// Adds numbers, `step` (1 or 0) apart, to the rates of `count` particles, or stores them.
template <int W, bool adds>
void put_rates(double* rate, std::size_t stride, std::size_t count, double const* numbers, std::size_t step) {
  std::size_t k = 0, n = 0;
  if (stride == 1)
    for (; k + W <= count; k += W, n += W * step) {
      Pack<double, W> const before = adds ? load_pack<W>(rate + k) : Pack<double, W>(0.0);
      store_pack<W>(rate + k, before + load_pack<W>(numbers + n));
    }
  for (; k < count; ++k, n += step) rate[k * stride] = (adds ? rate[k * stride] : 0.0) + numbers[n];
}

/// Copies particles into columns a block at a time. The results of the program are added to the rates, or stored.
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
    gather_fields<W>(work, law.of_p, task.rows + from * task.row_stride, task.row_stride, count);
    for (std::size_t s = 0; s < law.sums.size(); ++s) {
      double const* const sum = task.sums.of(law.sums[s].rate, law.sums[s].component, from);
      double* const column = work.column(law.of_p.size() + s);
      for (std::size_t k = 0; k < count; ++k) column[k] = sum[k * task.sums.particle];
      for (std::size_t k = count; k < packs * W; ++k) column[k] = column[0];
    }
    run_program<W>(work, program, packs);
    for (std::size_t r = 0; r < program.results.size(); ++r) {
      Operand const operand = program.results[r];
      double const* const result = work.place(operand);
      double* const rate = task.rates.of(law.results[r].rate, law.results[r].component, from - task.first);
      auto const put =
          task.store ? put_rates<W, false> : put_rates<W, true>;  // adding to zero would lose the sign of -0
      put(rate, task.rates.particle, count, result, operand.scalar ? 0 : 1);
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
