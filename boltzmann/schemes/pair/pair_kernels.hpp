// The traversal of pairs, written once under every pair law: lists, all pairs, connections, and a scalar path for a
// handful of particles.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/particles/rows.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace boltzmann {

/// One law between two ensembles, as plain memory. Outputs are indexed by the target's particle number.
struct PairTask {
  double const* target = nullptr;  ///< rows of those that are influenced
  std::size_t targets = 0;
  std::uint32_t const* order = nullptr;  ///< row -> particle number; null: they are the same
  double const* source = nullptr;        ///< rows of those that influence
  std::size_t sources = 0;
  bool overwrite = false;              ///< the influence is stored, not added (the scalar path only)
  bool same = false;                   ///< target and source are one ensemble: nobody influences itself
  std::size_t const* start = nullptr;  ///< neighbour list (lists and connections)
  std::uint32_t const* index = nullptr;
  double cutoff2 = 0;                    ///< square of the cut-off (lists)
  double rounding = 0;                   ///< 3/2 2^52 times the quantum of the reversible form (lists)
  double zero_at = 0;                    ///< measuring: the distance at which energies are counted as zero; 0: infinity
  double period[3] = {0, 0, 0};          ///< length of periodic axes (connections)
  double inverse_period[3] = {0, 0, 0};  ///< its inverse, 0 on other axes
  double* influence = nullptr;
  double* reaction = nullptr;  ///< the source's influence, where the traversal visits each pair once
  double* energy = nullptr;    ///< measuring: half of each pair's energy
  double* virial = nullptr;    ///< measuring: 9 numbers a particle, half of each pair's -r_a F_b
};

/// Up to here scalars over half the pairs beat packs over all of them.
inline constexpr std::size_t few_particles = 24;

using PairKernel = void (*)(void const* law, PairTask const& task, std::size_t begin, std::size_t end);

/// The kernels of one law; null where the law can't be traversed that way.
struct PairKernels {
  PairKernel list = nullptr, list_reversible = nullptr, list_measure = nullptr;
  PairKernel all = nullptr, all_measure = nullptr;
  PairKernel connected = nullptr, connected_measure = nullptr;
  PairKernel few = nullptr;  ///< every pair once, by scalars: the fastest for a handful of particles
  bool has_energy = false;
};

namespace detail {

template <class Result>
inline constexpr bool has_energy = requires(Result r) {
  r.force;
  r.energy;
};

/// The part of a law's result that is summed into the influence.
template <class Result>
[[gnu::always_inline]] inline auto const& influence_of(Result const& result) {
  if constexpr (has_energy<Result>)
    return result.force;
  else
    return result;
}

template <class Real, class Struct>
[[gnu::always_inline]] inline auto as_array(Struct const& s) {
  return std::bit_cast<std::array<Real, sizeof(Struct) / sizeof(Real)>>(s);
}

enum class Pass { influence, reversible, measure };

/// A law inside a loop: plain parameters are copied, so that they stay in registers; tables are referred to.
template <class Law>
using Held = std::conditional_t<std::is_trivially_copyable_v<Law>, Law const, Law const&>;

/// Sums what a law returns over the neighbours of one particle.
template <Pass pass, class P, class Q, class Law>
class Sum {
 public:
  static constexpr int W = native_width<double>;
  using Real = Pack<double, W>;
  using Target = rebind_t<P, Real>;
  using Source = rebind_t<Q, Real>;
  using Result = decltype(std::declval<Law const&>()(std::declval<Target const&>(), std::declval<Source const&>()));
  using Influence = std::remove_cvref_t<decltype(influence_of(std::declval<Result const&>()))>;
  static constexpr std::size_t components = sizeof(Influence) / sizeof(Real);
  static constexpr int D = P::dimension;
  static_assert(
      sizeof(typename P::Influence) == components * sizeof(double),
      "the law returns something else than the influence that the particle class wants (see Particle::Influence)");

  Sum() {
    for (auto& x : influence_) x = Real(0.0);
    for (auto& x : virial_) x = Real(0.0);
  }

