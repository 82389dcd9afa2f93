// The kernels of laws given as formulas: their arguments and their table.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/laws/law_program.hpp>
#include <boltzmann/schemes/pair/external_kernels.hpp>
#include <boltzmann/schemes/pair/pair_kernels.hpp>

namespace boltzmann {

/// By dimension, from 1; the law is a PairProgram or an ExternalProgram.
struct FormulaKernelTable {
  PairKernels pairs[3];
  ExternalKernels externals[3];
  int code_width = 0;  ///< vector width of machine code that is compatible with these kernels; 0: none is
};
template <InstructionSet set>
FormulaKernelTable const& formula_kernels();

}  // namespace boltzmann
