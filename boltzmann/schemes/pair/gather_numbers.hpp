// Gathers numbers of W rows into packs. For kernel units.
#pragma once

#include <boltzmann/particles/rows.hpp>

#include <array>
#include <cstddef>
#include <utility>

namespace boltzmann::detail {

/// Calls put(n, pack) for numbers n from `first` to `first + count` of a block of the rows that row(lane) points to.
template <int W, std::size_t first, std::size_t count, class RowOf, class Put>
[[gnu::always_inline]] inline void gather_numbers(RowOf const& row, Put const& put) {
  if constexpr (count == 1) {  // a single gather
    Pack<double, W> number = 0.0;
    for (int lane = 0; lane < W; ++lane) number.native[lane] = row(lane)[first];
    put(first, number);
  } else {
    Pack<double, W> numbers[row_block];
    transpose_block<W>(row, 0, numbers, first + count);
    for (std::size_t n = first; n < first + count; ++n) put(n, numbers[n]);
  }
}

/// A table of functions, one for each range of a block: of<first, count>() is entry [first][count - 1]. Ranges beyond
/// the end of the block have none.
template <class Of>
constexpr auto for_stretches_of_a_block(Of of) {
  using Function = decltype(of.template operator()<0, 1>());
  std::array<std::array<Function, row_block>, row_block> table{};
  [&]<std::size_t... At>(std::index_sequence<At...>) {
    auto const set = [&]<std::size_t first, std::size_t count>() {
      if constexpr (first + count <= row_block) table[first][count - 1] = of.template operator()<first, count>();
    };
    (set.template operator()<At / row_block, At % row_block + 1>(), ...);
  }
  (std::make_index_sequence<row_block * row_block>{});
  return table;
}

}  // namespace boltzmann::detail
