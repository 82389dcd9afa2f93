// The traversals of laws given as formulas. The partners of a row become columns, a program runs on them, and its
// results are masked and summed in the order of the lanes. For kernel units.
#pragma once

#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/schemes/pair/formula_kernels.hpp>
#include <boltzmann/schemes/pair/gather_numbers.hpp>

#include <cstddef>
#include <cstdint>
#include <limits>

namespace boltzmann::detail {

/// Returns total + x in lanes that count. AVX-512 instructions have a mask. On other processors, adding zero is cheaper
/// than selecting between two sums. Machine code does the same.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> added_where(Mask<double, W> valid, Pack<double, W> x,
                                                          Pack<double, W> total) {
  if constexpr (W == 8)
    return select(valid, total + x, total);
  else
    return total + select(valid, x, Pack<double, W>(0.0));
}
/// The same for a product.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> fused_where(Mask<double, W> valid, Pack<double, W> a, Pack<double, W> b,
                                                          Pack<double, W> total) {
  if constexpr (W == 8)
    return select(valid, total + a * b, total);
  else
    return total + select(valid, a, Pack<double, W>(0.0)) * select(valid, b, Pack<double, W>(0.0));
}

/// The sums of a row. The columns of the workspace have the layout of PairProgram. A pair that does not count has NaN
/// as its squared distance.
template <Pass pass, int W, int D>
class ColumnSum {
 public:
  using Real = Pack<double, W>;

  ColumnSum() {
    for (auto& x : influence_) x = Real(0.0);
    for (auto& x : virial_) x = Real(0.0);
  }

  /// Adds the pairs; the first steps of the program are already done.
  void add(PairProgram const& law, Workspace<W>& work, std::size_t packs, double cutoff2, Real rounding, double zero_at,
           std::size_t done = 0) {
    FormulaProgram const& program = pass == Pass::measure ? law.measure : law.influence;
    run_program<W>(work, program, packs, done);
    Real const zero = 0.0;
    double const *result[D + 1], *d[D];
    std::size_t stride[D + 1];
    std::size_t const results = program.results.size();
    for (std::size_t r = 0; r < results; ++r) {
      result[r] = work.place(program.results[r]);
      stride[r] = stride_of<W>(program.results[r]);
    }
    for (std::size_t c = 0; c < D; ++c) d[c] = work.column(c);
    double* const square = work.column(D);
    if (pass == Pass::influence && law.along && stride[0] > 0) return add_along(result[0], d, square, packs, cutoff2);
    for (std::size_t k = 0; k < packs; ++k) {
      auto const valid = load_pack<W>(square + k * W) < cutoff2;
      Real const first = load_pack<W>(result[0] + k * stride[0]);
      Real influence[D];
      for (std::size_t c = 0; c < D; ++c) {
        Real const more = law.along ? load_pack<W>(d[c] + k * W) : load_pack<W>(result[c] + k * stride[c]);
        if constexpr (pass == Pass::influence) {
          influence_[c] =
              law.along ? fused_where(valid, first, more, influence_[c]) : added_where(valid, more, influence_[c]);
        } else {
          Real x = select(valid, law.along ? first * more : more, zero);
          if constexpr (pass == Pass::reversible) x = (x + rounding) - rounding;
          influence[c] = x;
          influence_[c] += x;
        }
      }
      if constexpr (pass == Pass::measure)
        for (std::size_t a = 0; a < D; ++a) {
          Real const r = select(valid, load_pack<W>(d[a] + k * W), zero);
          for (std::size_t b = 0; b < D; ++b) virial_[a * D + b] += r * influence[b];
        }
    }
    if constexpr (pass == Pass::measure) {
      if (!law.has_energy) return;
      double const* const energy = result[results - 1];
      std::size_t const step = stride[results - 1];
      for (std::size_t k = 0; k < packs; ++k)
        energy_ += select(load_pack<W>(square + k * W) < cutoff2, load_pack<W>(energy + k * step), zero);
      if (!(zero_at > 0)) return;
      stretch(work, packs, cutoff2, zero_at);  // minus the energy at the cut-off in the same direction
      run_program<W>(work, program, packs);
      for (std::size_t k = 0; k < packs; ++k) {
        Real const s = load_pack<W>(square + k * W);
        energy_ -= select(s == s, load_pack<W>(energy + k * step), zero);
      }
    }
  }

  /// Adds the sums that machine code has left in the first columns.
  void take(Workspace<W>& work) {
    for (std::size_t c = 0; c < D; ++c) influence_[c] = load_pack<W>(work.column(c));
  }

