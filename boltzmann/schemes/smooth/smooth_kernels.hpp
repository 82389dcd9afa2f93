// The kernels of smooth particles: every pass over neighbour lists, for one weight in one dimension.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/laws/weight.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// Passes; `law` is a PassParameters. Sums are stored in the order of rows.
struct SmoothPasses {
  PairKernel density = nullptr;
  PairKernel gradients = nullptr, gradients_geometric = nullptr;
  PairKernel uniform = nullptr;  ///< only if all ranges are equal
  PairKernel pressure = nullptr, viscous = nullptr, all = nullptr;
  PairKernel viscous_by_volume = nullptr, all_by_volume = nullptr;
  PairKernel fluid = nullptr, fluid_viscous = nullptr, fluid_by_volume = nullptr;  ///< with viscosity and conduction
};

struct SmoothKernels {
  SmoothPasses same;      ///< all particles have one range
  SmoothPasses variable;  ///< each has its own
};

/// In 1D, 2D, 3D.
struct SmoothKernelTable {
  SmoothKernels in[3];
};

template <InstructionSet set, class Shape>
SmoothKernelTable const& smooth_kernels();

/// The passes of solids: gradients with the sums of hourglass control, and the forces.
struct SolidPasses {
  PairKernel sums = nullptr, forces = nullptr;
};

/// In 2D or 3D.
template <InstructionSet set>
SolidPasses solid_passes(WeightShape shape, int dimension, bool own_ranges);

/// The table of a weight, for the selected instruction set.
SmoothKernelTable const& smooth_kernels_of(WeightShape shape);

}  // namespace boltzmann
