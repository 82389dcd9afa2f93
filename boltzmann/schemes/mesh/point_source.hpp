// Point sources: particles that consist of a position and a strength, for pair sums over particles of any class.
// Private to this module.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/particles/particle.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

template <int D, class Real = double>
struct PointSource : Particle<D, Real> {
  static constexpr char const* class_name = "PointSource";

  Real amount;

  Real strength() const { return amount; }
};

/// The kernels of EwaldShort between point sources, by [dimension - 1].
struct EwaldKernelTable {
  PairKernels of[3];
};
template <InstructionSet set>
EwaldKernelTable const& ewald_kernels();

}  // namespace boltzmann
