// Counting sort of points into cells.
#include <boltzmann/neighbours/cells.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {

Cells::Cells(int dimension, double const* rows, std::size_t stride, std::size_t count, double edge)
    : dimension_(dimension) {
  std::array<double, 3> high{};
  for (int a = 0; a < dimension; ++a) {
    double lowest = count ? rows[a] : 0, highest = lowest;
    for (std::size_t i = 1; i < count; ++i) {
      lowest = std::min(lowest, rows[i * stride + a]);
      highest = std::max(highest, rows[i * stride + a]);
    }
    low_[a] = lowest;
    high[a] = highest;
  }
  // Cells as small as allowed, but not many more than points: far-away particles make cells larger, not memory.
  double const most = 4.0 * static_cast<double>(count) + 64;
  for (double size = edge;; size *= 1.25) {
    double cells = 1;
    for (int a = 0; a < dimension; ++a) cells *= std::max(1.0, std::floor((high[a] - low_[a]) / size));
    if (cells > most) continue;
    for (int a = 0; a < dimension; ++a) {
      double const extent = high[a] - low_[a];
      count_[a] = static_cast<int>(std::max(1.0, std::floor(extent / size)));
      inverse_edge_[a] = extent > 0 ? count_[a] / extent : 0;
    }
    break;
  }
  std::size_t const cells = static_cast<std::size_t>(count_[0]) * count_[1] * count_[2];
  start_.assign(cells + 1, 0);
  items_.resize(count);
  std::vector<std::uint32_t> cell(count);
  for (std::size_t i = 0; i < count; ++i) {
    cell[i] = static_cast<std::uint32_t>(cell_of(rows + i * stride));
    ++start_[cell[i] + 1];
  }
  for (std::size_t c = 0; c < cells; ++c) start_[c + 1] += start_[c];
  std::vector<std::uint32_t> next(start_.begin(), start_.end() - 1);
  for (std::size_t i = 0; i < count; ++i) items_[next[cell[i]]++] = static_cast<std::uint32_t>(i);
}

std::size_t Cells::cell_of(double const* x) const {
  std::size_t cell = 0;
  for (int a = dimension_ - 1; a >= 0; --a) cell = cell * count_[a] + clamp((x[a] - low_[a]) * inverse_edge_[a], a);
  return cell;
}

}  // namespace boltzmann
