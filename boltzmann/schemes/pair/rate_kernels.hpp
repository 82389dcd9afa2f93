// The kernels of rates of fields: their arguments and their table.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/laws/law_program.hpp>
#include <boltzmann/schemes/pair/external_kernels.hpp>

namespace boltzmann {

/// By dimension, from 1; the law is a RateProgram.
struct RateKernelTable {
  ExternalKernel rates[3];
};
template <InstructionSet set>
RateKernelTable const& rate_kernels();

}  // namespace boltzmann
