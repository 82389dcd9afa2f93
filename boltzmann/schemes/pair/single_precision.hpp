// Sums over all pairs in single precision, for programs. Vortices are twice as fast, to a relative accuracy of about
// 1e-6.
//
//   add_in_single_precision(scheme, vortices, vortices, BiotSavart{});
#pragma once

#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/schemes/pair/over_all_single.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <type_traits>

namespace boltzmann {

/// The kernels of a law; that of all pairs is in single precision.
template <int W, class P, class Q, class Law>
constexpr PairKernels in_single_precision(PairKernels kernels) {
  static_assert(!std::is_base_of_v<GaussianBiotSavart, Law>,
                "Gaussian cores need exp, which packs of floats don't have: take BiotSavart or AlgebraicBiotSavart");
  kernels.all = detail::over_all_single<W, P, Q, Law>;
  kernels.few = nullptr;
  return kernels;
}

/// The influence law(p, q) of all q in `source` (which may be the target) on each p in `target`, without a cut-off,
/// like PairScheme::internal and, one way, between. Distances are differences of positions relative to a nearby target,
/// and sums of 256 are added up in double precision. Inverse squares are limited to 1e38: no distance may exceed 1e18.
template <class P, class Q, class Law>
void add_in_single_precision(PairScheme& scheme, Ensemble<P>& target, Ensemble<Q>& source, Law const& law) {
  scheme.add_pairs(target, source, in_single_precision<native_width<double>, P, Q, Law>(near_kernels<P, Q, Law>()),
                   PairScheme::keep(law), PairScheme::traits_of(law), no_cutoff);
}

}  // namespace boltzmann
