// What a kernel of tuples is given, as plain memory.
#pragma once

#include <boltzmann/schemes/pair/pair_task.hpp>

namespace boltzmann {

/// Tuples of particles of one ensemble (`target`) under one law. Energies and virials are whole ones, of each tuple.
struct TupleTask : PairTask {
  std::uint32_t const* members = nullptr;  ///< particle numbers of each tuple
  std::uint32_t const* slot = nullptr;     ///< where the force on each member goes: which vector of `influence`
};

using TupleKernel = void (*)(void const* law, TupleTask const& task, std::size_t begin, std::size_t end);

struct TupleKernels {
  TupleKernel forces = nullptr, measure = nullptr;
};

}  // namespace boltzmann
