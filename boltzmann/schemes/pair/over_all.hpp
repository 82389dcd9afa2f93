// The traversal of all pairs.
#pragma once

#include <boltzmann/schemes/pair/pair_sum.hpp>

namespace boltzmann {

namespace detail {

template <int W>
[[gnu::always_inline]] inline Pack<double, W> lanes_from(double first) {
  Pack<double, W> lanes;
  for (int lane = 0; lane < W; ++lane) lanes.native[lane] = first + lane;
  return lanes;
}

template <Pass pass, int W, class P, class Q, class Law>
[[gnu::flatten]] void over_all(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using S = Sum<pass, W, P, Q, Law>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  typename S::Real const sources = static_cast<double>(task.sources);
  for (std::size_t i = begin; i < end; ++i) {
    auto const p = broadcast<P, Pack<double, W>>(task.target + i * row_stride<P>);
    typename S::Real const self = task.same ? static_cast<double>(i) : -1.0;
    S sum;
    for (std::size_t j = 0; j < task.sources; j += W) {
      auto const q = load_rows<Q, W>([&](int lane) { return task.source + (j + lane) * row_stride<Q>; });
      auto const number = lanes_from<W>(static_cast<double>(j));
      sum.add(law, p, q, (number < sources) & (number != self), 0.0);
    }
    sum.store(task, i);
  }
}

}  // namespace detail

}  // namespace boltzmann
