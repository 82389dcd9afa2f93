// Limits tables to the number of rows that a page can draw.
#include <boltzmann/window/source.hpp>

namespace boltzmann {

void ShownTable::add(std::vector<double> const& row) {
  columns = row.size();
  values.insert(values.end(), row.begin(), row.end());
  if (rows() < most) return;
  std::vector<double> fewer;
  for (std::size_t r = 0; r < rows(); r += 2)
    fewer.insert(fewer.end(), values.begin() + static_cast<std::ptrdiff_t>(r * columns),
                 values.begin() + static_cast<std::ptrdiff_t>((r + 1) * columns));
  values = std::move(fewer);
  ++number;
}

}  // namespace boltzmann
