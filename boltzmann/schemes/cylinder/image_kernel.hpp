// The kernel that sums what images do to particles of any class that a flow carries. Private to this room.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// Vortices on whatever begins with a position.
struct ImageLaw : BiotSavart {
  static constexpr bool on_longer_rows = true;
};

/// Kernel units define it, once for each instruction set.
template <InstructionSet set>
PairKernel image_kernel();

}  // namespace boltzmann
