// Evaluates the rates of fields, for one instruction set.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/schemes/pair/rate_kernels.hpp>

#include <cstddef>

namespace boltzmann {
namespace detail {

/// Fields of `count` particles become columns, block by block of their rows; the last pack is filled up with the first
/// particle.
template <int W>
void gather_fields(Workspace<W>& work, std::vector<int> const& fields, double const* rows, std::size_t stride,
                   std::size_t count) {
  for (std::size_t f = 0; f < fields.size();) {
    std::size_t const block = static_cast<std::size_t>(fields[f]) / row_block;
    std::size_t last = f + 1;
    while (last < fields.size() && static_cast<std::size_t>(fields[last]) / row_block == block) ++last;
    double const* const first = rows + block * row_block;
    auto const pack = [&](std::size_t k, auto const& row_of) {
      Pack<double, W> numbers[row_block];
      if (last - f == 1) {  // fetched by itself
        std::size_t const number = static_cast<std::size_t>(fields[f]) % row_block;
        for (int lane = 0; lane < W; ++lane) numbers[0].native[lane] = row_of(lane)[number];
        return store_pack<W>(work.column(f) + k, numbers[0]);
      }
      transpose_block<W>(row_of, 0, numbers, row_block);
      for (std::size_t g = f; g < last; ++g)
        store_pack<W>(work.column(g) + k, numbers[static_cast<std::size_t>(fields[g]) % row_block]);
    };
    std::size_t k = 0;
    for (; k + W <= count; k += W)
      pack(k, [&](int lane) { return first + (k + static_cast<std::size_t>(lane)) * stride; });
    if (k < count)
      pack(k, [&](int lane) {
        std::size_t const i = k + static_cast<std::size_t>(lane);
        return first + (i < count ? i : 0) * stride;
      });
    f = last;
  }
}

/// put(rate, number(k)) for `count` particles, where their rates stand.
template <class Number, class Put>
[[gnu::always_inline]] inline void put_rates(double* rate, std::size_t stride, std::size_t count, Number const& number,
                                             Put const& put) {
  if (stride == 1)
    for (std::size_t k = 0; k < count; ++k) put(rate[k], number(k));
  else
    for (std::size_t k = 0; k < count; ++k) put(rate[k * stride], number(k));
}

/// Particles become columns a block at a time; what the program gives is added to the rates, or is them.
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
      auto const put = [&](auto const& number) {
        if (task.store)  // a zero that is added to may be negative
          put_rates(rate, task.rates.particle, count, number, [](double& to, double x) { to = 0.0 + x; });
        else
          put_rates(rate, task.rates.particle, count, number, [](double& to, double x) { to += x; });
      };
      if (operand.scalar)
        put([&](std::size_t) { return result[0]; });
      else
        put([&](std::size_t k) { return result[k]; });
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
