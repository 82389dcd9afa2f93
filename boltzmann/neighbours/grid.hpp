// Grid: the geometry of cells in space, and the cells near a block. Plain memory, for kernels too.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// The largest extent along each axis of a block of targets that share a search, in units of the reach.
inline constexpr double largest_block[3] = {1.5, 0.6, 0.6};

/// Cells of given edges that fill all of space, folded onto `count` of them along each axis: cells a multiple of
/// `count` apart are one. So the number of cells is bounded for any extent of the particles.
struct Grid {
  int dimension = 1;
  std::int64_t count[3] = {1, 1, 1};  ///< along each axis, the first varies fastest
  /// Along such an axis cells are visited in the order of their numbers, along others in spatial order. If cells are
  /// folded, or so few that a range may cover all of them, spatial order would begin elsewhere for another block.
  bool by_number[3] = {false, false, false};
  double edge[3] = {1, 1, 1}, inverse_edge[3] = {1, 1, 1};
  std::int64_t lowest[3] = {0, 0, 0};  ///< the first cell of points along each axis
  bool is_folded = false;              ///< points in one cell may be far apart

  std::size_t cells() const { return static_cast<std::size_t>(count[0] * count[1] * count[2]); }
  [[gnu::always_inline]] std::size_t cell_of(double const* x) const {
    std::int64_t cell = 0;
    for (int a = dimension - 1; a >= 0; --a) cell = cell * count[a] + folded(a, along(a, x[a]));
    return static_cast<std::size_t>(cell);
  }

  /// The cell along an axis before folding; cells beyond `most` are merged.
  [[gnu::always_inline]] std::int64_t along(int axis, double x) const {
    double c = x * inverse_edge[axis];
    c = c < -most ? -most : c > most ? most : c;
    auto const truncated = static_cast<std::int64_t>(c);
    return truncated - (c < static_cast<double>(truncated) ? 1 : 0);
  }

  /// The largest number of cells that points between two coordinates may have along an axis; the other: whether there
  /// are fewer.
  double cells_of(int axis, double low, double high) const {
    return __builtin_floor((high - low) * inverse_edge[axis]) + 2;
  }
  bool folds(int axis, double low, double high) const {
    return static_cast<double>(count[axis]) < cells_of(axis, low, high);
  }

  /// The cell onto which a cell is folded along an axis.
  [[gnu::always_inline]] std::int64_t folded(int axis, std::int64_t cell) const {
    std::int64_t const n = count[axis];
    if (cell >= 0 && cell < n) return cell;
    if (cell < 0 && cell >= -n) return cell + n;
    std::int64_t const rest = cell % n;
    return rest < 0 ? rest + n : rest;
  }
  /// The inverse, if cells are not folded: the cell with points.
  std::int64_t unfolded(int axis, std::int64_t cell) const {
    std::int64_t const n = count[axis], turned = (cell - lowest[axis]) % n;
    return lowest[axis] + (turned < 0 ? turned + n : turned);
  }

  /// The most runs of cells that near() visits.
  static constexpr int most_runs = 128;

  /// Calls visit(first, last) for runs of cells that together contain every point within `reach` of the block from
  /// `least` to `greatest` (and some further ones), each cell once. Two cells come in the same order for every block.
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
    // If rounding exceeds the reach (at 1e14 reaches from the origin), every cell is near.
    if ((to[1] - from[1] + 1) * (to[2] - from[2] + 1) > most_runs / 2) return visit(std::size_t{0}, cells() - 1);
    std::int64_t const turn2 = first_turn(2, from[2], to[2]), turn1 = first_turn(1, from[1], to[1]);
    for (std::int64_t n2 = from[2]; n2 <= to[2]; ++n2) {
      std::int64_t const k = turned(n2, turn2, from[2], to[2]);
      double const dz = dimension > 2 ? distance(2, k, to[2] - from[2], least[2], greatest[2], slack) : 0;
      for (std::int64_t n1 = from[1]; n1 <= to[1]; ++n1) {
        std::int64_t const j = turned(n1, turn1, from[1], to[1]);
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
          if (by_number[0]) visit(static_cast<std::size_t>(row), static_cast<std::size_t>(row + end - count[0] - 1));
          visit(static_cast<std::size_t>(row + start), static_cast<std::size_t>(row + count[0] - 1));
          if (!by_number[0]) visit(static_cast<std::size_t>(row), static_cast<std::size_t>(row + end - count[0] - 1));
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

  /// The number of cells at the start of the range, from `from`, that are visited last.
  [[gnu::always_inline]] std::int64_t first_turn(int axis, std::int64_t from, std::int64_t to) const {
    if (!by_number[axis]) return 0;
    std::int64_t const before = count[axis] - folded(axis, from);
    return before <= to - from ? before : 0;
  }
  [[gnu::always_inline]] static std::int64_t turned(std::int64_t n, std::int64_t turn, std::int64_t from,
                                                    std::int64_t to) {
    return n + turn <= to ? n + turn : n + turn - (to - from + 1);
  }
  /// A lower bound of the distance between the block and the points of a cell (including all cells that are folded onto
  /// it, if `others` repeat).
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
