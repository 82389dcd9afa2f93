// The kernels of laws that are formulas: what they are given, and the table of them.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/laws/law_program.hpp>
#include <boltzmann/schemes/pair/external_kernels.hpp>
#include <boltzmann/schemes/pair/pair_kernels.hpp>

namespace boltzmann {

/// By dimension, from 1; laws are a PairProgram or an ExternalProgram.
struct FormulaKernelTable {
  PairKernels pairs[3];
  ExternalKernels externals[3];
  int code_width = 0;  ///< numbers at a time of machine code that goes with these kernels; 0: none does
};
template <InstructionSet set>
FormulaKernelTable const& formula_kernels();

}  // namespace boltzmann
