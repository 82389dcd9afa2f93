// The arguments of a pair kernel, as plain memory: one law between two ensembles.
#pragma once

#include <cstddef>
#include <cstdint>

namespace boltzmann {

class AnyEnsemble;
class Box;

/// One law between two ensembles, as plain memory. Outputs are indexed by the target's particle number.
struct PairTask {
  double const* target = nullptr;  ///< rows of the targets
  std::size_t targets = 0;
  std::size_t target_row_stride = 0;     ///< stride of target rows in doubles (not for lists)
  std::uint32_t const* order = nullptr;  ///< row -> particle number; null: they are the same
  double const* source = nullptr;        ///< rows of the sources
  std::size_t sources = 0;
  std::size_t source_row_stride = 0;
  bool overwrite = false;                     ///< store the influence instead of adding it
  bool same = false;                          ///< target and source are one ensemble: exclude self-interaction
  std::uint32_t const* const* row = nullptr;  ///< neighbour list: where each row starts; its entries are 4 times a row
  std::size_t target_block_stride = 0;        ///< stride of the blocks of a row in doubles (lists)
  std::size_t source_block_stride = 0;
  std::uint32_t const* length = nullptr;  ///< number of entries to read
  std::size_t const* start = nullptr;     ///< connections
  std::uint32_t const* index = nullptr;
  double cutoff2 = 0;                    ///< square of the cut-off (lists)
  double rounding = 0;                   ///< 3/2 2^52 times the quantum of the reversible form (lists)
  double zero_at = 0;                    ///< measuring: the distance at which energies are counted as zero; 0: infinity
  double period[3] = {0, 0, 0};          ///< length of periodic axes (connections)
  double inverse_period[3] = {0, 0, 0};  ///< its inverse, 0 on other axes
  double* influence = nullptr;
  double* energy = nullptr;      ///< measuring: half of each pair's energy
  double* virial = nullptr;      ///< measuring: 9 numbers per particle, half of each pair's -r_a F_b
  bool sheared = false;          ///< images along the gradient are displaced and move along the flow (connections):
  double up[3] = {0, 0, 0};      ///< 1 / length along the gradient, 0 along other axes
  double image[3] = {0, 0, 0};   ///< from a particle to its image one length up
  double faster[3] = {0, 0, 0};  ///< velocity of that image
  int velocity = -1;             ///< index in a row; -1: images have the same velocity
};

/// Sets the periods for nearest images of this ensemble's particles in the current box.
void find_images(PairTask& task, AnyEnsemble const& ensemble, Box const& box);

using PairKernel = void (*)(void const* law, PairTask const& task, std::size_t begin, std::size_t end);

/// The kernels of one law; null if a traversal is impossible.
struct PairKernels {
  PairKernel list = nullptr, list_reversible = nullptr, list_measure = nullptr;
  PairKernel all = nullptr, all_measure = nullptr;
  PairKernel connected = nullptr, connected_measure = nullptr;
  PairKernel few = nullptr;  ///< every pair once, with scalars: the fastest for few particles
  bool has_energy = false;
};

}  // namespace boltzmann
