// Vortices in single precision.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/scenario/single_kernels.hpp>
#include <boltzmann/schemes/pair/over_all_single.hpp>

namespace boltzmann {
namespace {

template <class Law, class Rows>
struct InSinglePrecision;
template <class Law, class... P, class... Q, class Connections, class Externals>
struct InSinglePrecision<Law, LawRows<Layouts<On<P, Q>...>, Connections, Externals>> {
  static constexpr std::array<PairKernel, sizeof...(P)> kernels{
      detail::over_all_single<native_width<double>, P, Q, OfScenario<Law>>...};
};

constexpr SingleKernels table{InSinglePrecision<BiotSavart, VortexRows>::kernels,
                              InSinglePrecision<AlgebraicBiotSavart, VortexRows>::kernels};

}  // namespace

template <>
SingleKernels const& single_kernels<this_set>() {
  return table;
}

}  // namespace boltzmann
