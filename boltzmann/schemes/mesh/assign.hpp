// Assignment and interpolation for the particles in ensembles (section 4.4, steps 1 and 4), by B-splines of any order,
// with the same weights in both directions.
#pragma once

#include <boltzmann/schemes/mesh/assign_task.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>

#include <bit>
#include <cmath>

namespace boltzmann::detail {

/// Finds the position of a particle on the mesh. Returns false if it is not in the box.
template <int D, int p>
[[gnu::always_inline]] inline bool place(AssignTask const& task, double const* position, std::size_t& first,
                                         double (&weights)[D][p]) {
  std::size_t node[3] = {0, 0, 0};
  bool inside = true;
  for (int a = 0; a < D; ++a) {
    double s = (position[a] - task.low[a]) * task.per_length[a];
    auto const n = static_cast<double>(task.cells[a]);
    if (task.periodic[a] && !(s >= 0 && s < n)) s -= n * std::floor(s / n);
    // A particle within rounding of an edge counts as on the edge.
    inside = inside && s >= -1e-9 * n && s <= n * (1 + 1e-9);
    double const kept = s >= 0 ? (s <= n ? s : n) : 0;  // also maps NaN into the mesh, so that no address is invalid
    double const t = p % 2 == 1 ? kept + 0.5 : kept;
    double const whole = std::floor(t);
    node[a] = static_cast<std::size_t>(whole);
    spline_weights<p>(t - whole, weights[a]);
  }
  first = (node[2] * task.nodes_y + node[1]) * task.nodes_x + node[0];
  return inside;
}

/// Calls function(first node of the row, weight of the row) for every row of nodes along x in the range of a particle.
template <int D, int p, class Function>
[[gnu::always_inline]] inline void rows_of(AssignTask const& task, std::size_t first, double const (&weights)[D][p],
                                           Function const& function) {
  if constexpr (D == 1) {
    function(first, 1.0);
  } else if constexpr (D == 2) {
    for (int y = 0; y < p; ++y) function(first + static_cast<std::size_t>(y) * task.nodes_x, weights[1][y]);
  } else {
    for (int z = 0; z < p; ++z)
      for (int y = 0; y < p; ++y)
        function(first + (static_cast<std::size_t>(z) * task.nodes_y + static_cast<std::size_t>(y)) * task.nodes_x,
                 weights[1][y] * weights[2][z]);
  }
}

template <int D, int p, int W>
[[gnu::flatten]] void assign(AssignTask const& task, AssignResult& result, std::size_t begin, std::size_t end) {
  constexpr double shift = 0x1.8p52;
  for (std::size_t i = begin; i < end; ++i) {
    double weights[D][p];
    std::size_t first;
    if (!place<D, p>(task, task.rows + i * task.stride, first, weights)) {
      if (i < result.outside) result.outside = i;
      continue;
    }
    double const amount = task.strength[i] * task.per_strength;
    rows_of<D, p>(task, first, weights, [&](std::size_t node, double weight) {
      double const row = amount * weight;
      std::int64_t* const counts = task.counts + node;
      for (int x = 0; x < p; ++x)
        counts[x] += std::bit_cast<std::int64_t>(row * weights[0][x] + shift) - std::bit_cast<std::int64_t>(shift);
    });
  }
}

template <int D, int p, int W>
[[gnu::flatten]] void interpolate(AssignTask const& task, AssignResult& result, std::size_t begin, std::size_t end) {
  for (std::size_t i = begin; i < end; ++i) {
    double weights[D][p];
    std::size_t first;
    if (!place<D, p>(task, task.rows + i * task.stride, first, weights) && i < result.outside) result.outside = i;
    double* const to = task.result + i * static_cast<std::size_t>(task.components);
    for (int c = 0; c < task.components; ++c) {
      double sum = 0;
      rows_of<D, p>(task, first, weights, [&](std::size_t node, double weight) {
        double const* const field = task.field[c] + node;
        double row = 0;
        for (int x = 0; x < p; ++x) row += field[x] * weights[0][x];
        sum += weight * row;
      });
      sum *= task.strength[i];
      to[c] = task.overwrite ? sum : to[c] + sum;
    }
  }
}

}  // namespace boltzmann::detail
