// Sums what a law returns over the neighbours of one particle.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/laws/interaction.hpp>
#include <boltzmann/particles/rows.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

#include <array>
#include <bit>
#include <cstddef>
#include <type_traits>

namespace boltzmann {

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

/// with_energy: influence and energy in one sum.
enum class Pass { influence, reversible, measure, with_energy };

/// A law inside a loop. Plain parameters are copied, so that they stay in registers; tables are referenced.
template <class Law>
using Held = std::conditional_t<std::is_trivially_copyable_v<Law>, Law const, Law const&>;

/// A law may be compiled for a class P and run on all longer classes that begin like it. It declares this by `static
/// constexpr bool on_longer_rows = true`.
template <class Law>
constexpr bool runs_on_longer_rows() {
  if constexpr (requires { Law::on_longer_rows; })
    return Law::on_longer_rows;
  else
    return false;
}

/// The stride of rows in doubles: that of P, or that of the task.
template <class P, class Law>
[[gnu::always_inline]] constexpr std::size_t stride_of([[maybe_unused]] std::size_t given) {
  return runs_on_longer_rows<Law>() ? given : row_stride<P>;
}

/// The particle at the beginning of a row.
template <class P>
[[gnu::always_inline]] inline P const& particle_at(double const* row) {
  return *reinterpret_cast<Row<P> const*>(row);
}
template <class P>
[[gnu::always_inline]] inline P& particle_at(double* row) {
  return *reinterpret_cast<Row<P>*>(row);
}

/// Sums what a law returns over the neighbours of one particle.
template <Pass pass, int W, class P, class Q, class Law>
class Sum {
 public:
  static constexpr int width = W;
  using Real = Pack<double, W>;
  using Target = rebind_t<P, Real>;
  using Source = rebind_t<Q, Real>;
  using Result = decltype(std::declval<Law const&>()(std::declval<Target const&>(), std::declval<Source const&>()));
  using Influence = std::remove_cvref_t<decltype(influence_of(std::declval<Result const&>()))>;
  static constexpr std::size_t components = sizeof(Influence) / sizeof(Real);
  static constexpr int D = P::dimension;

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
          at_cutoff.position = p.position + at_distance(zero_at, q.position - p.position);
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
      double* const influence = task.influence + particle * components;
      if (task.overwrite)
        for (std::size_t c = 0; c < components; ++c) influence[c] = sum(influence_[c]);
      else
        for (std::size_t c = 0; c < components; ++c) influence[c] += sum(influence_[c]);
    }
  }

 private:
  /// A vector of this length along r; along x if two particles are coincident.
  [[gnu::always_inline]] static Vector<D, Real> at_distance(double length, Vector<D, Real> const& r) {
    Real const square = dot(r, r);
    Vector<D, Real> stretched = r * (length * rsqrt(square));
    for (int a = 0; a < D; ++a) stretched[a] = select(square > 0.0, stretched[a], Real(a == 0 ? length : 0.0));
    return stretched;
  }

  Real influence_[components];
  Real energy_ = Real(0.0);
  Real virial_[D * D];
};

}  // namespace detail

}  // namespace boltzmann
