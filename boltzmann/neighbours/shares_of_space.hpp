// The decomposition of space over the ranks of a team: layers, or columns, which need fewer ghosts on many ranks.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// The work per particle besides its list entries, in units of one entry.
inline constexpr std::int64_t work_of_a_row = 12;

/// Lines of cells side by side, as a plane that they cross perpendicularly: number `first + count[0] * second`.
struct PlaneOfLines {
  std::int64_t count[2] = {1, 1};
  double edge[2] = {1, 1};  ///< distance of lines
  std::size_t lines() const { return static_cast<std::size_t>(count[0] * count[1]); }
};

/// The environment variable BOLTZMANN_SHARES, for comparisons: 'layers' or 'columns'; Error for any other value.
enum class SharesOfSpace { chosen, layers, columns };
SharesOfSpace said_shares();

/// The number of layers along the second axis for which ranks need the fewest ghosts. Each layer is cut into columns
/// along the first axis, and ranks read what is within `reach` of their own part. Returns as many layers as ranks if
/// columns leave more than `worth` of the ghosts of layers. said_shares() overrides the choice.
int layers_for(PlaneOfLines const& plane, double reach, int ranks, double worth);

/// The owner of each line: this number of layers, each in columns, with equal work for each rank as far as whole lines
/// allow. `order` has the places along each axis in spatial order, `work` the work of each line.
std::vector<std::uint16_t> columns_of(PlaneOfLines const& plane, std::vector<std::int64_t> const (&order)[2],
                                      std::vector<std::int64_t> const& work, int layers, int ranks);

}  // namespace boltzmann
