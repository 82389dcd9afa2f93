// Near rows: the search for the neighbours of particles, W candidates at a time. Kernels and plain memory only.
#pragma once

#include <boltzmann/core/compress.hpp>
#include <boltzmann/neighbours/near_task.hpp>

#include <cstddef>
#include <cstdint>

namespace boltzmann {

namespace detail {

/// W steps.
template <int W>
using Steps = typename register_of<std::int32_t, W>::type;
/// Differences are modulo 2^32: overflow of signed numbers would have no meaning.
template <int W>
[[gnu::always_inline]] inline Steps<W> less(Steps<W> a, Steps<W> b) {
  return (Steps<W>)((LaneWords<W>)a - (LaneWords<W>)b);
}
template <int W>
[[gnu::always_inline]] inline Steps<W> load_steps(std::int32_t const* from) {
  Steps<W> steps;
  __builtin_memcpy(&steps, from, sizeof(steps));
  return steps;
}
template <int W>
[[gnu::always_inline]] inline Pack<float, W> to_float(Steps<W> steps) {
  return __builtin_convertvector(steps, typename Pack<float, W>::Native);
}

/// The first `count` lanes of W.
template <int W>
[[gnu::always_inline]] inline LaneBits first_lanes(std::uint32_t count) {
  return count >= W ? (1U << W) - 1U : (1U << count) - 1U;
}

inline double squared(double x) { return x * x; }

/// A block in space.
struct Block {
  double least[3] = {}, greatest[3] = {};
};
/// The end of a group of consecutive targets whose block is at most this long.
template <int D>
[[gnu::always_inline]] inline std::size_t end_of_group(NearTask const& task, std::size_t first, std::size_t end,
                                                       double const (&longest)[3], Block& block) {
  constexpr std::size_t group_size = 16;
  for (int a = 0; a < D; ++a) block.least[a] = block.greatest[a] = task.reference[4 * first + a];
  std::size_t last = first + 1;
  for (; last < end && last < first + group_size; ++last) {
    double low[3] = {}, high[3] = {};
    bool fits = true;
    for (int a = 0; a < D; ++a) {
      double const x = task.reference[4 * last + a];
      low[a] = x < block.least[a] ? x : block.least[a];
      high[a] = x > block.greatest[a] ? x : block.greatest[a];
      fits = fits && high[a] - low[a] <= longest[a];
    }
    if (!fits) break;
    for (int a = 0; a < D; ++a) block.least[a] = low[a], block.greatest[a] = high[a];
  }
  return last;
}

/// The same block in steps: its lower corner and its extent.
struct BlockInSteps {
  std::int32_t corner[3] = {}, extent[3] = {};
};
template <int D>
[[gnu::always_inline]] inline BlockInSteps in_steps(NearTask const& task, std::size_t first, std::size_t last) {
  BlockInSteps block;
  for (int a = 0; a < D; ++a) {
    std::int32_t const* steps = task.reference_steps + a;
    block.corner[a] = steps[4 * first];
    for (std::size_t i = first + 1; i < last; ++i) {
      std::int32_t const d = wrapped_difference(steps[4 * i], block.corner[a]);
      if (d < 0) {
        block.extent[a] -= d;
        block.corner[a] = steps[4 * i];
      } else if (d > block.extent[a]) {
        block.extent[a] = d;
      }
    }
  }
  return block;
}

/// Appends to `near` the candidates k to end_of_range within the square of a reach of the block: items, and positions
/// relative to its corner. Returns the new number.
template <int W, int D>
[[gnu::always_inline]] inline std::uint32_t gather(Candidates const& among, std::uint32_t k, std::uint32_t end_of_range,
                                                   BlockInSteps const& block, float reach2,
                                                   float* const (&near_position)[3], std::uint32_t* near_item,
                                                   std::uint32_t near) {
  for (; k < end_of_range; k += W) {
    Pack<float, W> relative[D], square = 0.0F;
    for (int a = 0; a < D; ++a) {
      auto const steps = less<W>(load_steps<W>(among.position[a] + k), Steps<W>{} + block.corner[a]);
      relative[a] = to_float<W>(steps);
      auto const beyond = less<W>(steps, Steps<W>{} + block.extent[a]), before = less<W>(Steps<W>{}, steps);
      auto out_of = beyond > before ? beyond : before;
      out_of = out_of > 0 ? out_of : Steps<W>{};
      auto const distance = to_float<W>(out_of);
      square += distance * distance;
    }
    LaneBits const bits = lanes_below(square, reach2) & first_lanes<W>(end_of_range - k);
    for (int a = 0; a < D; ++a) store_selected<W>(near_position[a] + near, relative[a], bits);
    store_selected<W>(near_item + near, load_words<W>(among.item + k), bits);
    near += count_of(bits);
  }
  return near;
}

/// Atomic, as other threads may mark the same rows.
inline void mark_rows(std::uint32_t const* items, std::uint32_t count, char* marks) {
#pragma GCC unroll 8
  for (std::uint32_t n = 0; n < count; ++n) __atomic_store_n(marks + row_of_item(items[n]), char{1}, __ATOMIC_RELAXED);
}

/// Appends the outer rings of a target's row to the innermost ring, and records the start of the row and its length up
/// to each ring.
template <int W>
[[gnu::always_inline]] inline void finish_row(NearRows& out, std::size_t i,
                                              std::uint32_t* const (&ring_end)[list_rings],
                                              std::uint32_t* const (&shell_item)[list_rings], std::uint32_t sentinel) {
  std::uint32_t *const row = out.index + out.used, *next = ring_end[0], *length = out.length + i;
  *length = static_cast<std::uint32_t>(next - row);
  for (int r = 1; r < list_rings; ++r) {
    auto const count = static_cast<std::size_t>(ring_end[r] - shell_item[r - 1]);
    for (std::size_t k = 0; k < count; k += W) {
      auto const words = load_words<W>(shell_item[r - 1] + k);
      __builtin_memcpy(next + k, &words, sizeof(words));
    }
    next += count;
    length += out.rows;
    *length = static_cast<std::uint32_t>(next - row);
  }
  for (std::size_t k = 0; k < list_padding; ++k) next[k] = sentinel;
  out.offset[i - out.first] = out.used;
  out.used += (static_cast<std::size_t>(next - row) + list_padding - 1) / list_padding * list_padding;
}

/// Consecutive targets, which are near each other, share the search. Candidates within reach of their block are copied
/// contiguously, in single precision relative to the block's corner; each target then tests these. Radii are enlarged
/// by the rounding to steps.
template <int W, int D>
[[gnu::flatten]] std::size_t near_rows(NearTask const& task, std::size_t begin, std::size_t end,
                                       NearRows& out) {  // long: one search, whose parts share a dozen numbers
  double longest[3];
  for (int a = 0; a < 3; ++a) longest[a] = largest_block[a] * task.reach;
  Grid const grid = *task.grid;
  float ring2[list_rings];
  for (int r = 0; r < list_rings; ++r)
    ring2[r] = static_cast<float>(squared(task.ring[r] * task.steps_per_length * (1 + 1e-6) + 4));
  // Local copies, which the compiler keeps in registers.
  float* const near_position[3] = {out.near_position[0], out.near_position[1], out.near_position[2]};
  std::uint32_t* const near_item = out.near_item;
  std::uint32_t* shell_item[list_rings];
  for (int r = 0; r + 1 < list_rings; ++r) shell_item[r] = out.shell_item[r];
  for (std::size_t first = begin; first < end;) {
    Block around;
    std::size_t const last = end_of_group<D>(task, first, end, longest, around);
    std::uint32_t from[Grid::most_runs], to[Grid::most_runs], ranges = 0, candidates = task.moved_count;
    grid.near(around.least, around.greatest, task.reach, [&](std::size_t first_cell, std::size_t last_cell) {
      from[ranges] = task.start[first_cell];
      to[ranges] = task.start[last_cell + 1];
      candidates += to[ranges] - from[ranges];
      ranges += from[ranges] != to[ranges] ? 1 : 0;
    });
    out.wanted_scratch = candidates + 2 * W;
    out.wanted = (last - first) * (candidates + 2 * W);
    if (out.wanted_scratch > out.scratch || out.used + out.wanted > out.room) return first;
    BlockInSteps const block = in_steps<D>(task, first, last);
    std::uint32_t near = 0;
    for (std::uint32_t n = 0; n < ranges; ++n)
      near = gather<W, D>(task.sorted, from[n], to[n], block, ring2[list_rings - 1], near_position, near_item, near);
    near = gather<W, D>(task.moved, 0, task.moved_count, block, ring2[list_rings - 1], near_position, near_item, near);
    if (out.marks) mark_rows(near_item, near, out.marks);

    for (std::size_t i = first; i < last; ++i) {
      Pack<float, W> at[D];
      for (int a = 0; a < D; ++a)
        at[a] = static_cast<float>(wrapped_difference(task.reference_steps[4 * i + a], block.corner[a]));
      auto const self = task.same ? item_of_row(i) : 0xffffffffU;
      std::uint32_t* ring_end[list_rings];
      for (int r = 0; r < list_rings; ++r) ring_end[r] = r == 0 ? out.index + out.used : shell_item[r - 1];
      for (std::uint32_t k = 0; k < near; k += W) {
        Pack<float, W> square = 0.0F;
        for (int a = 0; a < D; ++a) {
          auto const d = load_pack<W>(near_position[a] + k) - at[a];
          square = a == 0 ? d * d : square + d * d;
        }
        auto const items = load_words<W>(near_item + k);
        LaneBits left = first_lanes<W>(near - k) & ~lanes_equal<W>(items, self);
        for (int r = 0; r < list_rings; ++r) {
          LaneBits const ring = lanes_below(square, ring2[r]) & left;
          left &= ~ring;
          store_selected<W>(ring_end[r], items, ring);
          ring_end[r] += count_of(ring);
        }
      }
      finish_row<W>(out, i, ring_end, shell_item, task.sentinel);
    }
    first = last;
  }
  return end;
}

/// Moves rows of particles to the periodic image nearest to their references.
class RowPlacer {
 public:
  using Four = Pack<double, 4>;
  explicit RowPlacer(RefreshTask const& task)
      : task_(task), period_(load_pack<4>(task.period)), inverse_(load_pack<4>(task.inverse_period)) {
    for (int a = 0; a < 4; ++a) coordinate_.native[a] = a < task.dimension ? -1 : 0, changed_.native[a] = 0;
  }

