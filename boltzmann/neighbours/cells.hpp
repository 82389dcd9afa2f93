// Cells: points sorted into a grid, so that what is near can be found without asking everyone.
#pragma once

#include <boltzmann/neighbours/grid.hpp>

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// Between which coordinates points are.
struct Bounds {
  std::array<double, 3> low{}, high{};
  /// Of points at rows + i * stride, i < count; zero of none.
  static Bounds of(int dimension, double const* rows, std::size_t stride, std::size_t count);
};

/// The cell of each of `count` points, at rows + i * stride.
std::vector<std::uint32_t> cells_of(Grid const& grid, double const* rows, std::size_t stride, std::size_t count,
                                    int threads = 1);

/// A grid fine enough to find what is within `reach`, and the points in each cell. The number of cells is kept in
/// proportion to the number of points, whatever their extent.
class Cells {
 public:
  Cells() = default;
  /// Points at rows + i * stride, i < count, `dimension` coordinates each, all finite.
  Cells(int dimension, double const* rows, std::size_t stride, std::size_t count, double reach, int threads = 1)
      : Cells(grid_for(dimension, Bounds::of(dimension, rows, stride, count), count, reach), rows, stride, count, reach,
              threads) {}
  /// The same in a grid that is given.
  Cells(Grid const& grid, double const* rows, std::size_t stride, std::size_t count, double reach, int threads);

  /// The grid for so many points of that extent.
  static Grid grid_for(int dimension, Bounds const& extent, std::size_t count, double reach);

  /// The points in cell order, those of one cell in the order they were given.
  std::vector<std::uint32_t> const& items() const { return items_; }
  Grid const& grid() const { return grid_; }
  /// items()[start()[c]] ... items()[start()[c + 1] - 1] are in cell c.
  std::vector<std::uint32_t> const& start() const { return start_; }

  /// Calls visit(begin, end) for ranges of items() that hold every point within `reach` of x (and some further ones).
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
  std::vector<std::uint32_t> start_{0, 0}, items_;
};

}  // namespace boltzmann