  void store(PairTask const& task, std::size_t particle, bool overwrite) const {
    if constexpr (pass == Pass::measure) {
      task.energy[particle] += 0.5 * sum(energy_);
      for (std::size_t a = 0; a < D; ++a)
        for (std::size_t b = 0; b < D; ++b) task.virial[9 * particle + 3 * a + b] -= 0.5 * sum(virial_[a * D + b]);
    } else {
      for (std::size_t c = 0; c < D; ++c) {
        double& total = task.influence[particle * D + c];
        total = overwrite ? sum(influence_[c]) : total + sum(influence_[c]);
      }
    }
  }

 private:
  /// Moves the sources of pairs that count to this distance, in their directions; along x if two particles are
  /// coincident.
  static void stretch(Workspace<W>& work, std::size_t packs, double cutoff2, double distance) {
    double* const square = work.column(D);
    for (std::size_t k = 0; k < packs * W; k += W) {
      Real const s = load_pack<W>(square + k), stretched = distance * rsqrt(s);
      auto const apart = s > least_square;
      for (std::size_t c = 0; c < D; ++c) {
        double* const d = work.column(c) + k;
        store_pack<W>(d, select(apart, load_pack<W>(d) * stretched, Real(c == 0 ? distance : 0.0)));
      }
      store_pack<W>(square + k,
                    select(s < cutoff2, Real(distance * distance), Real(std::numeric_limits<double>::quiet_NaN())));
    }
  }
  /// Adds an influence along the line of centres. Not inlined, because within a larger function the compiler keeps a
  /// sum in memory, and each pack waits for it.
  [[gnu::noinline]] void add_along(double const* factor, double const* const* d, double const* square,
                                   std::size_t packs, double cutoff2) {
    Real total[D];
    for (std::size_t c = 0; c < D; ++c) total[c].native = influence_[c].native;
    for (std::size_t k = 0; k < packs * W; k += W) {
      auto const valid = load_pack<W>(square + k) < cutoff2;
      Real const f = load_pack<W>(factor + k);
      for (std::size_t c = 0; c < D; ++c) total[c] = fused_where(valid, f, load_pack<W>(d[c] + k), total[c]);
    }
    for (std::size_t c = 0; c < D; ++c) influence_[c].native = total[c].native;
  }

  Real influence_[D];
  Real energy_ = Real(0.0);
  Real virial_[D * D];
};

/// Loads the fields of p, and computes what follows from these alone. `field(offset)` returns the number at an offset.
template <int W, class FieldOf>
void begin_row(PairProgram const& law, FormulaProgram const& program, Workspace<W>& work, FieldOf const& field) {
  for (std::size_t k = 0; k < law.of_p.size(); ++k)
    work.set_scalar(program.first_row_input() + k, field(static_cast<std::size_t>(law.of_p[k])));
  run_row<W>(work, program);
}

/// Leading steps with specialised loops, which need no test of the instruction.
enum class Lead { nothing, reciprocal, root, reciprocal_and_root, any };

/// For packs of list entries: computes q.position - p.position and its square into the first columns, and runs the
/// leading steps on them.
template <Lead kind, int W, int D>
void gather_separations(double const* rows, std::uint32_t const* entries, std::size_t packs, double const* p,
                        Step const* steps, std::size_t leading, double least, Workspace<W>& work) {
  using Real = Pack<double, W>;
  Real const least_of_all = least;
  double *const columns = work.columns, *const squares = work.column(D);
  double* const first = work.column(leading > 0 ? steps[0].to.index : D);
  double* const second = work.column(leading > 1 ? steps[1].to.index : D);
  for (std::size_t k = 0; k < packs * W; k += W) {
    Real q[row_block];
    transpose_block<W>([&](int lane) { return rows + entries[k + static_cast<std::size_t>(lane)]; }, 0, q, D);
    Real square = 0.0;
    for (std::size_t c = 0; c < D; ++c) {
      Real const d = q[c] - p[c];
      store_pack<W>(columns + c * block_pairs + k, d);
      square = square + d * d;
    }
    square = max(square, least_of_all);
    store_pack<W>(squares + k, square);
    if constexpr (kind == Lead::any)
      for (std::size_t n = 0; n < leading; ++n)
        store_pack<W>(work.column(steps[n].to.index) + k, lead<W>(steps[n], square));
    if constexpr (kind == Lead::reciprocal || kind == Lead::reciprocal_and_root) store_pack<W>(first + k, 1.0 / square);
    if constexpr (kind == Lead::root) store_pack<W>(first + k, sqrt(square));
    if constexpr (kind == Lead::reciprocal_and_root) store_pack<W>(second + k, sqrt(square));
  }
}

