// The arguments of kernels of whole steps, as plain memory: the columns of one ensemble and the slots of a mesh.
#pragma once

#include <boltzmann/core/instruction_set.hpp>

#include <cstddef>
#include <cstdint>
#include <type_traits>

namespace boltzmann {

/// Slots: each cell along x stores all nodes in the range of its particles contiguously. So one load or store serves a
/// row of nodes, and neighbouring cells share no memory. The number of nodes (a power of two) ...
constexpr int slot_width(int order) { return order == 1 ? 1 : order == 2 ? 2 : 4; }
/// ... and the number of numbers for a vector of D components.
constexpr int slot_numbers(int dimension, int order) {
  int const least = dimension * slot_width(order);
  int numbers = 1;
  while (numbers < least) numbers *= 2;
  return numbers;
}
/// The highest order of assignment for which whole steps are implemented.
inline constexpr int highest_step_order = 3;

enum class StepBoundary : std::uint8_t { wraps, reflects, ends };

template <class Real>
struct StepTask {
  /// Positions are fixed-point numbers, 2^bits per cell, from the low edge.
  using Fixed = std::conditional_t<std::is_same_v<Real, double>, std::int64_t, std::int32_t>;

  Fixed* position[3] = {};
  Real* velocity[3] = {};
  int bits = 0;
  Fixed end[3] = {};  ///< the high edge
  StepBoundary boundary[3] = {};
  Real per_time[3] = {};  ///< parts of a cell per velocity and step
  Real kick = 0;          ///< half a step times strength over mass
  Real push[3] = {};      ///< half a step times the external acceleration
  Real turn[9] = {};      ///< the rotation of the velocity in half a step
  bool turns = false;
  bool pending = false;      ///< velocities lack the second kick of the last step
  bool kicked = false;       ///< velocities have the first kick of the next step, because the field is known when
                             ///< observers run
  Real fastest_allowed = 0;  ///< square of a velocity

  Real const* field = nullptr;  ///< slots of the field
  std::size_t slots_x = 0, slots_y = 0;
  std::int64_t* density = nullptr;  ///< slots of the density
  std::size_t copies = 1;           ///< number of copies of each slot of the density, a power of two
  Real charge = 0;                  ///< count per particle

  double* rows = nullptr;                ///< of the ensemble, in the user's order
  std::uint32_t const* order = nullptr;  ///< the row of each particle
  std::size_t stride = 0, row_velocity = 0;
  double low[3] = {}, part[3] = {};  ///< the low edge, and the length of a fixed-point unit
};

struct StepResult {
  double fastest = 0;   ///< square of a velocity
  bool failed = false;  ///< a particle is not finite, too fast, or has left the mesh
};

template <class Real>
using StepKernel = void (*)(StepTask<Real> const& task, StepResult& result, std::size_t begin, std::size_t end);

/// Kernels for one dimension and order. Columns are padded to whole blocks of 64 bytes.
template <class Real>
struct StepKernels {
  StepKernel<Real> deposit = nullptr, advance = nullptr, finish = nullptr;
};

/// The kernels by [dimension - 1][order - 1].
template <class Real>
struct StepKernelTable {
  StepKernels<Real> of[3][highest_step_order];
};
template <InstructionSet set>
StepKernelTable<double> const& double_steps();
template <InstructionSet set>
StepKernelTable<float> const& single_steps();

}  // namespace boltzmann
