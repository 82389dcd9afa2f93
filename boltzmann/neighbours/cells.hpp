// Cells: points sorted into a grid, for fast searches of near points.
#pragma once

#include <boltzmann/core/in_dimension.hpp>
#include <boltzmann/core/threads.hpp>
#include <boltzmann/neighbours/grid.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <span>
#include <vector>

namespace boltzmann {

/// The range of the coordinates of points.
struct Bounds {
  std::array<double, 3> low{}, high{};
  void take(int axis, double x) { low[axis] = std::min(low[axis], x), high[axis] = std::max(high[axis], x); }
  void take(Bounds const& other) {
    for (std::size_t a = 0; a < 3; ++a) {
      low[a] = std::min(low[a], other.low[a]);
      high[a] = std::max(high[a], other.high[a]);
    }
  }
  /// The bounds of points at rows + i * stride, i < count; zero if there are none.
  static Bounds of(int dimension, double const* rows, std::size_t stride, std::size_t count);
};

/// Finds the cells of `count` points; at(i) is the position of point i.
template <class At>
void find_cells(Grid const& of, std::size_t count, At const& at, std::uint32_t* cell, int threads = 1) {
  constexpr std::size_t points_per_task = 2048;
  in_dimension(of.dimension, [&](auto D) {
    for_ranges(count, points_per_task, threads, [&](std::size_t begin, std::size_t end) {
      Grid grid = of;  // a local copy, which the compiler keeps in registers
      grid.dimension = D;
      for (std::size_t i = begin; i < end; ++i) cell[i] = static_cast<std::uint32_t>(grid.cell_of(at(i)));
    });
  });
}
/// The same for points at rows + i * stride.
std::vector<std::uint32_t> cells_of(Grid const& grid, double const* rows, std::size_t stride, std::size_t count,
                                    int threads = 1);

/// A grid fine enough for searches within `reach`, and the points in each cell. The number of cells is bounded by a
/// multiple of the number of points, for any extent.
class Cells {
 public:
  Cells() = default;
  /// Points at rows + i * stride, i < count, `dimension` coordinates each, all finite.
  Cells(int dimension, double const* rows, std::size_t stride, std::size_t count, double reach, int threads = 1)
      : Cells(grid_for(dimension, Bounds::of(dimension, rows, stride, count), count, reach), rows, stride, count, reach,
              threads) {}
  /// The same with a given grid, and with known cells of points.
  Cells(Grid const& grid, double const* rows, std::size_t stride, std::size_t count, double reach, int threads)
      : Cells(grid, cells_of(grid, rows, stride, count, threads), reach) {}
  Cells(Grid const& grid, std::span<std::uint32_t const> cell_of_point, double reach);

  /// The grid for this number of points of that extent.
  static Grid grid_for(int dimension, Bounds const& extent, std::size_t count, double reach);

  /// The points in cell order, those of one cell in the order they were given.
  std::vector<std::uint32_t> const& items() const { return items_; }
  Grid const& grid() const { return grid_; }
  /// items()[start()[c]] ... items()[start()[c + 1] - 1] are in cell c.
  std::uint32_t const* start() const { return start_.get(); }
  std::size_t bytes() const { return (grid_.cells() + 1 + items_.capacity()) * sizeof start_[0]; }

  /// True if cells in another grid follow from those in this one, for the same points.
  bool tell_cells_in(Grid const& other) const;
  /// If so: the cells of items(), in their order.
  void cells_in(Grid const& other, std::uint32_t* cell_of_item) const;

  /// Calls visit(begin, end) for ranges of items() that contain every point within `reach` of x (and some further
  /// ones).
  template <class Visit>
  void near(double const* x, double reach, Visit visit) const {
    grid_.near(x, reach, [&](std::size_t first, std::size_t last) { visit(start_[first], start_[last + 1]); });
  }
  template <class Visit>
  void near(double const* x, Visit visit) const {
    near(x, reach_, visit);
  }

 private:
  Grid grid_;
  double reach_ = 0;
  std::unique_ptr<std::uint32_t[]> start_ = std::make_unique<std::uint32_t[]>(2);
  std::vector<std::uint32_t> items_;
};

}  // namespace boltzmann