/// The destination of a gathered number: a column, as number * factor + addend, rounded at most once.
struct FieldPlace {
  double* to;
  double const *factor, *addend;
};

/// For packs of list entries: gathers numbers `first` to `first + count` of a block of the rows.
template <int W, std::size_t first, std::size_t count>
void gather_block(double const* rows, std::uint32_t const* entries, std::size_t packs, FieldPlace const* places) {
  for (std::size_t k = 0; k < packs * W; k += W)
    gather_numbers<W, first, count>([&](int lane) { return rows + entries[k + static_cast<std::size_t>(lane)]; },
                                    [&](std::size_t n, Pack<double, W> x) __attribute__((always_inline)) {
                                      auto const& [to, factor, addend] = places[n];
                                      store_pack<W>(to + k, x * load_pack<W>(factor) + load_pack<W>(addend));
                                    });
}
template <int W>
using GatherBlock = void (*)(double const*, std::uint32_t const*, std::size_t, FieldPlace const*);
template <int W>
inline constexpr auto gather_blocks = for_stretches_of_a_block(
    []<std::size_t first, std::size_t count>() -> GatherBlock<W> { return gather_block<W, first, count>; });

/// The fields of q to gather, block by block of its row, and the steps of the program on single fields that are done in
/// the same pass.
template <int W>
class FieldGathering {
 public:
  /// Field f is stored in column `first_column` + f.
  FieldGathering(PairProgram const& law, FormulaProgram const& program, std::size_t steps, std::size_t first_column,
                 Workspace<W>& work) {
    store_pack<W>(one_, Pack<double, W>(1.0));
    store_pack<W>(minus_one_, Pack<double, W>(-1.0));
    store_pack<W>(minus_zero_, Pack<double, W>(-0.0));
    for (std::size_t f = 0; f < law.of_q.size(); ++f) {
      std::size_t const offset = static_cast<std::size_t>(law.of_q[f]), number = offset % row_block;
      if (count_ == 0 || blocks_[count_ - 1].which != offset / row_block) {
        Block& next = blocks_[count_++];
        next.which = offset / row_block, next.first = number;
        for (auto& place : next.places) place = {work.nowhere, one_, minus_zero_};
      }
      Block& block = blocks_[count_ - 1];
      block.places[number] = {work.column(first_column + f), one_, minus_zero_};
      block.gather = gather_blocks<W>[block.first][number - block.first];
      for (Step const* step = program.steps.data(); step < program.steps.data() + steps; ++step)
        for (bool const is_b : {false, true})
          if (auto const of = is_b ? step->b : step->a; !of.scalar && of.index == first_column + f)
            block.places[number] = place_of(*step, is_b, work);
    }
  }
  void operator()(double const* rows, std::size_t block_stride, std::uint32_t const* entries, std::size_t packs) const {
    for (Block const* block = blocks_; block < blocks_ + count_; ++block)
      block->gather(rows + block->which * block_stride, entries, packs, block->places);
  }

 private:
  struct Block {
    std::size_t which, first;
    FieldPlace places[row_block];
    GatherBlock<W> gather;
  };
  FieldPlace place_of(Step const& step, bool is_b, Workspace<W>& work) const {
    double const* const scalar = work.place(is_b ? step.a : step.b);
    double* const to = work.place(step.to);
    if (step.instruction == Instruction::multiply) return {to, scalar, minus_zero_};
    return {to, step.instruction == Instruction::add ? one_ : minus_one_, scalar};  // minus a field
  }

  alignas(64) double one_[W], minus_one_[W], minus_zero_[W];
  Block blocks_[max_columns];  // the first `count_`; each field has its own column, so there can't be more
  std::size_t count_ = 0;
};

/// The loop for these leading steps.
template <int W, int D>
auto gather_with(Step const* steps, std::size_t leading) {
  auto const is = [&](std::size_t n, Instruction instruction) { return steps[n].instruction == instruction; };
  if (leading == 0) return gather_separations<Lead::nothing, W, D>;
  if (leading == 1 && is(0, Instruction::reciprocal)) return gather_separations<Lead::reciprocal, W, D>;
  if (leading == 1 && is(0, Instruction::root)) return gather_separations<Lead::root, W, D>;
  if (leading == 2 && is(0, Instruction::reciprocal) && is(1, Instruction::root))
    return gather_separations<Lead::reciprocal_and_root, W, D>;
  return gather_separations<Lead::any, W, D>;
}

