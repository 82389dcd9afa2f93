// The data of pair dissipation on its ensembles and the pairs between them. Private to this module.
#pragma once

#include <boltzmann/dissipation/dissipation_kernels.hpp>
#include <boltzmann/dissipation/dissipation_point.hpp>
#include <boltzmann/dissipation/pair_dissipation.hpp>

#include <array>
#include <optional>
#include <string>
#include <vector>

namespace boltzmann {

/// Rows of an ensemble are processed in chunks of this size; output for a chunk belongs to it alone.
inline constexpr std::size_t dissipation_chunk = 8192;

/// Rows [begin, end) of one chunk, for one thread. Their sums are bit-for-bit those of processing the whole chunk at
/// once.
struct PairDissipation::Piece {
  std::size_t begin, end;

  std::size_t rows() const { return end - begin; }
  /// The first row of the chunk.
  std::size_t low() const { return begin / dissipation_chunk * dissipation_chunk; }
  bool operator==(Piece const&) const = default;
};

struct PairDissipation::Member {
  AnyEnsemble* ensemble;
  int mass, velocity, energy = -1, temperature = -1;  // offsets of these fields in a row; -1: missing
  std::optional<StateLaw> law;
  SortedCopy const* copy = nullptr;
  bool dissipates = false, at_fixed_temperature = false;
  AlignedVector<double> points;     // of the rows of the sorted copy
  AlignedVector<double> predicted;  // the corrector's last iteration: 4 numbers an owned row (see DissipationTask)
  std::vector<Piece> pieces;        // of the rows of this rank
  std::vector<double> energies;     // Shardlow's splitting: of the owned rows
  std::size_t first_chunk = 0;      // among those of all members

  int dimension() const { return ensemble->dimension(); }
  std::size_t stride() const { return dissipation_point_stride(dimension()); }
  std::size_t owned() const { return copy->owned(); }
  std::size_t chunks() const { return (owned() + dissipation_chunk - 1) / dissipation_chunk; }
  double* point(std::size_t row) { return points.data() + stride() * row; }
  // The offset of the velocity in a dissipation point.
  int velocity_at() const { return dimension() + 1; }
  int inverse_mass_at() const { return dimension(); }
  bool has_energy() const { return law.has_value() && !at_fixed_temperature; }
  void take_point(std::size_t row, double const* particle);
  void take_sentinel_and_images(int threads);
  void take_mean_velocities(int threads);
  void show_images(int first, int count);
  /// In a sheared box: changes the velocities of points to those of their rows (SortedCopy::ahead_in_flow()).
  void carry_along_flow();
  /// Names a particle in messages.
  std::string who(std::size_t row) const;
};

/// Rows [begin, begin + row.size()) of a chunk, which precede a piece and have pairs with it.
struct PairDissipation::Border {
  std::size_t begin = 0;
  std::vector<std::uint32_t> entries;
  std::vector<std::uint32_t const*> row;
  std::array<std::vector<std::uint32_t>, list_rings> length;
};

struct PairDissipation::Coupling {
  Member *target, *source;
  DissipationLaw dissipation;
  FormulaProgram typed;                             // of its formulas, if it has any, for the kernels in use
  std::size_t list;                                 // its number in the neighbourhood
  std::uint32_t number;                             // for random streams; the same for both directions
  bool first;                                       // targets are the first of the two ensembles
  std::size_t builds = ~std::size_t{0}, moves = 0;  // of the neighbourhood, when pairs were last read from its lists
  // For each piece of the targets (see DissipationTask):
  std::vector<std::vector<std::uint32_t>> entries;
  std::vector<Border> borders;
  // For the targets:
  std::vector<std::uint32_t const*> row;
  std::array<std::vector<std::uint32_t>, list_rings> length;

  bool same() const { return target == source; }
  bool vanishes() const { return dissipation.friction == 0 && dissipation.conduction == 0; }
  /// Brings the pairs of a piece up to date.
  void take_piece(std::size_t piece, NeighbourList const& neighbours);
  void take_border(std::size_t piece, NeighbourList const& neighbours);
  double mean_friction(double const* p, double const* q, double r2) const;
  PairNoise noise(StepContext const& context, double boltzmann_constant, std::uint32_t owner) const;
};

/// In the instruction set in use.
DissipationKernels const& dissipation_kernels_for(int dimension, bool projected);

}  // namespace boltzmann
