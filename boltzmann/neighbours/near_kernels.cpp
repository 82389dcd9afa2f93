// The search for neighbours, compiled for each instruction set.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/neighbours/near_rows.hpp>
#include <boltzmann/neighbours/neighbour_kernels.hpp>

namespace boltzmann {
namespace {

constexpr int W = native_width<float>;
constexpr NeighbourKernels kernels{{detail::near_rows<W, 1>, detail::near_rows<W, 2>, detail::near_rows<W, 3>},
                                   detail::refresh_rows<W>,
                                   detail::place_rows<W>,
                                   detail::move_images<W>};

}  // namespace

template <>
NeighbourKernels const& neighbour_kernels_of<this_set>() {
  return kernels;
}

}  // namespace boltzmann