template <Pass pass, int W, int D>
void formula_over_list(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  auto const& law = *static_cast<PairProgram const*>(the_law);
  FormulaProgram const& program = pass == Pass::measure ? law.measure : law.influence;
  Workspace<W> work;
  work.set_constants(program);
  std::size_t const blocks = task.source_block_stride;
  MachineCode::List const whole = pass == Pass::influence && program.code ? program.code->list() : nullptr;
  work.set_scalar(program.scalars + D, task.cutoff2);
  // The measuring pass runs its program again, for separations that differ from those of a list.
  bool const at_once = pass != Pass::measure || program.of_one_column == 0;
  std::size_t const of_fields = at_once && !program.code ? program.of_one_column : 0;
  std::size_t const leading = at_once ? leading_steps<W>(program, D) : 0;
  Step const* const steps = program.steps.data() + of_fields;
  auto const gather = gather_with<W, D>(steps, leading);
  FieldGathering<W> const fields_of_q(law, program, of_fields, D + 1, work);
  for (std::size_t i = begin; i < end; ++i) {
    double const* const p = task.target + row_block * i;
    begin_row<W>(law, program, work, [&](std::size_t offset) {
      return p[offset / row_block * task.target_block_stride + offset % row_block];
    });
    ColumnSum<pass, W, D> sum;
    if (whole) {
      for (std::size_t c = 0; c < D; ++c) work.set_scalar(program.scalars + c, p[c]);
      std::size_t const entries = (task.length[i] + W - 1) / W * W;
      whole(task.row[i], task.row[i] + entries, task.source, work.scalars, work.columns, blocks * sizeof(double));
      sum.take(work);
      sum.store(task, task.order ? task.order[i] : i, task.overwrite);
      continue;
    }
    for (std::size_t from = 0; from < task.length[i]; from += block_pairs) {
      std::uint32_t const* const j = task.row[i] + from;
      std::size_t const left = task.length[i] - from, count = left < block_pairs ? left : block_pairs;
      std::size_t const packs = (count + W - 1) / W;  // padding entries point to no particle
      gather(task.source, j, packs, p, steps, leading, law.least_square, work);
      fields_of_q(task.source, blocks, j, packs);
      sum.add(law, work, packs, task.cutoff2, task.rounding, task.zero_at, of_fields + leading);
    }
    sum.store(task, task.order ? task.order[i] : i, task.overwrite);
  }
}

/// Sources become columns a block at a time, and every target of the range interacts with them.
template <Pass pass, int W, int D>
void formula_over_all(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using Real = Pack<double, W>;
  auto const& law = *static_cast<PairProgram const*>(the_law);
  FormulaProgram const& program = pass == Pass::measure ? law.measure : law.influence;
  Workspace<W> work;
  work.set_constants(program);
  alignas(64) double at[D][block_pairs];
  double const nan = std::numeric_limits<double>::quiet_NaN();
  std::size_t from = 0;
  do {
    std::size_t const count = task.sources - from < block_pairs ? task.sources - from : block_pairs;
    std::size_t const packs = (count + W - 1) / W;
    for (std::size_t k = 0; k < packs * W; ++k) {
      double const* const q = task.source + (from + (k < count ? k : 0)) * task.source_row_stride;
      for (std::size_t c = 0; c < D; ++c) at[c][k] = k < count ? q[c] : nan;
      for (std::size_t f = 0; f < law.of_q.size(); ++f) work.column(D + 1 + f)[k] = count > 0 ? q[law.of_q[f]] : nan;
    }
    for (std::size_t i = begin; i < end; ++i) {
      double const* const p = task.target + i * task.target_row_stride;
      begin_row<W>(law, program, work, [&](std::size_t offset) { return p[offset]; });
      for (std::size_t k = 0; k < packs; ++k) {
        Real square = 0.0;
        for (std::size_t c = 0; c < D; ++c) {
          Real const d = load_pack<W>(at[c] + k * W) - p[c];
          store_pack<W>(work.column(c) + k * W, d);
          square = square + d * d;
        }
        store_pack<W>(work.column(D) + k * W, max(square, Real(law.least_square)));
      }
      if (task.same && i >= from && i < from + count) work.column(D)[i - from] = nan;
      ColumnSum<pass, W, D> sum;
      sum.add(law, work, packs, std::numeric_limits<double>::infinity(), Real(0.0), task.zero_at);
      sum.store(task, i, task.overwrite && from == 0);
    }
    from += block_pairs;
  } while (from < task.sources);
}

