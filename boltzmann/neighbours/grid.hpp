// Grid: the geometry of cells in space; which cells are near a block. Plain memory, for kernels too.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// Cells of given edges that fill all of space, folded onto `count` of them along each axis: those a multiple of
/// `count` apart are one. So there are as many as wanted, however far particles are from each other.
struct Grid {
  int dimension = 1;
  std::int64_t count[3] = {1, 1, 1};  ///< along each axis, the first runs fastest
  double edge[3] = {1, 1, 1}, inverse_edge[3] = {1, 1, 1};

  std::size_t cells() const { return static_cast<std::size_t>(count[0] * count[1] * count[2]); }
  [[gnu::always_inline]] std::size_t cell_of(double const* x) const {
    std::int64_t cell = 0;
    for (int a = dimension - 1; a >= 0; --a) cell = cell * count[a] + folded(a, along(a, x[a]));
    return static_cast<std::size_t>(cell);
  }

  /// The runs of cells that near() finds at most.
  static constexpr int most_runs = 128;

  /// Calls visit(first, last) for runs of cells that together hold every point within `reach` of the block from `least`
  /// to `greatest` (and some further ones), each cell once.
  template <class Visit>
  [[gnu::always_inline]] void near(double const* least, double const* greatest, double reach, Visit visit) const {
    std::int64_t from[3] = {0, 0, 0}, to[3] = {0, 0, 0};
    double largest = reach;  // of the numbers that are rounded here
    for (int a = 0; a < dimension; ++a) {
      largest = -least[a] > largest ? -least[a] : largest;
      largest = greatest[a] > largest ? greatest[a] : largest;
    }
    double const slack = 1e-14 * largest, wide = reach + slack;
    for (int a = 1; a < dimension; ++a) {
      from[a] = along(a, least[a] - wide);
      to[a] = along(a, greatest[a] + wide);
      if (to[a] - from[a] >= count[a]) to[a] = from[a] + count[a] - 1;
    }
    // Where rounding is wider than the reach (1e14 of it from the origin) everything is near.
    if ((to[1] - from[1] + 1) * (to[2] - from[2] + 1) > most_runs / 2) return visit(std::size_t{0}, cells() - 1);
    for (std::int64_t k = from[2]; k <= to[2]; ++k) {
      double const dz = dimension > 2 ? distance(2, k, to[2] - from[2], least[2], greatest[2], slack) : 0;
      for (std::int64_t j = from[1]; j <= to[1]; ++j) {
        double const dy = dimension > 1 ? distance(1, j, to[1] - from[1], least[1], greatest[1], slack) : 0;
        double const rest = wide * wide - (dy * dy + dz * dz);
        if (rest < 0) continue;
        double const half = __builtin_sqrt(rest) + slack;
        std::int64_t const row = (folded(2, k) * count[1] + folded(1, j)) * count[0];
        std::int64_t const first = along(0, least[0] - half), beyond = along(0, greatest[0] + half) - first + 1;
        if (beyond >= count[0]) {
          visit(static_cast<std::size_t>(row), static_cast<std::size_t>(row + count[0] - 1));
          continue;
        }
        std::int64_t const start = folded(0, first), end = start + beyond;
        if (end <= count[0]) {
          visit(static_cast<std::size_t>(row + start), static_cast<std::size_t>(row + end - 1));
        } else {
          visit(static_cast<std::size_t>(row + start), static_cast<std::size_t>(row + count[0] - 1));
          visit(static_cast<std::size_t>(row), static_cast<std::size_t>(row + end - count[0] - 1));
        }
      }
    }
  }
  template <class Visit>
  [[gnu::always_inline]] void near(double const* x, double reach, Visit visit) const {
    near(x, x, reach, visit);
  }

 private:
  static constexpr double most = 1e15;

  /// The cell along an axis, not folded; those beyond `most` are one.
  [[gnu::always_inline]] std::int64_t along(int axis, double x) const {
    double c = x * inverse_edge[axis];
    c = c < -most ? -most : c > most ? most : c;
    auto const truncated = static_cast<std::int64_t>(c);
    return truncated - (c < static_cast<double>(truncated) ? 1 : 0);
  }
  [[gnu::always_inline]] std::int64_t folded(int axis, std::int64_t cell) const {
    std::int64_t const n = count[axis];
    if (cell >= 0 && cell < n) return cell;
    if (cell < 0 && cell >= -n) return cell + n;
    std::int64_t const rest = cell % n;
    return rest < 0 ? rest + n : rest;
  }
  /// How far the block is at least from every point of a cell (all that are folded onto it, if `others` go round).
  [[gnu::always_inline]] double distance(int axis, std::int64_t cell, std::int64_t others, double least,
                                         double greatest, double slack) const {
    auto const n = static_cast<double>(cell);
    if (others + 1 >= count[axis] || n >= most || n <= -most) return 0;
    double const begin = n * edge[axis];
    double const below = begin - greatest - slack, above = least - (begin + edge[axis]) - slack;
    double const out = below > above ? below : above;
    return out > 0 ? out : 0;
  }
};

}  // namespace boltzmann
