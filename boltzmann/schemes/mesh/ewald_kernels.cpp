// The near part of P3M over pairs of point sources.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/laws/ewald_short.hpp>
#include <boltzmann/schemes/mesh/point_source.hpp>
#include <boltzmann/schemes/pair/pair_kernels.hpp>

namespace boltzmann {
namespace {

template <int D>
constexpr PairKernels kernels = near_kernels<PointSource<D>, PointSource<D>, EwaldShort>();

constexpr EwaldKernelTable table{{kernels<1>, kernels<2>, kernels<3>}};

}  // namespace

template <>
EwaldKernelTable const& ewald_kernels<this_set>() {
  return table;
}

}  // namespace boltzmann
