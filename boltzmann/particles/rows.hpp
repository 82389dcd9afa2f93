// Rows: the memory layout of particles, and loading W of them as one particle of packs.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/core/vector.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace boltzmann {

/// A particle in memory: your own struct, padded to 32 bytes.
template <class P>
struct alignas(32) Row : P {};

/// Doubles from one row of a class to the next.
template <class P>
inline constexpr std::size_t row_stride = sizeof(Row<P>) / sizeof(double);

/// Doubles of a class without padding.
template <class P>
inline constexpr std::size_t row_doubles = sizeof(P) / sizeof(double);

namespace detail {
template <class P, class Real>
struct rebind {
  static_assert(sizeof(P) == 0,
                "a particle class is a template on its kind of number, in which it is a double or a pack of them: "
                "template <class Real = double> struct Ion : Newton<2, Real> { Real age; ... };");
  using type = P;
};
template <template <class> class P, class Old, class Real>
struct rebind<P<Old>, Real> {
  using type = P<Real>;
};
template <template <int, class> class P, int D, class Old, class Real>
struct rebind<P<D, Old>, Real> {
  using type = P<D, Real>;
};
}  // namespace detail

/// The same particle class (or influence) for another kind of number: rebind_t<Newton<3, double>, Pack<double>> is
/// Newton<3, Pack<double>>.
template <class P, class Real>
using rebind_t = typename detail::rebind<P, Real>::type;

namespace detail {
/// A substitute for Real that reveals members of other types: any other member changes the alignment, or makes the size
/// no multiple.
struct OddReal {
  char bytes[67];
};
}  // namespace detail

/// True if a class (or influence) has only members of Real and Vector<D, Real>: an int would be read as a double, and a
/// plain double could not be packed.
template <class P>
constexpr bool holds_only_reals() {
  using Odd = rebind_t<P, detail::OddReal>;
  return std::is_trivially_copyable_v<P> && alignof(Odd) == 1 &&
         sizeof(Odd) == row_doubles<P> * sizeof(detail::OddReal);
}

/// Doubles of a block: rows consist of blocks, which are contiguous, or each in an array of its own.
inline constexpr std::size_t row_block = 4;

/// One particle, the same in every lane; `stride` doubles from one block of the row to the next.
template <class P, class Real = Pack<double>>
[[gnu::always_inline]] inline rebind_t<P, Real> broadcast(double const* row, std::size_t stride = row_block) {
  using Packed = rebind_t<P, Real>;
  static_assert(holds_only_reals<P>(), "a particle class holds nothing but Real and Vector<D, Real>");
  std::array<Real, row_doubles<P>> columns;
  for (std::size_t k = 0; k < row_doubles<P>; ++k) columns[k] = row[k / row_block * stride + k % row_block];
  return std::bit_cast<Packed>(columns);
}

namespace detail {

typedef double Quad __attribute__((vector_size(32), may_alias));
typedef double Pair __attribute__((vector_size(16), may_alias));

/// Columns 4b..4b+3 of the W rows that `row(lane)` points to, transposed in registers.
template <int W, class RowOf>
[[gnu::always_inline]] inline void transpose_block(RowOf row, std::size_t offset, Pack<double, W>* columns,
                                                   std::size_t count) {
  if constexpr (W == 8) {
    typedef double Octet __attribute__((vector_size(64)));
    auto const pair = [&](int a, int b) {
      Quad const low = *reinterpret_cast<Quad const*>(row(a) + offset);
      Quad const high = *reinterpret_cast<Quad const*>(row(b) + offset);
      return Octet(__builtin_shufflevector(low, high, 0, 1, 2, 3, 4, 5, 6, 7));
    };
    Octet const a = pair(0, 4), b = pair(1, 5), c = pair(2, 6), d = pair(3, 7);
    Octet const ab0 = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
    Octet const cd0 = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
    Octet const ab1 = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
    Octet const cd1 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
    columns[0] = Octet(__builtin_shufflevector(ab0, cd0, 0, 1, 8, 9, 4, 5, 12, 13));
    if (count > 1) columns[1] = Octet(__builtin_shufflevector(ab1, cd1, 0, 1, 8, 9, 4, 5, 12, 13));
    if (count > 2) columns[2] = Octet(__builtin_shufflevector(ab0, cd0, 2, 3, 10, 11, 6, 7, 14, 15));
    if (count > 3) columns[3] = Octet(__builtin_shufflevector(ab1, cd1, 2, 3, 10, 11, 6, 7, 14, 15));
  } else if constexpr (W == 4) {
    auto const load = [&](int lane) { return *reinterpret_cast<Quad const*>(row(lane) + offset); };
    Quad const a = load(0), b = load(1), c = load(2), d = load(3);
    Quad const ab0 = __builtin_shufflevector(a, b, 0, 4, 2, 6), cd0 = __builtin_shufflevector(c, d, 0, 4, 2, 6);
    Quad const ab1 = __builtin_shufflevector(a, b, 1, 5, 3, 7), cd1 = __builtin_shufflevector(c, d, 1, 5, 3, 7);
    columns[0] = __builtin_shufflevector(ab0, cd0, 0, 1, 4, 5);
    if (count > 1) columns[1] = __builtin_shufflevector(ab1, cd1, 0, 1, 4, 5);
    if (count > 2) columns[2] = __builtin_shufflevector(ab0, cd0, 2, 3, 6, 7);
    if (count > 3) columns[3] = __builtin_shufflevector(ab1, cd1, 2, 3, 6, 7);
  } else if constexpr (W == 2) {
    for (std::size_t half = 0; half < 4 && half < count; half += 2) {
      Pair const a = *reinterpret_cast<Pair const*>(row(0) + offset + half);
      Pair const b = *reinterpret_cast<Pair const*>(row(1) + offset + half);
      columns[half] = __builtin_shufflevector(a, b, 0, 2);
      if (half + 1 < count) columns[half + 1] = __builtin_shufflevector(a, b, 1, 3);
    }
  } else {
    for (std::size_t k = 0; k < 4 && k < count; ++k)
      for (int lane = 0; lane < W; ++lane) columns[k].native[lane] = row(lane)[offset + k];
  }
}

}  // namespace detail

/// W particles as one particle of packs; `row(lane)` points to a row (32-byte aligned), `stride` doubles from one block
/// of the row to the next. Fields that are not used cost nothing.
template <class P, int W = native_width<double>, class RowOf>
[[gnu::always_inline]] inline rebind_t<P, Pack<double, W>> load_rows(RowOf row, std::size_t stride = row_block) {
  using Packed = rebind_t<P, Pack<double, W>>;
  static_assert(holds_only_reals<P>(), "a particle class holds nothing but Real and Vector<D, Real>");
  std::array<Pack<double, W>, row_doubles<P>> columns;
  [&]<std::size_t... Block>(std::index_sequence<Block...>) {
    (detail::transpose_block<W>(row, stride * Block, columns.data() + row_block * Block,
                                row_doubles<P> - row_block * Block),
     ...);
  }
  (std::make_index_sequence<(row_doubles<P> + row_block - 1) / row_block>{});
  return std::bit_cast<Packed>(columns);
}

}  // namespace boltzmann
