// The traversal of fixed connections, over the nearest periodic image. Lanes are particles. All of them process their
// first partner, then their second, ...
#pragma once

#include <boltzmann/schemes/pair/lane_sum.hpp>

#include <concepts>
#include <cstdint>

namespace boltzmann {

namespace detail {

/// In a sheared box: maps the difference of two positions to the image that is nearest along the gradient. Returns how
/// many lengths that image is above the second position.
template <int D, int W>
[[gnu::always_inline]] inline Pack<double, W> nearest_layer(Vector<D, Pack<double, W>>& d, PairTask const& task) {
  Pack<double, W> above = 0.0;
  for (int a = 0; a < D; ++a) above = above - d[a] * task.up[a];
  above = (above + to_integer) - to_integer;
  for (int a = 0; a < D; ++a) d[a] = d[a] + above * task.image[a];
  return above;
}

/// Maps the difference of two positions to the nearest periodic image: d -= L round(d / L), without a branch.
template <int D, int W>
[[gnu::always_inline]] inline void nearest_image(Vector<D, Pack<double, W>>& d, PairTask const& task) {
  for (int a = 0; a < D; ++a) {
    Pack<double, W> const turns = (d[a] * task.inverse_period[a] + to_integer) - to_integer;
    d[a] = d[a] - turns * task.period[a];
  }
}

/// A particle without a k-th partner is paired with itself, which is masked. A list ends before its own particle's
/// number, if it contains that. Every lane adds its own partners in their order, so the result has the same bits for
/// every division into ranges.
template <Pass pass, int W, class P, class Law>
[[gnu::flatten]] void over_connections(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using Real = Pack<double, W>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  std::size_t const stride = stride_of<P, Law>(task.target_row_stride);
  for (std::size_t first = begin; first < end; first += W) {
    std::size_t next[W], last[W];
    for (std::size_t lane = 0; lane < W; ++lane) {
      std::size_t const i = first + lane;
      next[lane] = i < end ? task.start[i] : 0;
      last[lane] = i < end ? task.start[i + 1] : 0;
    }
    auto const p = load_neighbouring_rows<P, W>(task.target, stride, first, task.targets);
    LaneSum<pass, W, P, P, Law> sum;
    for (;;) {
      std::size_t partner[W];
      Real away;
      std::size_t somebody = 0;
      for (std::size_t lane = 0; lane < W; ++lane) {
        std::size_t const i = first + lane < task.targets ? first + lane : task.targets - 1;
        std::size_t const j = next[lane] < last[lane] ? task.index[next[lane]++] : i;
        partner[lane] = j;
        somebody |= j ^ i;
        away.native[lane] = j != i ? 1.0 : 0.0;
      }
      if (somebody == 0) break;
      auto q = load_rows<P, W>([&](int lane) { return task.source + partner[lane] * stride; });
      auto d = q.position - p.position;
      if (task.sheared) {
        Real const above = nearest_layer(d, task);
        if constexpr (requires { requires std::same_as<decltype(q.velocity), decltype(q.position)>; })
          for (int a = 0; a < P::dimension; ++a) q.velocity[a] += above * task.faster[a];
      }
      nearest_image(d, task);
      q.position = p.position + d;
      sum.add(law, p, q, away != 0.0);
    }
    sum.store(task, first, first, end, task.overwrite);
  }
}

}  // namespace detail

}  // namespace boltzmann
