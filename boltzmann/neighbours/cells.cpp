// Counting sort of points into cells.
#include <boltzmann/neighbours/cells.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann {
namespace {

// Edges of a cell in units of the reach. Long runs along the first axis can be cut precisely; along the others, rows of
// cells that are out of reach are excluded.
constexpr double first_edge = 0.25, other_edge = 0.5;

}  // namespace

std::vector<std::uint32_t> cells_of(Grid const& grid, double const* rows, std::size_t stride, std::size_t count,
                                    int threads) {
  std::vector<std::uint32_t> cell(count);
  find_cells(
      grid, count, [=](std::size_t i) { return rows + i * stride; }, cell.data(), threads);
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
  // Not many more cells than points: those of distant particles are folded onto the others.
  double const most = std::min(4.0 * static_cast<double>(count) + 64, 4e9);  // numbers have 32 bits
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
    // The largest number of cells that near() needs for the largest block; points beyond have no cell of their own.
    double const largest = (2 + largest_block[a]) * reach * grid.inverse_edge[a] + 3;
    bool const folds = grid.folds(a, extent.low[a], extent.high[a]);
    grid.by_number[a] = along[a] < largest || folds;
    grid.is_folded = grid.is_folded || folds;
    grid.lowest[a] = grid.along(a, extent.low[a]);
  }
  return grid;
}

Cells::Cells(Grid const& grid, std::span<std::uint32_t const> cell_of_point, double reach)
    : grid_(grid),
      reach_(reach),
      start_(std::make_unique_for_overwrite<std::uint32_t[]>(grid.cells() + 2)),
      items_(cell_of_point.size()) {
  auto const along = static_cast<std::uint32_t>(grid.count[0]);
  std::vector<char> used(grid.cells() / along);  // lines of cells; on a rank with part of all points most are empty
  for (auto const cell : cell_of_point) used[cell / along] = 1;
  // First start[c] is the number of points in cell c, then its end.
  std::uint32_t *const start = start_.get() + 2, *line = start;
  start_[0] = start_[1] = 0;
  for (char const any : used) {
    if (any) std::fill_n(line, along, 0U);
    line += along;
  }
  for (auto const cell : cell_of_point) ++start[cell];
  line = start;
  for (std::uint32_t before = 0; char const any : used) {
    if (any)
      for (std::uint32_t c = 0; c < along; ++c) line[c] = before += line[c];
    else
      std::fill_n(line, along, before);
    line += along;
  }
  // start_[c + 1] runs through cell c, and ends at the beginning of cell c + 1.
  for (std::uint32_t i = 0; auto const cell : cell_of_point) items_[start_[cell + 1]++] = i++;
}

bool Cells::tell_cells_in(Grid const& other) const {
  return !grid_.is_folded && std::ranges::equal(grid_.edge, other.edge);
}

void Cells::cells_in(Grid const& other, std::uint32_t* cell_of_item) const {
  auto const along = static_cast<std::size_t>(grid_.count[0]);
  std::vector<std::uint32_t> place(along);  // of each cell of a line, in a line of the other grid
  for (std::size_t c = 0; c < along; ++c)
    place[c] = static_cast<std::uint32_t>(other.folded(0, grid_.unfolded(0, static_cast<std::int64_t>(c))));
  std::uint32_t const* start = start_.get();
  for (std::int64_t k = 0; k < grid_.count[2]; ++k)
    for (std::int64_t j = 0; j < grid_.count[1]; ++j, start += along) {
      if (start[0] == start[along]) continue;
      std::int64_t const line =
          other.folded(2, grid_.unfolded(2, k)) * other.count[1] + other.folded(1, grid_.unfolded(1, j));
      auto const begin = static_cast<std::uint32_t>(line * other.count[0]);
      for (std::size_t c = 0; c < along; ++c)
        for (std::uint32_t n = start[c]; n < start[c + 1]; ++n) cell_of_item[n] = begin + place[c];
    }
}

}  // namespace boltzmann
