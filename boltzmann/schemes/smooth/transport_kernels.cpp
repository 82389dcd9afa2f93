// Kernels of viscosity and conduction.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/schemes/pair/over_list.hpp>
#include <boltzmann/schemes/smooth/transport_kernels.hpp>
#include <boltzmann/schemes/smooth/transport_passes.hpp>

namespace boltzmann {
namespace detail {

template <int W, class P, class Law>
[[gnu::flatten]] void transport_pass(void const* parameters, PairTask const& task, std::size_t begin, std::size_t end) {
  Law const law{*static_cast<PassParameters const*>(parameters)};
  over_list<Pass::influence, W, P, P, Law>(&law, task, begin, end);
}

template <int W, int D, bool variable>
constexpr TransportPasses transport_passes() {
  using P = SmoothTransport<D>;
  return {transport_pass<W, P, MotionPass<variable>>, transport_pass<W, P, TransportPass<variable>>,
          transport_pass<W, P, StressPass<variable>>};
}

template <int W, int D>
constexpr TransportKernels transport_kernels_in() {
  return {transport_passes<W, D, false>(), transport_passes<W, D, true>()};
}

template <InstructionSet set>
struct TransportTable {
  static constexpr int W = native_width<double>;
  static constexpr TransportKernelTable table{
      {transport_kernels_in<W, 1>(), transport_kernels_in<W, 2>(), transport_kernels_in<W, 3>()}};
};

}  // namespace detail

template <>
TransportKernelTable const& transport_kernels<this_set>() {
  return detail::TransportTable<this_set>::table;
}

}  // namespace boltzmann
