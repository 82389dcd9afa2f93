// Sums over all vortices, W targets at a time.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/schemes/pair/over_all.hpp>
#include <boltzmann/schemes/vortices/flow_kernels.hpp>
#include <boltzmann/schemes/vortices/flow_laws.hpp>

namespace boltzmann {
namespace {

template <int D, template <class> class Law, class Core>
constexpr PairKernel kernel() {
  return detail::over_all<detail::Pass::influence, native_width<double>, Vortex<D>, Vortex<D>, Law<Core>>;
}

template <int D>
constexpr FlowKernels kernels() {
  return {{kernel<D, SlopesOf, PlainCore>(), kernel<D, SlopesOf, AlgebraicCore>(), kernel<D, SlopesOf, GaussianCore>()},
          {kernel<D, SumsOf, PlainCore>(), kernel<D, SumsOf, AlgebraicCore>(), kernel<D, SumsOf, GaussianCore>()}};
}

constexpr FlowKernelTable table{{kernels<2>(), kernels<3>()}};

}  // namespace

template <>
FlowKernelTable const& flow_kernels<this_set>() {
  return table;
}

}  // namespace boltzmann
