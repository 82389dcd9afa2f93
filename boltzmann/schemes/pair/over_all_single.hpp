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

/// Every target sums the sources in their order, in groups. Places are rounded relative to the first target of a block,
/// so that the differences of what is near each other are right; blocks begin at multiples of their size, and the result
/// has the same bits for every division into ranges.
template <int W, class P, class Q, class Law>
[[gnu::flatten]] void over_all_single(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  constexpr int lanes = 2 * W, packs = single_packs<W>;
  constexpr std::size_t block = packs * lanes;
  constexpr std::size_t components = sizeof(typename P::Influence) / sizeof(double);
  using Real = Pack<float, lanes>;
  using Target = rebind_t<P, Real>;
  using Source = rebind_t<Q, Real>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  std::size_t const target_stride = stride_of<P, Law>(task.target_row_stride);
  std::size_t const source_stride = stride_of<Q, Law>(task.source_row_stride);
  Real lane_number;
  for (int lane = 0; lane < lanes; ++lane) lane_number.native[lane] = static_cast<float>(lane);
  for (std::size_t first = begin / block * block; first < end; first += block) {
    double const* const origin = task.target + first * target_stride;
    Target p[packs];
    for (int t = 0; t < packs; ++t) {
      std::array<Real, row_doubles<P>> columns;
      for (int lane = 0; lane < lanes; ++lane) {
        std::size_t const i = first + static_cast<std::size_t>(t * lanes + lane);
        float row[row_doubles<P>];
        round_row<P>(task.target + (i < task.targets ? i : task.targets - 1) * target_stride, origin, row);
        for (std::size_t k = 0; k < row_doubles<P>; ++k) columns[k].native[lane] = row[k];
      }
      p[t] = std::bit_cast<Target>(columns);
    }
    double total[components][block] = {};
    for (std::size_t from = 0; from < task.sources; from += single_group) {
      std::size_t const count = task.sources - from < single_group ? task.sources - from : single_group;
      alignas(64) float source[single_group][row_doubles<Q>];
      for (std::size_t k = 0; k < count; ++k) round_row<Q>(task.source + (from + k) * source_stride, origin, source[k]);
      Real sum[packs][components];
      for (auto& of_pack : sum)
        for (auto& x : of_pack) x = Real(0.0F);
      auto const add = [&](std::size_t k, auto const& masked) {
        std::array<Real, row_doubles<Q>> columns;
        for (std::size_t c = 0; c < row_doubles<Q>; ++c) columns[c] = source[k][c];
        auto const q = std::bit_cast<Source>(columns);
        for (int t = 0; t < packs; ++t) {
          auto const influence = as_array<Real>(influence_of(law(p[t], q)));
          for (std::size_t c = 0; c < components; ++c) sum[t][c] += masked(t, influence[c]);
        }
      };
      // The block's own particles are masked; before and behind them nobody is.
      std::size_t const last = from + count;
      std::size_t const own = task.same && first < last ? (first > from ? first - from : 0) : count;
      std::size_t const own_end = task.same && first + block < last ? first + block : last;
      auto const plain = [](int, Real const& x) { return x; };
      for (std::size_t k = 0; k < own; ++k) add(k, plain);
      if (own < count && own_end > from) {
        for (std::size_t k = own; k < own_end - from; ++k) {
          // its number in the block: a small number, exact in single precision
          float const self =
              static_cast<float>(static_cast<std::ptrdiff_t>(from + k) - static_cast<std::ptrdiff_t>(first));
          add(k, [&](int t, Real const& x) {
            return select(lane_number != self - static_cast<float>(t * lanes), x, Real(0.0F));
          });
        }
        for (std::size_t k = own_end - from; k < count; ++k) add(k, plain);
      } else {
        for (std::size_t k = own; k < count; ++k) add(k, plain);
      }
      for (int t = 0; t < packs; ++t)
        for (std::size_t c = 0; c < components; ++c) {
          auto const of_lanes = as_array<float>(sum[t][c]);
          for (std::size_t lane = 0; lane < lanes; ++lane)
            total[c][static_cast<std::size_t>(t * lanes) + lane] += static_cast<double>(of_lanes[lane]);
        }
    }
    for (std::size_t i = first > begin ? first : begin; i < end && i < first + block; ++i)
      for (std::size_t c = 0; c < components; ++c) {
        double& influence = task.influence[i * components + c];
        influence = task.overwrite ? total[c][i - first] : influence + total[c][i - first];
      }
  }
}

}  // namespace detail

}  // namespace boltzmann
