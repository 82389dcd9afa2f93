// The traversal of all pairs in single precision: twice as many lanes, each of them a target.
#pragma once

#include <boltzmann/schemes/pair/lane_sum.hpp>

namespace boltzmann {

namespace detail {

/// The number of sources summed in single precision before they are added to the total in double precision.
inline constexpr std::size_t single_group = 256;
/// The number of target packs that share one load of a source.
template <int W>
inline constexpr int single_packs = W == 8   ? 4
                                    : W == 4 ? 2
                                             : 1;

/// The number of components of a row that are rounded: whole blocks, as in rows.
template <class P>
inline constexpr std::size_t rounded_numbers = (row_doubles<P> + row_block - 1) / row_block* row_block;

/// Subtracted from the components of a row before they are rounded: the position of an origin.
template <class P>
struct Origin {
  alignas(64) double number[rounded_numbers<P>] = {};
  [[gnu::always_inline]] explicit Origin(double const* row) {
    for (int a = 0; a < P::dimension; ++a) number[a] = row[a];
  }
};

/// A row in single precision, with positions relative to an origin; four numbers at once.
template <class P>
[[gnu::always_inline]] inline void round_row(double const* row, Origin<P> const& origin, float* rounded) {
  typedef float Single __attribute__((vector_size(4 * sizeof(float)), aligned(4), may_alias));
  typedef Quad Anywhere __attribute__((aligned(8)));  // rows of images beyond walls are not aligned as in ensembles
  for (std::size_t k = 0; k < rounded_numbers<P>; k += row_block) {
    Quad const numbers =
        *reinterpret_cast<Anywhere const*>(row + k) - *reinterpret_cast<Quad const*>(origin.number + k);
    *reinterpret_cast<Single*>(rounded + k) = __builtin_convertvector(numbers, Single);
  }
}

/// The particles first, first + 1, ... as one particle of packs. Past the end, the last particle is repeated.
template <class P, int lanes>
[[gnu::always_inline]] inline rebind_t<P, Pack<float, lanes>> load_rounded_rows(double const* rows, std::size_t stride,
                                                                                std::size_t first, std::size_t size,
                                                                                Origin<P> const& origin) {
  std::array<Pack<float, lanes>, row_doubles<P>> columns;
  for (int lane = 0; lane < lanes; ++lane) {
    std::size_t const i = first + static_cast<std::size_t>(lane);
    float row[rounded_numbers<P>];
    round_row<P>(rows + (i < size ? i : size - 1) * stride, origin, row);
    for (std::size_t k = 0; k < row_doubles<P>; ++k) columns[k].native[lane] = row[k];
  }
  return std::bit_cast<rebind_t<P, Pack<float, lanes>>>(columns);
}

/// The influences on some packs of targets. Unrolled, so that they stay in registers.
template <int packs, std::size_t components, class Real>
struct SingleSums {
  Real of[packs][components];

  [[gnu::always_inline]] SingleSums() {
    for_each([&](int t, std::size_t c) { of[t][c] = Real(0.0F); });
  }
  [[gnu::always_inline]] static void for_each(auto const& f) {
#pragma GCC unroll 4
    for (int t = 0; t < packs; ++t)
#pragma GCC unroll 6
      for (std::size_t c = 0; c < components; ++c) f(t, c);
  }
  /// Adds influence_on(t) to pack t.
  [[gnu::always_inline]] void add(auto const& influence_on) {
#pragma GCC unroll 4
    for (int t = 0; t < packs; ++t) {
      auto const influence = influence_on(t);
#pragma GCC unroll 6
      for (std::size_t c = 0; c < components; ++c) of[t][c] += influence[c];
    }
  }
};

/// Some adjacent targets, and the influences of all sources on them.
template <int W, class P, class Q, class Law>
struct SingleBlock {
  static constexpr int lanes = 2 * W, packs = single_packs<W>;
  static constexpr std::size_t size = packs * lanes;
  static constexpr std::size_t components = sizeof(typename P::Influence) / sizeof(double);
  using Real = Pack<float, lanes>;

  std::size_t first;
  rebind_t<P, Real> p[packs];
  double total[components][size];

  /// Loads the targets first, first + 1, ..., with positions relative to the origin.
  [[gnu::always_inline]] void load(PairTask const& task, std::size_t stride, std::size_t from,
                                   Origin<P> const& origin) {
    first = from;
    for (int t = 0; t < packs; ++t)
      p[t] = load_rounded_rows<P, lanes>(task.target, stride, first + static_cast<std::size_t>(t * lanes), task.targets,
                                         origin);
    for (auto& of_component : total)
      for (auto& x : of_component) x = 0;
  }

