// Counting sort of points into cells.
#include <boltzmann/neighbours/cells.hpp>

#include <boltzmann/core/threads.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

// Edges of a cell in units of the reach: long runs along the first axis are cut to measure, the others tell rows of
// cells that are out of reach.
constexpr double first_edge = 0.25, other_edge = 0.5;
constexpr std::size_t points_per_task = 2048;  // points

/// Of each of these points, in a grid of D dimensions.
template <int D>
void find_cells(Grid const& of, double const* rows, std::size_t stride, std::size_t begin, std::size_t end,
                std::uint32_t* cell) {
  Grid grid = of;  // known to nobody else, so that it stays in registers
  grid.dimension = D;
  for (std::size_t i = begin; i < end; ++i) cell[i] = static_cast<std::uint32_t>(grid.cell_of(rows + i * stride));
}

}  // namespace

std::vector<std::uint32_t> cells_of(Grid const& grid, double const* rows, std::size_t stride, std::size_t count,
                                    int threads) {
  std::vector<std::uint32_t> cell(count);
  for_ranges(count, points_per_task, threads, [&](std::size_t begin, std::size_t end) {
    auto const find = grid.dimension == 1 ? find_cells<1> : grid.dimension == 2 ? find_cells<2> : find_cells<3>;
    find(grid, rows, stride, begin, end, cell.data());
  });
  return cell;
}

Bounds Bounds::of(int dimension, double const* rows, std::size_t stride, std::size_t count) {
  Bounds extent;
  for (int a = 0; a < dimension && count > 0; ++a) {
    double lowest = rows[a], highest = lowest;
    for (std::size_t i = 1; i < count; ++i) {
      lowest = std::min(lowest, rows[i * stride + a]);
      highest = std::max(highest, rows[i * stride + a]);
    }
    extent.low[a] = lowest;
    extent.high[a] = highest;
  }
  return extent;
}

Grid Cells::grid_for(int dimension, Bounds const& extent, std::size_t count, double reach) {
  Grid grid;
  grid.dimension = dimension;
  // Not many more cells than points: those of far-away particles are folded onto the others.
  double const most = std::min(4.0 * static_cast<double>(count) + 64, 4e9);  // and numbers of 32 bits
  std::array<double, 3> along{1, 1, 1};
  for (int a = 0; a < dimension; ++a) {
    grid.edge[a] = reach * (a == 0 ? first_edge : other_edge);
    grid.inverse_edge[a] = 1 / grid.edge[a];
    along[a] = std::min(most, grid.cells_of(a, extent.low[a], extent.high[a]));
  }
  while (along[0] * along[1] * along[2] > most) {
    double& longest = *std::max_element(along.begin(), along.end());
    longest = std::ceil(0.8 * longest);
  }
  for (int a = 0; a < dimension; ++a) {
    grid.count[a] = static_cast<std::int64_t>(along[a]);
    // What near() asks of the largest block, and where points have no cell of their own.
    double const largest = (2 + largest_block[a]) * reach * grid.inverse_edge[a] + 3;
    grid.by_number[a] = along[a] < largest || grid.folds(a, extent.low[a], extent.high[a]);
  }
  return grid;
}

Cells::Cells(Grid const& grid, double const* rows, std::size_t stride, std::size_t count, double reach, int threads)
    : grid_(grid), reach_(reach) {
  start_.assign(grid_.cells() + 2, 0);
  items_.resize(count);
  auto const cell = cells_of(grid_, rows, stride, count, threads);
  for (std::size_t i = 0; i < count; ++i) ++start_[cell[i] + 2];
  std::uint32_t before = 0;
  for (auto& start : start_) start = before += start;
  // start_[c + 1] runs through the places of cell c, and ends where cell c + 1 begins.
  for (std::size_t i = 0; i < count; ++i) items_[start_[cell[i] + 1]++] = static_cast<std::uint32_t>(i);
  start_.pop_back();
}

}  // namespace boltzmann
