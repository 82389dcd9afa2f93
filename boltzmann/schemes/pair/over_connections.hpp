// The traversal of fixed connections, over the nearest periodic image.
#pragma once

#include <boltzmann/schemes/pair/pair_sum.hpp>

namespace boltzmann {

namespace detail {

/// The difference of two positions made the shortest among periodic images: d -= L round(d / L), without a branch.
template <int D, int W>
[[gnu::always_inline]] inline void nearest_image(Vector<D, Pack<double, W>>& d, PairTask const& task) {
  constexpr double to_integer =
      6755399441055744.0;  // 3/2 2^52: adding and subtracting it rounds to the nearest integer
  for (int a = 0; a < D; ++a) {
    Pack<double, W> const turns = (d[a] * task.inverse_period[a] + to_integer) - to_integer;
    d[a] = d[a] - turns * task.period[a];
  }
}

template <Pass pass, int W, class P, class Law>
[[gnu::flatten]] void over_connections(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using S = Sum<pass, W, P, P, Law>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  for (std::size_t i = begin; i < end; ++i) {
    auto const p = broadcast<P, Pack<double, W>>(task.target + i * row_stride<P>);
    typename S::Real const self = static_cast<double>(i);
    S sum;
    std::uint32_t const* const last = task.index + task.start[i + 1];
    for (std::uint32_t const* j = task.index + task.start[i]; j != last; j += W) {
      auto q = load_rows<P, W>([&](int lane) { return task.source + j[lane] * row_stride<P>; });
      auto d = q.position - p.position;
      nearest_image(d, task);
      q.position = p.position + d;
      typename S::Real number;
      for (int lane = 0; lane < W; ++lane) number.native[lane] = j[lane];
      sum.add(law, p, q, number != self, 0.0);
    }
    sum.store(task, i);
  }
}

}  // namespace detail

}  // namespace boltzmann