  /// Adds the influences of a group of sources, from number `from` on: summed in single precision and added to the
  /// total. If targets are sources, self-interaction is excluded.
  [[gnu::always_inline]] void add(Law const& law, float const (*source)[rounded_numbers<Q>], std::size_t from,
                                  std::size_t count, bool same) {
    SingleSums<packs, components, Real> sum;
    auto const influence = [&](int t, auto const& q) { return as_array<Real>(influence_of(law(p[t], q))); };
    auto const plain = [&](std::size_t begin, std::size_t end) {
      for (std::size_t k = begin; k < end; ++k) {
        auto const q = spread_row<Q, Real>(source[k]);
        sum.add([&](int t) { return influence(t, q); });
      }
    };
    // The block's own particles, [own, own_end) of the group if it includes them, are masked against themselves.
    bool const meets = same && first < from + count && from < first + size;
    std::size_t const own = !meets ? count : first > from ? first - from : 0;
    std::size_t const behind = first + size - from, own_end = !meets || behind > count ? count : behind;
    plain(0, own);
    for (std::size_t k = own; k < own_end; ++k) {
      auto const q = spread_row<Q, Real>(source[k]);
      // The index in the block: a small number, exact in single precision.
      auto const self = static_cast<float>(static_cast<std::ptrdiff_t>(from + k) - static_cast<std::ptrdiff_t>(first));
      sum.add([&](int t) {
        auto const other = lane_numbers() != self - static_cast<float>(t * lanes);
        auto of_pack = influence(t, q);
        for (auto& x : of_pack) x = select(other, x, Real(0.0F));
        return of_pack;
      });
    }
    plain(own_end, count);
    sum.for_each([&](int t, std::size_t c) {
      auto const of_lanes = as_array<float>(sum.of[t][c]);
      for (std::size_t lane = 0; lane < lanes; ++lane)
        total[c][static_cast<std::size_t>(t * lanes) + lane] += static_cast<double>(of_lanes[lane]);
    });
  }

  /// Stores the totals of the particles of [begin, end).
  [[gnu::always_inline]] void store(PairTask const& task, std::size_t begin, std::size_t end) const {
    for (std::size_t i = first > begin ? first : begin; i < end && i < first + size; ++i)
      for (std::size_t c = 0; c < components; ++c) {
        double& influence = task.influence[i * components + c];
        influence = task.overwrite ? total[c][i - first] : influence + total[c][i - first];
      }
  }

 private:
  static Real lane_numbers() {
    Real numbers;
    for (int lane = 0; lane < lanes; ++lane) numbers.native[lane] = static_cast<float>(lane);
    return numbers;
  }
};

/// The number of targets for which sources are rounded once.
inline constexpr std::size_t single_targets = 128;

/// Every target sums the sources in their order, in groups. Positions are rounded once for some blocks, relative to the
/// first target of these, so that differences of nearby positions are accurate. Blocks begin at multiples of their
/// size, and the result has the same bits for every division into ranges.
template <int W, class P, class Q, class Law>
[[gnu::flatten]] void over_all_single(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using Block = SingleBlock<W, P, Q, Law>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  std::size_t const target_stride = stride_of<P, Law>(task.target_row_stride);
  std::size_t const source_stride = stride_of<Q, Law>(task.source_row_stride);
  for (std::size_t all = begin / single_targets * single_targets; all < end; all += single_targets) {
    Origin<P> const of_targets(task.target + all * target_stride);
    Origin<Q> const of_sources(task.target + all * target_stride);
    Block block[single_targets / Block::size];
    std::size_t blocks = 0;
    for (std::size_t first = all; first < all + single_targets && first < end; first += Block::size)
      if (begin < first + Block::size) block[blocks++].load(task, target_stride, first, of_targets);
    for (std::size_t from = 0; from < task.sources; from += single_group) {
      std::size_t const count = task.sources - from < single_group ? task.sources - from : single_group;
      alignas(64) float source[single_group][rounded_numbers<Q>];
      for (std::size_t k = 0; k < count; ++k)
        round_row<Q>(task.source + (from + k) * source_stride, of_sources, source[k]);
      for (std::size_t b = 0; b < blocks; ++b) block[b].add(law, source, from, count, task.same);
    }
    for (std::size_t b = 0; b < blocks; ++b) block[b].store(task, begin, end);
  }
}

}  // namespace detail

}  // namespace boltzmann
