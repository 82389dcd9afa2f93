// The kernels of a pair law: every traversal, with the law in its inner loop. The template parameter W, the vector
// width, distinguishes the instruction sets, so that their kernels are different functions.
#pragma once

#include <boltzmann/schemes/pair/over_all.hpp>
#include <boltzmann/schemes/pair/over_connections.hpp>
#include <boltzmann/schemes/pair/over_list.hpp>
#include <boltzmann/schemes/pair/over_small.hpp>

#include <type_traits>

namespace boltzmann {
namespace detail {

template <class P, class Q, class Law>
inline constexpr bool gives_energy =
    has_energy<decltype(std::declval<Law const&>()(std::declval<P const&>(), std::declval<Q const&>()))>;

/// True if law(p, q) returns an influence on the class of p.
template <class P, class Q, class Law, int W>
inline constexpr bool gives_influence =
    sizeof(typename P::Influence) / sizeof(double) == Sum<Pass::influence, W, P, Q, Law>::components;

/// A text that compilers print among template arguments.
template <std::size_t n>
struct PrintedText {
  char text[n]{};
  consteval PrintedText(char const (&from)[n]) {
    for (std::size_t i = 0; i < n; ++i) text[i] = from[i];
  }
};

/// Compiles law(p, ...) for packs of particles before any other use. If that fails, the compiler's first lines contain
/// the hint.
template <PrintedText hint, class Law, class... Particles>
constexpr bool compiles_for_packs() {
  return requires(Law const& law, rebind_t<Particles, Pack<double>> const&... particles) { law(particles...); };
}
inline constexpr PrintedText law_hint{"in a law write sqrt without std:: (and exp, pow, abs, min, max, ...)"};

}  // namespace detail

/// True if law(p, q) can be called for these classes with packs.
template <class Law, class P, class Q>
concept PairLaw = requires(Law const& law, rebind_t<P, Pack<double>> const& p, rebind_t<Q, Pack<double>> const& q) {
  law(p, q);
};

template <class P, class Q, class Law, int W = native_width<double>>
constexpr PairKernels near_kernels() {
  using detail::Pass;
  static_assert(
      detail::gives_influence<P, Q, Law, W>,
      "the law returns something else than the influence that the particle class wants (see Particle::Influence)");
  PairKernels kernels;
  kernels.list = detail::over_list<Pass::influence, W, P, Q, Law>;
  kernels.list_reversible = detail::over_list<Pass::reversible, W, P, Q, Law>;
  kernels.list_measure = detail::over_list<Pass::measure, W, P, Q, Law>;
  kernels.all = detail::over_all<Pass::influence, W, P, Q, Law>;
  kernels.all_measure = detail::over_all<Pass::measure, W, P, Q, Law>;
  if constexpr (std::is_same_v<P, Q>) kernels.few = detail::over_small<W, P, Law>;
  kernels.has_energy = detail::gives_energy<P, Q, Law>;
  return kernels;
}

template <class P, class Law, int W = native_width<double>>
constexpr PairKernels connection_kernels() {
  using detail::Pass;
  static_assert(
      detail::gives_influence<P, P, Law, W>,
      "the law returns something else than the influence that the particle class wants (see Particle::Influence)");
  PairKernels kernels;
  kernels.connected = detail::over_connections<Pass::influence, W, P, Law>;
  kernels.connected_measure = detail::over_connections<Pass::measure, W, P, Law>;
  kernels.has_energy = detail::gives_energy<P, P, Law>;
  return kernels;
}

}  // namespace boltzmann
