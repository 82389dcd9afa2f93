// The traversal of neighbour lists.
#pragma once

#include <boltzmann/schemes/pair/pair_sum.hpp>

namespace boltzmann {

namespace detail {

template <Pass pass, int W, class P, class Q, class Law>
[[gnu::flatten]] void over_list(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using S = Sum<pass, W, P, Q, Law>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  typename S::Real const cutoff2 = task.cutoff2, rounding = task.rounding;
  double const* const source = task.source;
  std::size_t const stride = task.source_block_stride;
  for (std::size_t i = begin; i < end; ++i) {
    auto const p = broadcast<P, Pack<double, W>>(task.target + row_block * i, task.target_block_stride);
    S sum;
    std::uint32_t const* j = task.row[i];
    for (std::uint32_t const* const last = j + task.length[i]; j < last; j += W) {
      auto const q = load_rows<Q, W>([&](int lane) { return source + j[lane]; }, stride);
      sum.add(law, p, q, norm2(q.position - p.position) < cutoff2, rounding, task.zero_at);
    }
    sum.store(task, task.order ? task.order[i] : i);
  }
}

}  // namespace detail

}  // namespace boltzmann
