// The kernels of the dissipation of pairs, as plain memory and function pointers.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/pack_random.hpp>
#include <boltzmann/dissipation/dissipation_law.hpp>
#include <boltzmann/formulas/formula_program.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// One dissipation in one step: what its formulas are made of, and the key of its noise.
struct PairNoise {
  Convention convention = Convention::constant_friction;
  double inverse_range = 0, range2 = 0;
  double exponent = 0;      ///< of chi
  int twice_exponent = -1;  ///< the same where it is a small multiple of 1/2, else -1
  double friction = 0;      ///< gamma dt
  double amplitude = 0;     ///< of noise: the root of 2 gamma k dt, times T_ref where the convention has it
  double temperature = 0;   ///< T_ref
  double boltzmann_constant = 0;
  double conduction = 0;                  ///< kappa dt
  double conduction_noise = 0;            ///< sqrt(2 k kappa dt)
  FormulaProgram const* typed = nullptr;  ///< that of a TypedFriction, or null
  bool of_temperature = false;            ///< whether its friction depends on T
  double greatest_square = 0;             ///< as TypedFriction has it
  bool same = true;  ///< a pair of one ensemble; else targets belong to the first or to the second of two
  bool first = true;
  std::uint64_t step = 0, tag = 0;  ///< words of the counter beside the two numbers
  PhiloxKey key;
};

/// Order-free: for target rows [begin, end), what they and their neighbours get, added to the sums of `rows` rows from
/// `first` on. Four numbers a row: the momentum it gets (dimension numbers), then the energy that it loses. Among one
/// ensemble (noise.same) a pair is listed once, in the row of the first, and both get their shares; sums have one row
/// more, for those who have none.
struct DissipationTask {
  double const *target = nullptr, *source = nullptr;  ///< dissipation points
  std::uint32_t const* number = nullptr;              ///< which particle each target row is
  /// Of each target from `listed` on groups of 8 entries, 4 times a source row, each with the 8 numbers of these
  /// particles behind it.
  std::uint32_t const* const* row = nullptr;
  std::uint32_t const* length = nullptr;  ///< entries
  std::size_t listed = 0;
  std::size_t begin = 0, end = 0;
  std::size_t first = 0, rows = 0;
  double* sums = nullptr;
  double asymmetry = 0;  ///< 1/4: |dp|^2 (1/mj - 1/mi) is paid by i; 0: not
  PairNoise noise;
};

/// A pair, for Shardlow's splitting: rows of the two, and the row (an image, perhaps) where the second stands as seen
/// by the first.
struct DissipationPair {
  std::uint32_t first, second, seen;
};

/// Shardlow's splitting: of `count` pairs chi (zero out of range; of typed friction its strength), the direction from second to first (unit vector;
/// unprojected: not), and normals: one (projected) or as many as dimensions, and one more where heat is conducted.
struct GeometryTask {
  double const *first = nullptr, *second = nullptr;                       ///< dissipation points
  std::uint32_t const *first_number = nullptr, *second_number = nullptr;  ///< which particle each (owned) row is
  DissipationPair const* pairs = nullptr;
  std::size_t count = 0;      ///< at most geometry_block
  double* columns = nullptr;  ///< chi, 3 of the direction, 4 normals, chi of conduction: geometry_block each. Friction
                              ///< that depends on T has no chi yet, but 1 or zero; behind it the distance's square.
  PairNoise noise;
};
inline constexpr std::size_t geometry_block = 256;
inline constexpr std::size_t geometry_columns = 9, weight_column = 8;

struct DissipationKernels {
  void (*simultaneous)(DissipationTask const& task) = nullptr;
  void (*geometry)(GeometryTask const& task) = nullptr;
  int code_width = 0;  ///< numbers at a time of machine code that goes with these kernels; 0: none does
};

/// In 1D, 2D, 3D; unprojected, projected.
struct DissipationKernelTable {
  DissipationKernels of[3][2];
};

template <InstructionSet set>
DissipationKernelTable const& dissipation_kernels();

}  // namespace boltzmann
