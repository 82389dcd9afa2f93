// Sums what a law returns, for W particles at once. Each particle has a lane of its own, so nothing is added across
// lanes.
#pragma once

#include <boltzmann/schemes/pair/pair_sum.hpp>

namespace boltzmann {

namespace detail {

template <int W>
[[gnu::always_inline]] inline Pack<double, W> lanes_from(double first) {
  Pack<double, W> lanes;
  for (int lane = 0; lane < W; ++lane) lanes.native[lane] = first + lane;
  return lanes;
}

template <int W>
[[gnu::always_inline]] inline Mask<double, W> every_lane() {
  return {typename Mask<double, W>::Native{} - 1};
}

/// Broadcasts a number in a way that is opaque to the compiler. Loads broadcast at no cost. Otherwise the compiler
/// would compute scalar expressions of a source's numbers first and broadcast the results, which needs extra shuffles.
template <class Real>
[[gnu::always_inline]] inline Real spread(auto number) {
  Real pack = number;
#if defined(__SSE2__)
  if constexpr (sizeof(pack.native) <= register_bytes) asm("" : "+v"(pack.native));
#endif
  return pack;
}

/// A source in every lane, with its numbers from `row`.
template <class Q, class Real>
[[gnu::always_inline]] inline rebind_t<Q, Real> spread_row(auto const* row) {
  std::array<Real, row_doubles<Q>> columns;
  for (std::size_t k = 0; k < row_doubles<Q>; ++k) columns[k] = spread<Real>(row[k]);
  return std::bit_cast<rebind_t<Q, Real>>(columns);
}

/// Sums what a law returns over the partners of W particles.
template <Pass pass, int W, class P, class Q, class Law>
class LaneSum {
 public:
  using One = Sum<pass, W, P, Q, Law>;
  using Real = typename One::Real;
  static constexpr std::size_t components = One::components;
  static constexpr int D = P::dimension;

  LaneSum() {
    for (auto& x : influence_) x = Real(0.0);
    for (auto& x : virial_) x = Real(0.0);
  }

  [[gnu::always_inline]] void add(Law const& law, typename One::Target const& p, typename One::Source const& q,
                                  Mask<double, W> valid) {
    auto const result = law(p, q);
    auto const influence = as_array<Real>(influence_of(result));
    Real const zero = 0.0;
    if constexpr (pass != Pass::measure) {
      for (std::size_t c = 0; c < components; ++c) influence_[c] += select(valid, influence[c], zero);
      if constexpr (pass == Pass::with_energy) energy_ += select(valid, result.energy, zero);
    } else {
      if constexpr (has_energy<typename One::Result>) energy_ += select(valid, result.energy, zero);
      if constexpr (std::is_same_v<typename One::Influence, Vector<D, Real>>) {
        auto const r = q.position - p.position;
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b) virial_[a * D + b] += select(valid, r[a] * influence[b], zero);
      }
    }
  }

  /// Stores the sums of the particles among first, first + 1, ... (lanes 0, 1, ...) that are in [begin, end).
  /// Influences are stored or added; all else is added.
  [[gnu::always_inline]] void store(PairTask const& task, std::size_t first, std::size_t begin, std::size_t end,
                                    bool overwrite) const {
    std::size_t const from = begin > first ? begin : first, to = end < first + W ? end : first + W;
    if constexpr (pass == Pass::measure || pass == Pass::with_energy) {
      auto const energy = as_array<double>(energy_);
      for (std::size_t i = from; i < to; ++i) task.energy[i] += 0.5 * energy[i - first];
    }
    if constexpr (pass == Pass::measure) {
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) {
          auto const virial = as_array<double>(virial_[a * D + b]);
          for (std::size_t i = from; i < to; ++i) task.virial[9 * i + 3 * a + b] -= 0.5 * virial[i - first];
        }
    } else {
      for (std::size_t c = 0; c < components; ++c) {
        // a copy, so that lanes are selected in memory, not in registers
        auto const influence = as_array<double>(influence_[c]);
        for (std::size_t i = from; i < to; ++i) {
          double& total = task.influence[i * components + c];
          total = overwrite ? influence[i - first] : total + influence[i - first];
        }
      }
    }
  }

 private:
  Real influence_[components];
  Real energy_ = Real(0.0);
  Real virial_[D * D];
};

/// The particles first, first + 1, ... as one particle of packs. Past the end, the last particle is repeated.
template <class P, int W>
[[gnu::always_inline]] inline rebind_t<P, Pack<double, W>> load_neighbouring_rows(double const* rows,
                                                                                  std::size_t stride, std::size_t first,
                                                                                  std::size_t size) {
  return load_rows<P, W>([&](int lane) {
    std::size_t const i = first + lane;
    return rows + (i < size ? i : size - 1) * stride;
  });
}

}  // namespace detail

}  // namespace boltzmann
