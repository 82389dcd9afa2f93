// The arguments of kernels of tuples, as plain memory.
#pragma once

#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// Tuples of particles of one ensemble (`target`) under one law. Energies and virials are those of whole tuples.
struct TupleTask : PairTask {
  std::uint32_t const* members = nullptr;  ///< particle numbers of each tuple
  std::uint32_t const* slot = nullptr;     ///< for each member: the vector of `influence` that receives its force
};

using TupleKernel = void (*)(void const* law, TupleTask const& task, std::size_t begin, std::size_t end);

struct TupleKernels {
  TupleKernel forces = nullptr, measure = nullptr;
};

}  // namespace boltzmann
