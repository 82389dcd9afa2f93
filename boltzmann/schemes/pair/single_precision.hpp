// Sums over all pairs in single precision, for programs: vortices carry each other twice as fast, to some 1e-6 of what
// is felt.
//
//   add_in_single_precision(scheme, vortices, vortices, BiotSavart{});
#pragma once

#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/schemes/pair/over_all_single.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <type_traits>

namespace boltzmann {

/// The kernels of a law with that of all pairs in single precision.
template <int W, class P, class Q, class Law>
constexpr PairKernels in_single_precision(PairKernels kernels) {
  static_assert(!std::is_base_of_v<GaussianBiotSavart, Law>,
                "Gaussian cores need exp, which packs of floats don't have: take BiotSavart or AlgebraicBiotSavart");
  kernels.all = detail::over_all_single<W, P, Q, Law>;
  kernels.few = nullptr;
  return kernels;
}

/// The influence law(p, q) of all q in `source` (which may be the target) on each p in `target`, without a cut-off, like
/// PairScheme::internal and, one way, between. Distances are differences of places relative to a target nearby, and sums
/// of 256 are added up in double precision. Inverses of squares end at 1e38: nobody may be further than 1e18 from others.
template <class P, class Q, class Law>
void add_in_single_precision(PairScheme& scheme, Ensemble<P>& target, Ensemble<Q>& source, Law const& law) {
  scheme.add_pairs(target, source, in_single_precision<native_width<double>, P, Q, Law>(near_kernels<P, Q, Law>()),
                   PairScheme::keep(law), PairScheme::traits_of(law), no_cutoff);
}

}  // namespace boltzmann
