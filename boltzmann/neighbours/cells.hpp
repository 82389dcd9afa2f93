// Cells: points sorted into a grid, so that what is near can be found without asking everyone.
#pragma once

#include <array>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// A grid of cells no smaller than `edge` over the bounding box of the points, and the points in each. The number of
/// cells is kept in proportion to the number of points, whatever their extent.
class Cells {
 public:
  /// Points at rows + i * stride, i < count, `dimension` coordinates each, all finite.
  Cells(int dimension, double const* rows, std::size_t stride, std::size_t count, double edge);

  /// The points in cell order, those of one cell in the order they were given.
  std::vector<std::uint32_t> const& items() const { return items_; }

  /// Calls visit(begin, end) for ranges of items() that hold every point within `edge` of x (and some further ones).
  template <class Visit>
  void near(double const* x, Visit visit) const {
    std::array<int, 3> low{0, 0, 0}, high{0, 0, 0};
    for (int a = 0; a < dimension_; ++a) {
      double const c = (x[a] - low_[a]) * inverse_edge_[a];
      double const one = 1 + 1e-15 * (count_[a] + 1.0);  // c is rounded, and so is that of the neighbour
      low[a] = clamp(c - one, a);
      high[a] = clamp(c + one, a);
    }
    for (int k = low[2]; k <= high[2]; ++k)
      for (int j = low[1]; j <= high[1]; ++j) {
        std::size_t const row = (static_cast<std::size_t>(k) * count_[1] + j) * count_[0];
        visit(start_[row + low[0]], start_[row + high[0] + 1]);
      }
  }

 private:
  int clamp(double c, int axis) const {
    // Not c <= 0: where the extent or its inverse is not finite, c is NaN, and there is one cell.
    return !(c > 0) ? 0 : c >= count_[axis] ? count_[axis] - 1 : static_cast<int>(c);
  }
  std::size_t cell_of(double const* x) const;

  int dimension_;
  std::array<double, 3> low_{}, inverse_edge_{};
  std::array<int, 3> count_{1, 1, 1};
  std::vector<std::uint32_t> start_, items_;
};

}  // namespace boltzmann
