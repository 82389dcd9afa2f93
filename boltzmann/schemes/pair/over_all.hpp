// The traversal of all pairs: lanes are targets, and the loop runs over all sources.
#pragma once

#include <boltzmann/schemes/pair/lane_sum.hpp>

namespace boltzmann {

namespace detail {

/// The number of target packs that share one load of a source. Two keep the arithmetic units busy with 32 registers,
/// one with 16. Four packs of two components each fit into 32, and also share what a law computes from the source
/// alone.
template <int W, std::size_t components>
inline constexpr int target_packs = W < 8             ? 1
                                    : components <= 2 ? 4
                                                      : 2;

/// The number of sources whose influences are summed before they are added to the total. Rounding errors grow with this
/// number plus the number of groups, not with their product.
inline constexpr std::size_t source_group = 1024;

/// Every target sums the sources in their order, in groups, independent of the other targets. So the result has the
/// same bits for every division into ranges. Blocks of targets begin at multiples of their size. A range that does not
/// begin there also computes the targets of its first block outside the range; ranges of several blocks lose nothing.
template <Pass pass, int W, class P, class Q, class Law>
[[gnu::flatten]] void over_all(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  constexpr int packs = pass == Pass::measure ? 1 : target_packs<W, LaneSum<pass, W, P, Q, Law>::components>;
  constexpr std::size_t block = packs * W;
  using Real = Pack<double, W>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  std::size_t const target_stride = stride_of<P, Law>(task.target_row_stride);
  std::size_t const source_stride = stride_of<Q, Law>(task.source_row_stride);
  for (std::size_t first = begin / block * block; first < end; first += block) {
    rebind_t<P, Real> p[packs];
    for (int t = 0; t < packs; ++t)
      p[t] = load_neighbouring_rows<P, W>(task.target, target_stride, first + t * W, task.targets);
    std::size_t j = 0;
    do {
      bool const overwrite = task.overwrite && j == 0;
      std::size_t const group_end = task.sources - j < source_group ? task.sources : j + source_group;
      std::size_t const self_begin = task.same && first < group_end ? first : group_end;
      std::size_t const self_end = task.same && first + block < group_end ? first + block : group_end;
      LaneSum<pass, W, P, Q, Law> sum[packs];
      // Without a mask up to the block's own particles, with a mask there, then without again.
      for (std::size_t const pause : {self_begin, group_end}) {
        for (; j < pause; ++j) {
          auto const q = spread_row<Q, Real>(task.source + j * source_stride);
#pragma GCC unroll 4
          for (int t = 0; t < packs; ++t) sum[t].add(law, p[t], q, every_lane<W>());
        }
        for (; j < self_end; ++j) {
          auto const q = spread_row<Q, Real>(task.source + j * source_stride);
#pragma GCC unroll 4
          for (int t = 0; t < packs; ++t)
            sum[t].add(law, p[t], q, lanes_from<W>(static_cast<double>(first + t * W)) != static_cast<double>(j));
        }
      }
#pragma GCC unroll 4
      for (int t = 0; t < packs; ++t) sum[t].store(task, first + t * W, begin, end, overwrite);
    } while (j < task.sources);
  }
}

}  // namespace detail

}  // namespace boltzmann