  /// Places row k from a particle's row; returns the square of its displacement.
  double operator()(double const* from, std::size_t k) {
    constexpr double to_integer =
        6755399441055744.0;  // 3/2 2^52: adding and subtracting it rounds to the nearest integer
    double* to = task_.copy + 4 * k;
    Four const reference = load_pack<4>(task_.reference + 4 * k), zero = 0.0;
    Four row = load_pack<4>(from);
    Four const turns = ((row - reference) * inverse_ + to_integer) - to_integer;
    row = select(coordinate_, row - turns * period_, row);
    Four const moved = select(coordinate_, row - reference, zero);
    changed_ = changed_ | (row != load_pack<4>(to));
    __builtin_memcpy(to, &row, sizeof(row));
    for (std::size_t c = 4; c < task_.stride; c += 4) {
      to += task_.block_stride;
      Four const more = load_pack<4>(from + c);
      __builtin_memcpy(to, &more, sizeof(more));
    }
    Four const squares = moved * moved;
    return squares.native[0] + squares.native[1] + squares.native[2];
  }
  bool changed() const { return any(changed_); }

 private:
  RefreshTask const task_;  // a local copy, which the compiler keeps in registers
  Four const period_, inverse_;
  Mask<double, 4> coordinate_, changed_;
};

template <int W>
[[gnu::flatten]] Refreshed refresh_rows(RefreshTask const& task, std::size_t begin, std::size_t end) {
  constexpr std::size_t ahead = 12;
  RowPlacer place(task);
  Refreshed result;
  double largest = 0;
  bool finite = true;
  for (std::size_t k = begin; k < end; ++k) {
    if (k + ahead < end) __builtin_prefetch(task.ensemble + task.order[k + ahead] * task.stride);
    double const square = place(task.ensemble + task.order[k] * task.stride, k);
    largest = square > largest ? square : largest;
    finite = finite && square < __builtin_inf();
  }
  result.largest2 = largest;
  result.finite = finite;
  result.changed = place.changed();
  return result;
}

template <int W>
[[gnu::flatten]] void place_rows(RefreshTask const& task, std::uint32_t const* rows, std::size_t count) {
  RowPlacer place(task);
  for (std::size_t n = 0; n < count; ++n) place(task.ensemble + n * task.stride, rows[n]);
}

template <int W>
[[gnu::flatten]] void move_images(ImageTask const& task, std::size_t begin, std::size_t end) {
  // Local copies, which the compiler keeps in registers.
  std::size_t const stride = task.block_stride, mapped = task.mapped_blocks, last = task.last_block;
  std::size_t const first_mapped = task.first_block, end_mapped = mapped < last ? mapped : last;
  std::size_t const first_copied = task.first_block > mapped ? task.first_block : mapped;
  double* const rows = task.copy + task.first_block * stride;
  double* const images = rows + 4 * task.first;
  double const *const sign = task.sign, *const shift = task.shift;
  std::uint32_t const *const source = task.source, *const turns = task.turns;
  if (last == 1 && mapped == 1) {  // positions only
    for (std::size_t g = begin; g < end; ++g) {
      std::size_t const map = 4 * static_cast<std::size_t>(turns[g]);
      double const* const from = rows + 4 * static_cast<std::size_t>(source[g]);
      auto const image = load_pack<4>(from) * load_pack<4>(sign + map) + load_pack<4>(shift + map);
      __builtin_memcpy(images + 4 * g, &image, sizeof(image));
    }
    return;
  }
  for (std::size_t g = begin; g < end; ++g) {
    double const* from = rows + 4 * static_cast<std::size_t>(source[g]);
    double* to = images + 4 * g;
    std::size_t const map = 4 * mapped * static_cast<std::size_t>(turns[g]);
    for (std::size_t b = first_mapped; b < end_mapped; ++b) {
      auto const image = load_pack<4>(from) * load_pack<4>(sign + map + 4 * b) + load_pack<4>(shift + map + 4 * b);
      __builtin_memcpy(to, &image, sizeof(image));
      from += stride;
      to += stride;
    }
    for (std::size_t b = first_copied; b < last; ++b) {
      auto const same = load_pack<4>(from);
      __builtin_memcpy(to, &same, sizeof(same));
      from += stride;
      to += stride;
    }
  }
}

}  // namespace detail
}  // namespace boltzmann
