// What the kernels of the neighbour search are given, as plain memory.
#pragma once

#include <boltzmann/neighbours/grid.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

/// A neighbour list's rows are read as far as displacements demand: entries stand in so many rings of growing distance.
inline constexpr int list_rings = 3;
/// Rows are padded to a multiple of it.
inline constexpr std::size_t list_padding = 8;
/// What kernels may read behind the last candidate.
inline constexpr std::size_t candidate_padding = 16;

/// Positions are compared as whole numbers of steps, so many in the reach of a sorted copy, modulo 2^32: differences
/// are exact, however far from the origin, and where two that are 4096 reaches apart look near, the pair kernel's
/// cut-off knows better.
inline constexpr double steps_of_reach = 1 << 20;

/// Where candidates are: columns of positions, `candidate_padding` readable ones behind them, and the item of each.
struct Candidates {
  std::int32_t const* position[3] = {};
  std::uint32_t const* item = nullptr;
};

struct NearTask {
  Grid const* grid = nullptr;
  std::uint32_t const* start = nullptr;  ///< of each cell in `sorted`
  Candidates sorted;                     ///< in the order of cells
  Candidates moved;                      ///< those that have left their cell, asked by everyone
  std::uint32_t moved_count = 0;
  double const* reference = nullptr;              ///< positions of the targets, rows of 4
  std::int32_t const* reference_steps = nullptr;  ///< the same in steps, rows of 4
  bool same = false;                              ///< target i is the candidate item_of_row(i)
  double steps_per_length = 0;
  double reach = 0;
  double ring[list_rings] = {};  ///< radii, the last is `reach`
  std::uint32_t sentinel = 0;    ///< the item that pads
};

/// How lists and candidates name a row of a sorted copy: where it starts in an array of blocks.
[[gnu::always_inline]] inline std::uint32_t item_of_row(std::size_t row) { return static_cast<std::uint32_t>(4 * row); }
[[gnu::always_inline]] inline std::size_t row_of_item(std::uint32_t item) { return item / 4; }

/// a - b in steps.
[[gnu::always_inline]] inline std::int32_t wrapped_difference(std::int32_t a, std::int32_t b) {
  return static_cast<std::int32_t>(static_cast<std::uint32_t>(a) - static_cast<std::uint32_t>(b));
}

/// What is found. Room is not made here: a kernel stops before the targets for which it may be too little.
struct NearRows {
  std::uint32_t* index = nullptr;  ///< rows of items, padded
  std::size_t used = 0, room = 0;
  /// Scratch, room for `scratch` candidates in each: positions and items of those near a group of targets; items of
  /// those beyond the first ring.
  float* near_position[3] = {};
  std::uint32_t* near_item = nullptr;
  std::uint32_t* shell_item[list_rings] = {};
  std::size_t scratch = 0;
  std::size_t* offset = nullptr;  ///< of each row in `index`, those of `first` and the following
  std::size_t first = 0;
  std::uint32_t* length = nullptr;  ///< of each row up to ring r: length[r * rows + row]
  std::size_t rows = 0;
  char* marks = nullptr;  ///< if asked for, of source rows: 1 becomes that of all who are found, and of some near them
  std::size_t wanted = 0,
              wanted_scratch = 0;  ///< what there must be for the targets before which the kernel has stopped
};

/// Finds the neighbours of the targets [begin, end), in ascending order of ring, cell and place; returns the first
/// target that is not done.
using NearKernel = std::size_t (*)(NearTask const& task, std::size_t begin, std::size_t end, NearRows& out);

/// A sorted copy's rows brought up to date. Each block of 4 doubles of the rows has an array of its own.
struct RefreshTask {
  double const* ensemble = nullptr;      ///< rows in the user's order
  std::uint32_t const* order = nullptr;  ///< which of them each mirrored row is
  std::size_t stride = 0;                ///< doubles of a row
  double* copy = nullptr;
  std::size_t block_stride = 0;       ///< from one block of a mirrored row to the next
  double const* reference = nullptr;  ///< rows of 4
  int dimension = 0;
  double period[4] = {0, 0, 0, 0}, inverse_period[4] = {0, 0, 0, 0};
};
struct Refreshed {
  double largest2 = 0;   ///< square of the largest displacement from the reference
  bool finite = true;    ///< all positions are
  bool changed = false;  ///< a position is another than before
};
using RefreshKernel = Refreshed (*)(RefreshTask const& task, std::size_t begin, std::size_t end);
/// Rows that have come from elsewhere: the first of `task.ensemble` becomes row rows[0], the next row rows[1], ...
using PlaceKernel = void (*)(RefreshTask const& task, std::uint32_t const* rows, std::size_t count);

/// Images brought up to date, blocks [first_block, last_block) of them: in the first `mapped_blocks` of all, row
/// `first` + g becomes sign * x + shift of row source[g], both from row turns[g] of tables that have so many blocks a
/// row; the others are copied.
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
