// The kernels of the dissipation of pairs, as plain memory and function pointers.
#pragma once

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/core/pack_random.hpp>
#include <boltzmann/dissipation/dissipation_law.hpp>
#include <boltzmann/formulas/formula_program.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// The numbers of one dissipation in one step, and the key of its noise.
struct PairNoise {
  Convention convention = Convention::constant_friction;
  double inverse_range = 0, range2 = 0;
  double exponent = 0;      ///< of chi
  int twice_exponent = -1;  ///< the same if it is a small multiple of 1/2, else -1
  double friction = 0;      ///< gamma dt
  double amplitude = 0;     ///< of noise: the root of 2 gamma k dt, times T_ref if the convention has it
  double temperature = 0;   ///< T_ref
  double boltzmann_constant = 0;
  double conduction = 0;                  ///< kappa dt
  double conduction_noise = 0;            ///< sqrt(2 k kappa dt)
  FormulaProgram const* typed = nullptr;  ///< that of a TypedFriction, or null
  bool of_temperature = false;            ///< its friction depends on T
  double greatest_square = 0;             ///< as in TypedFriction
  bool same = true;  ///< a pair of one ensemble; else targets belong to the first or to the second of two
  bool first = true;
  std::uint64_t step = 0, tag = 0;  ///< words of the counter besides the two numbers
  PhiloxKey key;
};

/// Order-free: for target rows [begin, end), the contributions to them and their neighbours are added to the sums of
/// `rows` rows from `first` on. Four numbers a row: the momentum it gains (dimension numbers), then the energy that it
/// loses. Within one ensemble (noise.same) a pair is listed once, in the row of the first, and both get their parts;
/// sums have one extra row for padding.
struct DissipationTask {
  double const *target = nullptr, *source = nullptr;  ///< dissipation points
  std::uint32_t const* number = nullptr;              ///< the particle of each target row
  /// For each target from `listed` on: groups of 8 entries, which are 4 times a source row, each group followed by the
  /// 8 numbers of these particles.
  std::uint32_t const* const* row = nullptr;
  std::uint32_t const* length = nullptr;  ///< entries
  std::size_t listed = 0;
  std::size_t begin = 0, end = 0;
  std::size_t first = 0, rows = 0;
  double* sums = nullptr;
  double asymmetry = 0;  ///< 1/4: i pays |dp|^2 (1/mj - 1/mi); 0: not
  PairNoise noise;
};

/// A pair, for Shardlow's splitting: the rows of both, and the row (owned or an image) of the second as a neighbour of
/// the first.
struct DissipationPair {
  std::uint32_t first, second, seen;
};

/// Shardlow's splitting: for `count` pairs chi (zero out of range; for typed friction its strength), the direction from
/// second to first (unit vector; not if unprojected), and normals: one (projected) or one per dimension, and one more
/// with heat conduction.
struct GeometryTask {
  double const *first = nullptr, *second = nullptr;                       ///< dissipation points
  std::uint32_t const *first_number = nullptr, *second_number = nullptr;  ///< the particle of each (owned) row
  DissipationPair const* pairs = nullptr;
  std::size_t count = 0;      ///< at most geometry_block
  double* columns = nullptr;  ///< chi, 3 of the direction, 4 normals, chi of conduction: geometry_block each. For
                              ///< friction that depends on T chi is only 1 or zero, and is followed by the square of
                              ///< the distance.
  PairNoise noise;
};
inline constexpr std::size_t geometry_block = 256;
inline constexpr std::size_t geometry_columns = 9, weight_column = 8;

struct DissipationKernels {
  void (*simultaneous)(DissipationTask const& task) = nullptr;
  void (*geometry)(GeometryTask const& task) = nullptr;
  int code_width = 0;  ///< width of machine code for these kernels; 0: none
};

/// For 1D, 2D, 3D; unprojected, projected.
struct DissipationKernelTable {
  DissipationKernels of[3][2];
};

template <InstructionSet set>
DissipationKernelTable const& dissipation_kernels();

}  // namespace boltzmann
