// The kernels of angular laws given as formulas.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/schemes/molecules/tuple_task.hpp>

namespace boltzmann {

/// Laws are an AngularProgram.
struct TupleFormulaKernels {
  TupleKernels angles[2];  ///< in 2D, 3D
  TupleKernels dihedrals;  ///< in 3D
  int code_width = 0;      ///< as in FormulaKernelTable
};
template <InstructionSet set>
TupleFormulaKernels const& tuple_formula_kernels();

}  // namespace boltzmann
