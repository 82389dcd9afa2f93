// Visits every pair of a few particles once, with scalars.
#pragma once

#include <boltzmann/schemes/pair/pair_sum.hpp>

#include <array>

namespace boltzmann {

/// Up to this size, scalars over half of the pairs are faster than packs over all of them.
inline constexpr std::size_t small_system_particles = 24;

namespace detail {

/// Every pair of one ensemble once. For 2, 3 and 4 particles the count is a constant, and all data stay in registers.
template <class P, class Law, class Count>
[[gnu::always_inline]] inline void each_pair(Law const& law, PairTask const& task, Count count) {
  constexpr std::size_t components = sizeof(typename P::Influence) / sizeof(double);
  constexpr std::size_t most = small_system_particles;
  double const* const rows = task.target;
  std::size_t const stride = stride_of<P, Law>(task.target_row_stride);
  std::array<std::array<double, components>, most> total;
  for (std::size_t i = 0; i < count; ++i) total[i] = {};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      P const &p = particle_at<P>(rows + i * stride), &q = particle_at<P>(rows + j * stride);
      auto const on_p = as_array<double>(influence_of(law(p, q)));
      if constexpr (symmetry_of<Law>() == Symmetry::antisymmetric) {
        for (std::size_t c = 0; c < components; ++c) total[i][c] += on_p[c], total[j][c] -= on_p[c];
      } else {
        auto const on_q = as_array<double>(influence_of(law(q, p)));
        for (std::size_t c = 0; c < components; ++c) total[i][c] += on_p[c], total[j][c] += on_q[c];
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < components; ++c) {
      double& influence = task.influence[i * components + c];
      influence = task.overwrite ? total[i][c] : influence + total[i][c];
    }
}

template <int W, class P, class Law>
[[gnu::flatten, gnu::optimize("no-tree-vectorize")]] void over_small(void const* the_law, PairTask const& task,
                                                                     std::size_t, std::size_t) {
  Held<Law> law = *static_cast<Law const*>(the_law);
  switch (task.targets) {
    case 2:
      return each_pair<P>(law, task, std::integral_constant<std::size_t, 2>{});
    case 3:
      return each_pair<P>(law, task, std::integral_constant<std::size_t, 3>{});
    case 4:
      return each_pair<P>(law, task, std::integral_constant<std::size_t, 4>{});
    default:
      return each_pair<P>(law, task, task.targets);
  }
}

}  // namespace detail

}  // namespace boltzmann
