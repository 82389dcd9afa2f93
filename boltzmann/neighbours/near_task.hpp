// Inputs and outputs of the kernels of the neighbour search, as plain memory.
#pragma once

#include <boltzmann/neighbours/grid.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// A neighbour list's rows are read only as far as displacements require: entries are in this number of rings of
/// growing distance.
inline constexpr int list_rings = 3;
/// Rows are padded to a multiple of this number.
inline constexpr std::size_t list_padding = 8;
/// Readable elements after the last candidate.
inline constexpr std::size_t candidate_padding = 16;

/// Positions are compared as integer steps, this many in the reach of a sorted copy, modulo 2^32. So differences are
/// exact at any distance from the origin. Two particles 4096 reaches apart may look near; the cut-off of the pair
/// kernel rejects them.
inline constexpr double steps_of_reach = 1 << 20;

/// Candidates: columns of positions, followed by `candidate_padding` readable ones, and the item of each.
struct Candidates {
  std::int32_t const* position[3] = {};
  std::uint32_t const* item = nullptr;
};

struct NearTask {
  Grid const* grid = nullptr;
  std::uint32_t const* start = nullptr;  ///< of each cell, in `sorted`
  Candidates sorted;                     ///< in the order of cells
  Candidates moved;                      ///< rows that have left their cell, tested by every target
  std::uint32_t moved_count = 0;
  double const* reference = nullptr;              ///< positions of the targets, 4 numbers a row
  std::int32_t const* reference_steps = nullptr;  ///< the same in steps, 4 numbers a row
  bool same = false;                              ///< target i is the candidate item_of_row(i)
  double steps_per_length = 0;
  double reach = 0;
  double ring[list_rings] = {};  ///< radii, the last one is `reach`
  std::uint32_t sentinel = 0;    ///< the item for padding
};

/// The number of a row of a sorted copy in lists and candidates: its offset in an array of blocks.
[[gnu::always_inline]] inline std::uint32_t item_of_row(std::size_t row) { return static_cast<std::uint32_t>(4 * row); }
[[gnu::always_inline]] inline std::size_t row_of_item(std::uint32_t item) { return item / 4; }

/// a - b in steps.
[[gnu::always_inline]] inline std::int32_t wrapped_difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

/// The results. Kernels do not allocate: a kernel stops before the targets for which the memory may be too small.
struct NearRows {
  std::uint32_t* index = nullptr;  ///< rows of items, padded
  std::size_t used = 0, room = 0;
  /// Scratch memory for `scratch` candidates each: positions and items near a group of targets, and items beyond the
  /// first ring.
  float* near_position[3] = {};
  std::uint32_t* near_item = nullptr;
  std::uint32_t* shell_item[list_rings] = {};
  std::size_t scratch = 0;
  std::size_t* offset = nullptr;  ///< of each row in `index`, from row `first` on
  std::size_t first = 0;
  std::uint32_t* length = nullptr;  ///< of each row up to ring r: length[r * rows + row]
  std::size_t rows = 0;
  char* marks = nullptr;  ///< if not null, of source rows: set to 1 for all that are found, and for some near them
  std::size_t wanted = 0,
              wanted_scratch = 0;  ///< the size needed for the targets at which the kernel has stopped
};

/// Finds the neighbours of the targets [begin, end), in ascending order of ring, cell and place; returns the first
/// target that is not done.
using NearKernel = std::size_t (*)(NearTask const& task, std::size_t begin, std::size_t end, NearRows& out);

/// Refreshes a sorted copy's rows. Each block of 4 doubles of the rows has an array of its own.
struct RefreshTask {
  double const* ensemble = nullptr;      ///< rows in the order of particles
  std::uint32_t const* order = nullptr;  ///< the particle of each row of the copy
  std::size_t stride = 0;                ///< doubles from row to row
  double* copy = nullptr;
  std::size_t block_stride = 0;       ///< from one block of a row of the copy to the next
  double const* reference = nullptr;  ///< 4 numbers a row
  int dimension = 0;
  double period[4] = {0, 0, 0, 0}, inverse_period[4] = {0, 0, 0, 0};
};
struct Refreshed {
  double largest2 = 0;   ///< square of the largest displacement from the reference
  bool finite = true;    ///< all positions are
  bool changed = false;  ///< a position differs from before
};
using RefreshKernel = Refreshed (*)(RefreshTask const& task, std::size_t begin, std::size_t end);
/// Places rows that were received: the first of `task.ensemble` becomes row rows[0], the next row rows[1], ...
using PlaceKernel = void (*)(RefreshTask const& task, std::uint32_t const* rows, std::size_t count);

/// Refreshes images, blocks [first_block, last_block). In the first `mapped_blocks` of all, row `first` + g becomes
/// sign * x + shift of row source[g]; sign and shift are row turns[g] of tables with this number of blocks a row. Other
/// blocks are copied.
struct ImageTask {
  double* copy = nullptr;
  std::size_t block_stride = 0, first_block = 0, last_block = 0, mapped_blocks = 0, first = 0;
  std::uint32_t const* source = nullptr;
  std::uint32_t const* turns = nullptr;
  double const* sign = nullptr;
  double const* shift = nullptr;
};
using ImageKernel = void (*)(ImageTask const& task, std::size_t begin, std::size_t end);

struct NeighbourKernels {
  NearKernel near[3];  ///< in 1D, 2D, 3D
  RefreshKernel refresh;
  PlaceKernel place;
  ImageKernel images;
};

}  // namespace boltzmann
