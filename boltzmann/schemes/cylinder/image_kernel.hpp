// The kernel that sums the velocities of images at particles of any advected class. Private to this module.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/laws/vortex.hpp>
#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// Vortices acting on any class whose row begins with a position.
struct ImageLaw : BiotSavart {
  static constexpr bool on_longer_rows = true;
};

/// Defined by kernel units, once per instruction set.
template <InstructionSet set>
PairKernel image_kernel();

}  // namespace boltzmann
