// The passes of solids, for all weights.
#include <boltzmann/schemes/smooth/kernel_table.hpp>
#include <boltzmann/schemes/smooth/solid_passes.hpp>

namespace boltzmann {

namespace detail {
template <int W, int D, class Shape, bool variable>
constexpr SolidPasses solid_passes() {
  return {smooth_pass<W, SmoothSolid<D>, SolidSumPass<Shape, variable>>,
          smooth_pass<W, SmoothSolid<D>, SolidForcePass<Shape, variable>>};
}
template <InstructionSet set, class Shape>
struct SolidTable {
  static constexpr int W = native_width<double>;
  static constexpr SolidPasses table[2][2]{{solid_passes<W, 2, Shape, false>(), solid_passes<W, 2, Shape, true>()},
                                           {solid_passes<W, 3, Shape, false>(), solid_passes<W, 3, Shape, true>()}};
};
}  // namespace detail

template <>
SolidPasses solid_passes<this_set>(WeightShape shape, int dimension, bool own_ranges) {
  return for_weight(shape, [&](auto s) -> SolidPasses {
    return detail::SolidTable<this_set, decltype(s)>::table[dimension - 2][own_ranges ? 1 : 0];
  });
}

}  // namespace boltzmann
