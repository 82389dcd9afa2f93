// How space is shared out among the ranks of a team: in layers, or in columns, which many ranks have less around.
#pragma once

#include <cstddef>
#include <cstdint>
#include <vector>

namespace boltzmann {

/// What is done for a particle besides what each entry of its lists takes, in such entries.
inline constexpr std::int64_t work_of_a_row = 12;

/// Lines of cells side by side, as a plane sees them that they pass through: number `first + count[0] * second`.
struct PlaneOfLines {
  std::int64_t count[2] = {1, 1};
  double edge[2] = {1, 1};  ///< how far apart lines are
  std::size_t lines() const { return static_cast<std::size_t>(count[0] * count[1]); }
};

/// What the environment variable BOLTZMANN_SHARES says, for those who compare: 'layers' or 'columns'; Error if it says
/// something else.
enum class SharesOfSpace { chosen, layers, columns };
SharesOfSpace said_shares();

/// In how many layers along the second axis ranks have least to know of others, if each layer is cut into columns along
/// the first one and everybody reads what is no further than `reach` from its own; as many layers as ranks where
/// columns leave more than `worth` of what is known in layers. Or what said_shares() has.
int layers_for(PlaneOfLines const& plane, double reach, int ranks, double worth);

/// Who gets each line: so many layers, each in columns, with as much work for each rank as whole lines allow. `order` has
/// the places along each axis in the order of space, `work` that of each line.
std::vector<std::uint16_t> columns_of(PlaneOfLines const& plane, std::vector<std::int64_t> const (&order)[2],
                                      std::vector<std::int64_t> const& work, int layers, int ranks);

}  // namespace boltzmann
