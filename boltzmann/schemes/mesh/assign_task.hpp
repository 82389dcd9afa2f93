// The arguments of assignment and interpolation kernels, as plain memory: particles as rows, the mesh with its ghosts.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

struct AssignTask {
  double const* rows = nullptr;  ///< the position comes first
  std::size_t stride = 4;
  double const* strength = nullptr;
  double low[3] = {}, per_length[3] = {};  ///< of the box; cells per length
  std::size_t cells[3] = {1, 1, 1};
  bool periodic[3] = {};                 ///< positions outside are wrapped
  std::size_t nodes_x = 1, nodes_y = 1;  ///< ghosts included

  std::int64_t* counts = nullptr;  ///< assignment: sums of strength times weight, in units of 1 / per_strength
  double per_strength = 1;

  int components = 0;  ///< interpolation: arrays of the field, and the result at each particle
  double const* field[4] = {};
  double* result = nullptr;  ///< `components` numbers per particle: strength times interpolated value
  bool overwrite = true;     ///< true: store; false: add
};

struct AssignResult {
  static constexpr std::size_t nobody = ~std::size_t{0};
  std::size_t outside = nobody;  ///< the first particle that is not in the box
};

using AssignKernel = void (*)(AssignTask const& task, AssignResult& result, std::size_t begin, std::size_t end);
struct AssignKernels {
  AssignKernel assign = nullptr, interpolate = nullptr;
};
/// The kernels by [dimension - 1][order - 1].
struct AssignKernelTable {
  AssignKernels of[3][highest_order];
};
template <InstructionSet set>
AssignKernelTable const& assign_kernels();

}  // namespace boltzmann
