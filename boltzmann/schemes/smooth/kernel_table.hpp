// The table of kernels of one weight, for kernel units (see core/kernel_unit.hpp). Private to this module.
#pragma once

#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/core/pack_math.hpp>
#include <boltzmann/schemes/pair/over_list.hpp>
#include <boltzmann/schemes/smooth/passes.hpp>
#include <boltzmann/schemes/smooth/smooth_kernels.hpp>
#include <boltzmann/schemes/smooth/transport_passes.hpp>

namespace boltzmann {
namespace detail {

template <int W, class P, class Law>
[[gnu::flatten]] void smooth_pass(void const* parameters, PairTask const& task, std::size_t begin, std::size_t end) {
  Law const law{*static_cast<PassParameters const*>(parameters)};
  over_list<Pass::influence, W, P, P, Law>(&law, task, begin, end);
}

template <int W, class Shape, int D, bool variable>
constexpr SmoothPasses smooth_passes() {
  SmoothPasses passes;
  passes.density = smooth_pass<W, SmoothPlace<D>, DensityPass<Shape, variable>>;
  passes.gradients = smooth_pass<W, SmoothFluid<D>, GradientPass<Shape, variable, false>>;
  passes.gradients_geometric = smooth_pass<W, SmoothFluid<D>, GradientPass<Shape, variable, true>>;
  passes.viscous = smooth_pass<W, SmoothFluid<D>, RatePass<Shape, variable, RateTerms::viscous>>;
  passes.all = smooth_pass<W, SmoothMatter<D>, RatePass<Shape, variable, RateTerms::all>>;
  passes.viscous_by_volume = smooth_pass<W, SmoothFluid<D>, RatePass<Shape, variable, RateTerms::viscous, true>>;
  passes.all_by_volume = smooth_pass<W, SmoothMatter<D>, RatePass<Shape, variable, RateTerms::all, true>>;
  passes.fluid_viscous = smooth_pass<W, SmoothTransport<D>, FluidPass<Shape, variable, RateTerms::viscous>>;
  passes.fluid_by_volume = smooth_pass<W, SmoothTransport<D>, FluidPass<Shape, variable, RateTerms::viscous, true>>;
  if constexpr (variable) {
    passes.pressure = passes.viscous;
    passes.fluid = passes.fluid_viscous;
  } else {
    passes.pressure = smooth_pass<W, SmoothFluid<D>, RatePass<Shape, variable, RateTerms::pressure>>;
    passes.fluid = smooth_pass<W, SmoothTransport<D>, FluidPass<Shape, variable, RateTerms::pressure>>;
    passes.uniform = smooth_pass<W, SmoothPlace<D>, UniformPass<Shape>>;
  }
  return passes;
}

template <int W, class Shape, int D>
constexpr SmoothKernels smooth_kernels_in() {
  return {smooth_passes<W, Shape, D, false>(), smooth_passes<W, Shape, D, true>()};
}

template <InstructionSet set, class Shape>
struct SmoothTable {
  static constexpr int W = native_width<double>;
  static constexpr SmoothKernelTable table{
      {smooth_kernels_in<W, Shape, 1>(), smooth_kernels_in<W, Shape, 2>(), smooth_kernels_in<W, Shape, 3>()}};
};

}  // namespace detail
}  // namespace boltzmann
