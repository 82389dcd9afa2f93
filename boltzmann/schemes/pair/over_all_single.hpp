// The traversal of all pairs in single precision: twice as many lanes, each of them a target.
#pragma once

#include <boltzmann/schemes/pair/lane_sum.hpp>

namespace boltzmann {

namespace detail {

/// Sources that are summed in single precision before they are added to the total in double.
inline constexpr std::size_t single_group = 256;
/// Packs of targets that share one load of a source.
template <int W>
inline constexpr int single_packs = W == 8   ? 4
                                    : W == 4 ? 2
                                             : 1;

/// A row in single precision, places relative to `origin`.
template <class P>
[[gnu::always_inline]] inline void round_row(double const* row, double const* origin, float* rounded) {
  for (std::size_t k = 0; k < row_doubles<P>; ++k)
    rounded[k] = static_cast<float>(k < P::dimension ? row[k] - origin[k] : row[k]);
}

/// The particles first, first + 1, ... as one particle of packs; past the last one, that one again.
template <class P, int lanes>
[[gnu::always_inline]] inline rebind_t<P, Pack<float, lanes>> load_rounded_rows(double const* rows, std::size_t stride,
                                                                                std::size_t first, std::size_t size,
                                                                                double const* origin) {
  std::array<Pack<float, lanes>, row_doubles<P>> columns;
  for (int lane = 0; lane < lanes; ++lane) {
    std::size_t const i = first + static_cast<std::size_t>(lane);
    float row[row_doubles<P>];
    round_row<P>(rows + (i < size ? i : size - 1) * stride, origin, row);
    for (std::size_t k = 0; k < row_doubles<P>; ++k) columns[k].native[lane] = row[k];
  }
  return std::bit_cast<rebind_t<P, Pack<float, lanes>>>(columns);
}

/// Some targets side by side, what they feel from a group of sources in single precision, and from all in double.
template <int W, class P, class Q, class Law>
struct SingleBlock {
  static constexpr int lanes = 2 * W, packs = single_packs<W>;
  static constexpr std::size_t size = packs * lanes;
  static constexpr std::size_t components = sizeof(typename P::Influence) / sizeof(double);
  using Real = Pack<float, lanes>;

  rebind_t<P, Real> p[packs];
  Real sum[packs][components];
  double total[components][size] = {};

  [[gnu::always_inline]] void clear() {
    for (auto& of_pack : sum)
      for (auto& x : of_pack) x = Real(0.0F);
  }
  /// What a source does to all of them; of pack t only where masked(t, x) leaves it.
  template <class Masked>
  [[gnu::always_inline]] void add(Law const& law, float const* source, Masked const& masked) {
    std::array<Real, row_doubles<Q>> columns;
    for (std::size_t c = 0; c < row_doubles<Q>; ++c) columns[c] = source[c];
    auto const q = std::bit_cast<rebind_t<Q, Real>>(columns);
    for (int t = 0; t < packs; ++t) {
      auto const influence = as_array<Real>(influence_of(law(p[t], q)));
      for (std::size_t c = 0; c < components; ++c) sum[t][c] += masked(t, influence[c]);
    }
  }
  [[gnu::always_inline]] void add_to_total() {
    for (int t = 0; t < packs; ++t)
      for (std::size_t c = 0; c < components; ++c) {
        auto const of_lanes = as_array<float>(sum[t][c]);
        for (std::size_t lane = 0; lane < lanes; ++lane)
          total[c][static_cast<std::size_t>(t * lanes) + lane] += static_cast<double>(of_lanes[lane]);
      }
  }
  /// Gives the totals to the particles of [begin, end) among those from `first` on.
  [[gnu::always_inline]] void store(PairTask const& task, std::size_t first, std::size_t begin, std::size_t end) const {
    for (std::size_t i = first > begin ? first : begin; i < end && i < first + size; ++i)
      for (std::size_t c = 0; c < components; ++c) {
        double& influence = task.influence[i * components + c];
        influence = task.overwrite ? total[c][i - first] : influence + total[c][i - first];
      }
  }
};

/// Every target sums the sources in their order, in groups. Places are rounded relative to the first target of a block,
/// so that the differences of what is near each other are right; blocks begin at multiples of their size, and the result
/// has the same bits for every division into ranges.
template <int W, class P, class Q, class Law>
[[gnu::flatten]] void over_all_single(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using Block = SingleBlock<W, P, Q, Law>;
  using Real = typename Block::Real;
  Held<Law> law = *static_cast<Law const*>(the_law);
  std::size_t const target_stride = stride_of<P, Law>(task.target_row_stride);
  std::size_t const source_stride = stride_of<Q, Law>(task.source_row_stride);
  Real lane_number;
  for (int lane = 0; lane < Block::lanes; ++lane) lane_number.native[lane] = static_cast<float>(lane);
  for (std::size_t first = begin / Block::size * Block::size; first < end; first += Block::size) {
    double const* const origin = task.target + first * target_stride;
    Block block;
    for (int t = 0; t < Block::packs; ++t)
      block.p[t] = load_rounded_rows<P, Block::lanes>(
          task.target, target_stride, first + static_cast<std::size_t>(t * Block::lanes), task.targets, origin);
    for (std::size_t from = 0; from < task.sources; from += single_group) {
      std::size_t const count = task.sources - from < single_group ? task.sources - from : single_group;
      alignas(64) float source[single_group][row_doubles<Q>];
      for (std::size_t k = 0; k < count; ++k) round_row<Q>(task.source + (from + k) * source_stride, origin, source[k]);
      block.clear();
      // The block's own particles, [own, own_end) of the group if they are in it, are masked where they meet themselves.
      bool const meets = task.same && first < from + count && from < first + Block::size;
      std::size_t const own = !meets ? count : first > from ? first - from : 0;
      std::size_t const behind = first + Block::size - from, own_end = !meets || behind > count ? count : behind;
      auto const plain = [](int, Real const& x) { return x; };
      for (std::size_t k = 0; k < own; ++k) block.add(law, source[k], plain);
      for (std::size_t k = own; k < own_end; ++k) {
        // its number in the block: a small number, exact in single precision
        auto const self =
            static_cast<float>(static_cast<std::ptrdiff_t>(from + k) - static_cast<std::ptrdiff_t>(first));
        block.add(law, source[k], [&](int t, Real const& x) {
          return select(lane_number != self - static_cast<float>(t * Block::lanes), x, Real(0.0F));
        });
      }
      for (std::size_t k = own_end; k < count; ++k) block.add(law, source[k], plain);
      block.add_to_total();
    }
    block.store(task, first, begin, end);
  }
}

}  // namespace detail

}  // namespace boltzmann