  [[gnu::always_inline]] void add(Law const& law, Target const& p, Source const& q, Mask<double, W> valid,
                                  Real rounding, [[maybe_unused]] double zero_at = 0) {
    auto const result = law(p, q);
    auto const influence = as_array<Real>(influence_of(result));
    Real const zero = 0.0;
    for (std::size_t c = 0; c < components; ++c) {
      Real x = select(valid, influence[c], zero);
      if constexpr (pass == Pass::reversible) x = (x + rounding) - rounding;
      influence_[c] += x;
    }
    if constexpr (pass == Pass::measure) {
      if constexpr (has_energy<Result>) {
        Real energy = result.energy;
        if (zero_at > 0) {
          Source at_cutoff = q;
          auto const r = q.position - p.position;
          at_cutoff.position = p.position + r * (zero_at * rsqrt(dot(r, r)));
          energy = energy - law(p, at_cutoff).energy;
        }
        energy_ += select(valid, energy, zero);
      }
      if constexpr (std::is_same_v<Influence, Vector<D, Real>>) {
        auto const r = q.position - p.position;
        for (int a = 0; a < D; ++a)
          for (int b = 0; b < D; ++b) virial_[a * D + b] += select(valid, r[a] * influence[b], zero);
      }
    }
  }

  [[gnu::always_inline]] void store(PairTask const& task, std::size_t particle) const {
    if constexpr (pass == Pass::measure) {
      task.energy[particle] += 0.5 * sum(energy_);
      for (int a = 0; a < D; ++a)
        for (int b = 0; b < D; ++b) task.virial[9 * particle + 3 * a + b] -= 0.5 * sum(virial_[a * D + b]);
    } else {
      for (std::size_t c = 0; c < components; ++c) task.influence[particle * components + c] += sum(influence_[c]);
    }
  }

 private:
  Real influence_[components];
  Real energy_ = Real(0.0);
  Real virial_[D * D];
};

template <int W>
[[gnu::always_inline]] inline Pack<double, W> lanes_from(double first) {
  Pack<double, W> lanes;
  for (int lane = 0; lane < W; ++lane) lanes.native[lane] = first + lane;
  return lanes;
}

/// The difference of two positions made the shortest among periodic images: d -= L round(d / L), without a branch.
template <int D, int W>
[[gnu::always_inline]] inline void nearest_image(Vector<D, Pack<double, W>>& d, PairTask const& task) {
  constexpr double to_integer =
      6755399441055744.0;  // 3/2 2^52: adding and subtracting it rounds to the nearest integer
  for (int a = 0; a < D; ++a) {
    Pack<double, W> const turns = (d[a] * task.inverse_period[a] + to_integer) - to_integer;
    d[a] = d[a] - turns * task.period[a];
  }
}

template <Pass pass, class P, class Q, class Law>
[[gnu::flatten]] void over_list(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using S = Sum<pass, P, Q, Law>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  typename S::Real const cutoff2 = task.cutoff2, rounding = task.rounding;
  for (std::size_t i = begin; i < end; ++i) {
    auto const p = broadcast<P>(task.target + i * row_stride<P>);
    S sum;
    std::uint32_t const* const last = task.index + task.start[i + 1];
    for (std::uint32_t const* j = task.index + task.start[i]; j != last; j += S::W) {
      auto const q = load_rows<Q>([&](int lane) { return task.source + j[lane] * row_stride<Q>; });
      sum.add(law, p, q, norm2(q.position - p.position) < cutoff2, rounding, task.zero_at);
    }
    sum.store(task, task.order ? task.order[i] : i);
  }
}

template <Pass pass, class P, class Q, class Law>
[[gnu::flatten]] void over_all(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using S = Sum<pass, P, Q, Law>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  typename S::Real const sources = static_cast<double>(task.sources);
  for (std::size_t i = begin; i < end; ++i) {
    auto const p = broadcast<P>(task.target + i * row_stride<P>);
    typename S::Real const self = task.same ? static_cast<double>(i) : -1.0;
    S sum;
    for (std::size_t j = 0; j < task.sources; j += S::W) {
      auto const q = load_rows<Q>([&](int lane) { return task.source + (j + lane) * row_stride<Q>; });
      auto const number = lanes_from<S::W>(static_cast<double>(j));
      sum.add(law, p, q, (number < sources) & (number != self), 0.0);
    }
    sum.store(task, i);
  }
}

template <Pass pass, class P, class Law>
[[gnu::flatten]] void over_connections(void const* the_law, PairTask const& task, std::size_t begin, std::size_t end) {
  using S = Sum<pass, P, P, Law>;
  Held<Law> law = *static_cast<Law const*>(the_law);
  for (std::size_t i = begin; i < end; ++i) {
    auto const p = broadcast<P>(task.target + i * row_stride<P>);
    typename S::Real const self = static_cast<double>(i);
    S sum;
    std::uint32_t const* const last = task.index + task.start[i + 1];
    for (std::uint32_t const* j = task.index + task.start[i]; j != last; j += S::W) {
      auto q = load_rows<P>([&](int lane) { return task.source + j[lane] * row_stride<P>; });
      auto d = q.position - p.position;
      nearest_image(d, task);
      q.position = p.position + d;
      typename S::Real number;
      for (int lane = 0; lane < S::W; ++lane) number.native[lane] = j[lane];
      sum.add(law, p, q, number != self, 0.0);
    }
    sum.store(task, i);
  }
}

/// Every pair of one ensemble once. For 2, 3 and 4 particles the count is a constant, and all stays in registers.
template <class P, class Law, class Count>
[[gnu::always_inline]] inline void each_pair(Law const& law, PairTask const& task, Count count) {
  constexpr std::size_t components = sizeof(typename P::Influence) / sizeof(double);
  constexpr std::size_t most = few_particles;
  auto const* rows = reinterpret_cast<Row<P> const*>(task.target);
  std::array<std::array<double, components>, most> total;
  for (std::size_t i = 0; i < count; ++i) total[i] = {};
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t j = i + 1; j < count; ++j) {
      P const &p = rows[i], &q = rows[j];
      auto const on_p = as_array<double>(influence_of(law(p, q)));
      if constexpr (symmetry_of<Law>() == Symmetry::antisymmetric) {
        for (std::size_t c = 0; c < components; ++c) total[i][c] += on_p[c], total[j][c] -= on_p[c];
      } else {
        auto const on_q = as_array<double>(influence_of(law(q, p)));
        for (std::size_t c = 0; c < components; ++c) total[i][c] += on_p[c], total[j][c] += on_q[c];
      }
    }
  }
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t c = 0; c < components; ++c) {
      double& influence = task.influence[i * components + c];
      influence = task.overwrite ? total[i][c] : influence + total[i][c];
    }
}