template <Pass pass, int W, int D>
void formula_over_connections(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using Real = Pack<double, W>;
  auto const& law = *static_cast<PairProgram const*>(the_law);
  FormulaProgram const& program = pass == Pass::measure ? law.measure : law.influence;
  Workspace<W> work;
  work.set_constants(program);
  double const nan = std::numeric_limits<double>::quiet_NaN();
  for (std::size_t i = begin; i < end; ++i) {
    double const* const p = task.target + i * task.target_row_stride;
    begin_row<W>(law, program, work, [&](std::size_t offset) { return p[offset]; });
    ColumnSum<pass, W, D> sum;
    std::size_t last = task.start[i];
    while (last < task.start[i + 1] && task.index[last] != i) ++last;  // its own number ends a list
    for (std::size_t from = task.start[i]; from < last; from += block_pairs) {
      std::size_t const left = last - from, count = left < block_pairs ? left : block_pairs;
      std::size_t const packs = (count + W - 1) / W;
      for (std::size_t k = 0; k < packs * W; ++k) {
        double const* const q = task.source + task.index[from + (k < count ? k : 0)] * task.target_row_stride;
        double square = 0, above = 0;
        for (std::size_t c = 0; task.sheared && c < D; ++c) above -= (q[c] - p[c]) * task.up[c];
        above = (above + to_integer) - to_integer;
        for (std::size_t c = 0; c < D; ++c) {
          double d = q[c] - p[c];
          if (task.sheared) d += above * task.image[c];
          d -= ((d * task.inverse_period[c] + to_integer) - to_integer) * task.period[c];
          work.column(c)[k] = d;
          square += d * d;
        }
        work.column(D)[k] = k < count ? (square < law.least_square ? law.least_square : square) : nan;
        for (std::size_t f = 0; f < law.of_q.size(); ++f) {
          int const a = task.sheared && task.velocity >= 0 ? law.of_q[f] - task.velocity : -1;
          work.column(D + 1 + f)[k] = q[law.of_q[f]] + (a >= 0 && a < D ? above * task.faster[a] : 0);
        }
      }
      sum.add(law, work, packs, std::numeric_limits<double>::infinity(), Real(0.0), task.zero_at);
    }
    sum.store(task, i, task.overwrite);
  }
}

template <Pass pass, int W, int D>
void formula_over_particles(void const* the_law, ExternalTask const& task, std::size_t begin, std::size_t end) {
  auto const& law = *static_cast<ExternalProgram const*>(the_law);
  FormulaProgram const& program = pass == Pass::measure ? law.measure : law.influence;
  if (pass == Pass::measure && !law.has_energy) return;
  Workspace<W> work;
  work.set_constants(program);
  work.set_scalar(program.first_row_input(), task.time);
  run_row<W>(work, program);
  for (std::size_t from = begin; from < end; from += block_pairs) {
    std::size_t const count = end - from < block_pairs ? end - from : block_pairs, packs = (count + W - 1) / W;
    for (std::size_t k = 0; k < packs * W; ++k) {
      std::size_t const n = from + (k < count ? k : 0), i = task.only ? task.only[n] : n;
      for (std::size_t f = 0; f < law.of_p.size(); ++f)
        work.column(f)[k] = task.rows[i * task.row_stride + static_cast<std::size_t>(law.of_p[f])];
    }
    run_program<W>(work, program, packs);
    auto const result = [&](std::size_t r, std::size_t k) {
      Operand const operand = program.results[r];
      return operand.scalar ? work.place(operand)[0] : work.place(operand)[k];
    };
    for (std::size_t k = 0; k < count; ++k) {
      std::size_t const i = task.only ? task.only[from + k] : from + k;
      if constexpr (pass == Pass::measure) {
        task.energy[i] += result(program.results.size() - 1, k);
      } else {
        for (std::size_t c = 0; c < D; ++c) task.influence[i * D + c] += result(c, k);
      }
    }
  }
}

template <int W, int D>
constexpr PairKernels formula_pair_kernels() {
  PairKernels kernels;
  kernels.list = formula_over_list<Pass::influence, W, D>;
  kernels.list_reversible = formula_over_list<Pass::reversible, W, D>;
  kernels.list_measure = formula_over_list<Pass::measure, W, D>;
  kernels.all = formula_over_all<Pass::influence, W, D>;
  kernels.all_measure = formula_over_all<Pass::measure, W, D>;
  kernels.connected = formula_over_connections<Pass::influence, W, D>;
  kernels.connected_measure = formula_over_connections<Pass::measure, W, D>;
  return kernels;
}
template <int W, int D>
constexpr ExternalKernels formula_external_kernels() {
  ExternalKernels kernels;
  kernels.influence = formula_over_particles<Pass::influence, W, D>;
  kernels.measure = formula_over_particles<Pass::measure, W, D>;
  return kernels;
}

}  // namespace boltzmann::detail