template <class P, class Law>
[[gnu::flatten, gnu::optimize("no-tree-vectorize")]] void over_few(void const* the_law, PairTask const& task,
                                                                   std::size_t, std::size_t) {
  Held<Law> law = *static_cast<Law const*>(the_law);
  switch (task.targets) {
    case 2:
      return each_pair<P>(law, task, std::integral_constant<std::size_t, 2>{});
    case 3:
      return each_pair<P>(law, task, std::integral_constant<std::size_t, 3>{});
    case 4:
      return each_pair<P>(law, task, std::integral_constant<std::size_t, 4>{});
    default:
      return each_pair<P>(law, task, task.targets);
  }
}

template <class P, class Q, class Law>
inline constexpr bool gives_energy =
    has_energy<decltype(std::declval<Law const&>()(std::declval<P const&>(), std::declval<Q const&>()))>;

}  // namespace detail

/// True if law(p, q) can be called for these classes with packs.
template <class Law, class P, class Q>
concept PairLaw = requires(Law const& law, rebind_t<P, Pack<double>> const& p, rebind_t<Q, Pack<double>> const& q) {
  law(p, q);
};

template <class P, class Q, class Law>
PairKernels near_kernels() {
  using detail::Pass;
  PairKernels kernels;
  kernels.list = detail::over_list<Pass::influence, P, Q, Law>;
  kernels.list_reversible = detail::over_list<Pass::reversible, P, Q, Law>;
  kernels.list_measure = detail::over_list<Pass::measure, P, Q, Law>;
  kernels.all = detail::over_all<Pass::influence, P, Q, Law>;
  kernels.all_measure = detail::over_all<Pass::measure, P, Q, Law>;
  if constexpr (std::is_same_v<P, Q>) kernels.few = detail::over_few<P, Law>;
  kernels.has_energy = detail::gives_energy<P, Q, Law>;
  return kernels;
}

template <class P, class Law>
PairKernels connection_kernels() {
  using detail::Pass;
  PairKernels kernels;
  kernels.connected = detail::over_connections<Pass::influence, P, Law>;
  kernels.connected_measure = detail::over_connections<Pass::measure, P, Law>;
  kernels.has_energy = detail::gives_energy<P, P, Law>;
  return kernels;
}

}  // namespace boltzmann
