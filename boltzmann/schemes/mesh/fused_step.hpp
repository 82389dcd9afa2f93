// Whole steps of particles on a mesh: gather, kick, rotate, drift and deposit in one pass over columns that are sorted
// in space. Positions are fixed-point numbers and deposits are integers, so no sum depends on its order.
#pragma once

#include <boltzmann/core/pack.hpp>
#include <boltzmann/schemes/mesh/spline.hpp>
#include <boltzmann/schemes/mesh/step_task.hpp>

#include <bit>
#include <cstddef>
#include <cstdint>
#include <type_traits>
#include <utility>

namespace boltzmann::detail {

template <class Real>
using Fixed = typename StepTask<Real>::Fixed;

/// Particles in a block: their weights and fields stay in the first-level cache.
inline constexpr std::size_t step_block = 128;

/// V numbers adjacent in memory: one register or a part of one.
template <class Number, int V>
struct side_by_side {
  typedef Number type __attribute__((vector_size(V * sizeof(Number)), may_alias));
};
template <class Number, int V>
using SideBySide = typename side_by_side<Number, V>::type;

/// a0 b0 a1 b1 ... from a and b: low and high half.
template <class Real, int W, std::size_t... Lane>
[[gnu::always_inline]] inline void interleave(Pack<Real, W> a, Pack<Real, W> b, Pack<Real, W>& low, Pack<Real, W>& high,
                                              std::index_sequence<Lane...>) {
  low = __builtin_shufflevector(a.native, b.native, (Lane / 2 + Lane % 2 * W)...);
  high = __builtin_shufflevector(a.native, b.native, (W / 2 + Lane / 2 + Lane % 2 * W)...);
}
template <class Real, int W, std::size_t... Lane>
[[gnu::always_inline]] inline void separate(Pack<Real, W> low, Pack<Real, W> high, Pack<Real, W>& even,
                                            Pack<Real, W>& odd, std::index_sequence<Lane...>) {
  even = __builtin_shufflevector(low.native, high.native, (2 * Lane)...);
  odd = __builtin_shufflevector(low.native, high.native, (2 * Lane + 1)...);
}

/// Transposes V packs (number k of particle i is in lane i of pack k) to and from W groups of V adjacent numbers.
template <int V, class Real, int W>
[[gnu::always_inline]] inline void to_groups(Pack<Real, W>* packs, Real* memory) {
  constexpr auto lanes = std::make_index_sequence<static_cast<std::size_t>(W)>{};
  if constexpr (V > 1) {
    // The halves of the numbers are interleaved last.
    Pack<Real, W> mixed[V];
    for (int k = 0; k < V / 2; ++k) interleave(packs[k], packs[k + V / 2], mixed[2 * k], mixed[2 * k + 1], lanes);
    if constexpr (V == 2) {
      for (int k = 0; k < 2; ++k) packs[k] = mixed[k];
    } else {
      // 2k holds (k, k + V/2) of the first half of the particles, 2k + 1 of the second: pairs are now the elements.
      Pack<Real, W> halves[2][V / 2];
      for (int k = 0; k < V / 2; ++k) halves[0][k] = mixed[2 * k], halves[1][k] = mixed[2 * k + 1];
      static_assert(V == 4);
      Pack<Real, W> out[4];
      for (int h = 0; h < 2; ++h) interleave(halves[h][0], halves[h][1], out[2 * h], out[2 * h + 1], lanes);
      for (int k = 0; k < 4; ++k) packs[k] = out[k];
    }
  }
  using Memory = SideBySide<Real, W>;
  for (int k = 0; k < V; ++k) reinterpret_cast<Memory*>(memory)[k] = packs[k].native;
}
template <int V, class Real, int W>
[[gnu::always_inline]] inline void from_groups(Real const* memory, Pack<Real, W>* packs) {
  constexpr auto lanes = std::make_index_sequence<static_cast<std::size_t>(W)>{};
  using Memory = SideBySide<Real, W>;
  for (int k = 0; k < V; ++k) packs[k] = reinterpret_cast<Memory const*>(memory)[k];
  for (int step = 1; step < V; step *= 2) {
    Pack<Real, W> next[V];
    for (int k = 0; k < V / 2; ++k) separate(packs[2 * k], packs[2 * k + 1], next[k], next[k + V / 2], lanes);
    for (int k = 0; k < V; ++k) packs[k] = next[k];
  }
}

/// Conversion between fixed-point and floating-point numbers, lane by lane.
template <class Real, int W>
struct FixedPack {
  using Integer = Fixed<Real>;
  using Native = typename register_of<Integer, W>::type;

  [[gnu::always_inline]] static Native load(Integer const* memory) {
    return *reinterpret_cast<SideBySide<Integer, W> const*>(memory);
  }
  [[gnu::always_inline]] static void store(Integer* memory, Native value) {
    *reinterpret_cast<SideBySide<Integer, W>*>(memory) = value;
  }
  /// Converts an integer in [0, 2^51) (float: 2^31).
  [[gnu::always_inline]] static Pack<Real, W> number(Native x) {
    if constexpr (std::is_same_v<Real, double>) {
      auto const high = std::bit_cast<std::int64_t>(0x1p52);
      return std::bit_cast<typename Pack<Real, W>::Native>(x | high) - 0x1p52;
    } else {
      return __builtin_convertvector(x, typename Pack<Real, W>::Native);
    }
  }
  /// The nearest integer; |x| below 2^51 (float: 2^31).
  [[gnu::always_inline]] static Native nearest(Pack<Real, W> x) {
    if constexpr (std::is_same_v<Real, double>) {
      auto const bits = std::bit_cast<std::int64_t>(0x1.8p52);
      return std::bit_cast<Native>(x.native + 0x1.8p52) - bits;
    } else {
      auto const away = select(x < Real(0), Pack<Real, W>(Real(-0.5)), Pack<Real, W>(Real(0.5)));
      return __builtin_convertvector((x + away).native, Native);
    }
  }
};

/// Adjacent lanes that become integers of 64 bits; |x| below 2^51 (float: 2^31).
template <int V, class Real>
[[gnu::always_inline]] inline auto counts(SideBySide<Real, V> x) {
  if constexpr (std::is_same_v<Real, double>) {
    SideBySide<double, V> const shifted = x + 0x1.8p52;
    return (SideBySide<std::int64_t, V>)shifted - std::bit_cast<std::int64_t>(0x1.8p52);
  } else {
    return __builtin_convertvector(__builtin_convertvector(x, SideBySide<std::int32_t, V>),
                                   SideBySide<std::int64_t, V>);
  }
}

/// Rounds x before the addition, so that only the other product of a sum can be fused with it, in every kernel alike.
/// (Finishing a step and continuing after it must give the same bits.)
template <class Native>
[[gnu::always_inline]] inline Native rounded_lanes(Native x) {
#if __has_builtin(__builtin_assoc_barrier)
  return __builtin_assoc_barrier(x);
#else
  return x;
#endif
}
template <class Real, int W>
[[gnu::always_inline]] inline Pack<Real, W> rounded(Pack<Real, W> x) {
  return rounded_lanes(x.native);
}

enum class StepPass {
  deposit,  ///< only deposit
  advance,  ///< one step
  finish,   ///< complete the second kick of a step, write the rows, and do the first kick of the next step with the
            ///< same field
};

template <StepPass pass, int D, int p, class Real, int W>
class FusedStep {
 public:
  using Task = StepTask<Real>;
  using Integer = Fixed<Real>;
  using Number = Pack<Real, W>;
  using Whole = FixedPack<Real, W>;
  static constexpr int P = slot_width(p);                       // nodes in a slot along x
  static constexpr int V = slot_numbers(D, p);                  // numbers in a slot of the field
  static constexpr int rows = D == 1 ? 1 : D == 2 ? p : p * p;  // rows of nodes along x

  explicit FusedStep(Task const& task) : task_(task) {}

  void run(std::size_t begin, std::size_t end) {
    for (std::size_t block = begin; block < end; block += step_block) {
      std::size_t const count = end - block < step_block ? end - block : step_block;
      if constexpr (pass == StepPass::deposit) {
        locate(block, count);
        deposit(count);
      } else {
        if (pass == StepPass::advance && task_.kicked) {
          move<true>(block, count);
        } else {
          locate(block, count);
          gather(count);
          move<false>(block, count);
        }
        if constexpr (pass == StepPass::advance) {
          locate(block, count);
          deposit(count);
        } else {
          write_rows(block, count, end);
        }
      }
    }
  }

  double fastest() const {
    double most = 0;
    for (int lane = 0; lane < W; ++lane) most = fastest_[lane] > most ? fastest_[lane] : most;
    return most;
  }
  bool failed() const { return any(failed_); }

 private:
  /// Finds the slots and weights of the particles of a block.
  [[gnu::always_inline]] void locate(std::size_t block, std::size_t count) {
    Integer const mask = (Integer(1) << task_.bits) - 1;
    Integer const half = p % 2 == 1 ? Integer(1) << (task_.bits - 1) : Integer(0);
    Number const unit = Real(1) / static_cast<Real>(Integer(1) << task_.bits);
    for (std::size_t i = 0; i < count; i += W) {
      typename Whole::Native cell[3];
      for (int a = 0; a < D; ++a) {
        auto const s = Whole::load(task_.position[a] + block + i) + half;
        cell[a] = s >> task_.bits;
        Number weights[p];
        spline_weights<p>(Whole::number(s & mask) * unit, weights);
        if (a == 0) {
          Number padded[P];
          for (int k = 0; k < P; ++k) padded[k] = k < p ? weights[k < p ? k : 0] : Number(Real(0));
          to_groups<P>(padded, along_x_ + i * P);
        } else {
          for (int k = 0; k < p; ++k)
            *reinterpret_cast<SideBySide<Real, W>*>(&across_[a - 1][k][i]) = weights[k].native;
        }
      }
      auto slot = cell[0];
      if constexpr (D == 2) slot += cell[1] * static_cast<Integer>(task_.slots_x);
      if constexpr (D == 3)
        slot += (cell[2] * static_cast<Integer>(task_.slots_y) + cell[1]) * static_cast<Integer>(task_.slots_x);
      Whole::store(slot_ + i, slot);
    }
  }

  /// Calls function(slot offset of the row, k_y, k_z) for every row of nodes along x in the range of a particle.
  template <class Function>
  [[gnu::always_inline]] void each_row(Function const& function) const {
    if constexpr (D == 1) {
      function(std::size_t{0}, 0, 0);
    } else if constexpr (D == 2) {
      for (int y = 0; y < p; ++y) function(static_cast<std::size_t>(y) * task_.slots_x, y, 0);
    } else {
      for (int z = 0; z < p; ++z)
        for (int y = 0; y < p; ++y)
          function((static_cast<std::size_t>(z) * task_.slots_y + static_cast<std::size_t>(y)) * task_.slots_x, y, z);
    }
  }
  /// The weight of a row for a particle of the block.
  [[gnu::always_inline]] Real across(int y, int z, std::size_t i) const {
    if constexpr (D == 1)
      return Real(1);
    else if constexpr (D == 2)
      return across_[0][y][i];
    else
      return across_[0][y][i] * across_[1][z][i];
  }

  [[gnu::always_inline]] void gather(std::size_t count) {
    using Slot = SideBySide<Real, V>;
    for (std::size_t i = 0; i < count; ++i) {
      auto const* field = reinterpret_cast<Slot const*>(task_.field) + slot_[i];
      Slot sum{};
      each_row([&](std::size_t offset, int y, int z) {
        if constexpr (D == 1)
          sum = field[offset];
        else
          sum += across(y, z, i) * field[offset];
      });
      *reinterpret_cast<Slot*>(gathered_ + i * V) = sum;
    }
  }

  [[gnu::always_inline]] void turn(Number* v) const {
    if constexpr (D == 2) {
      Number const x = rounded(Number(task_.turn[0]) * v[0]) + Number(task_.turn[1]) * v[1];
      v[1] = rounded(Number(task_.turn[3]) * v[0]) + Number(task_.turn[4]) * v[1];
      v[0] = x;
    } else if constexpr (D == 3) {
      Number turned[3];
      for (int a = 0; a < 3; ++a)
        turned[a] = rounded(Number(task_.turn[3 * a]) * v[0]) + Number(task_.turn[3 * a + 1]) * v[1] +
                    Number(task_.turn[3 * a + 2]) * v[2];
      for (int a = 0; a < 3; ++a) v[a] = turned[a];
    }
  }

  /// The field at W particles of a block: the gathered values, weighted along x.
  [[gnu::always_inline]] void feel(std::size_t i, Number* e) const {
    Number field[V], along[P];
    from_groups<V>(gathered_ + i * V, field);
    from_groups<P>(along_x_ + i * P, along);
    for (int a = 0; a < D; ++a) {
      e[a] = rounded(field[a * P] * along[0]);
      for (int k = 1; k < p; ++k) e[a] += field[a * P + k] * along[k];
    }
  }
  template <bool kicked>
  [[gnu::always_inline]] void move(std::size_t block, std::size_t count) {
    for (std::size_t i = 0; i < count; i += W) {
      Number v[D];
      for (int a = 0; a < D; ++a) v[a] = *reinterpret_cast<SideBySide<Real, W> const*>(task_.velocity[a] + block + i);
      if constexpr (!kicked) kick(i, v);
      if constexpr (pass == StepPass::advance) {
        Number square = Real(0);
        for (int a = 0; a < D; ++a) square += v[a] * v[a];
        Mask<Real, W> const failed = drift(block + i, v) | !(square <= Number(task_.fastest_allowed));
        failed_ = failed_ | (failed & particles(count - i));
        fastest_ = max(fastest_, select(particles(count - i), square, Number(Real(0))));
      }
      for (int a = 0; a < D; ++a) *reinterpret_cast<SideBySide<Real, W>*>(task_.velocity[a] + block + i) = v[a].native;
    }
  }
  /// The second kick of the last step if it is pending, and the first of the next one.
  [[gnu::always_inline]] void kick(std::size_t i, Number* v) {
    Number e[D], dv[D];
    feel(i, e);
    for (int a = 0; a < D; ++a) dv[a] = e[a] * Number(task_.kick) + Number(task_.push[a]);
    if (task_.pending) {
      for (int a = 0; a < D; ++a) v[a] += dv[a];
      if (task_.turns) turn(v);
    }
    if constexpr (pass == StepPass::finish)
      for (int a = 0; a < D; ++a) *reinterpret_cast<SideBySide<Real, W>*>(&now_[a][i]) = v[a].native;
    if (task_.turns) turn(v);
    for (int a = 0; a < D; ++a) v[a] += dv[a];
  }

  /// A mask of the lanes that hold particles.
  [[gnu::always_inline]] static Mask<Real, W> particles(std::size_t left) {
    Number lane;
    for (int l = 0; l < W; ++l) lane.native[l] = static_cast<Real>(l);
    return lane < Number(static_cast<Real>(left < W ? left : W));
  }

  /// Moves W particles, starting at `first`. Returns the lanes that have left the mesh.
  [[gnu::always_inline]] Mask<Real, W> drift(std::size_t first, Number* v) {
    using Native = typename Whole::Native;
    Mask<Real, W> failed = Number(Real(0)) != Number(Real(0));
    for (int a = 0; a < D; ++a) {
      Integer const end = task_.end[a];
      Native x = Whole::load(task_.position[a] + first) + Whole::nearest(v[a] * Number(task_.per_time[a]));
      switch (task_.boundary[a]) {
        case StepBoundary::wraps:
          x += x < 0 ? Native{} + end : Native{};
          x -= x >= end ? Native{} + end : Native{};
          break;
        case StepBoundary::reflects: {
          Native const below = x<0, above = x> end;
          x = below ? -x : above ? end - (x - end) : x;  // the integer 2 end may overflow
          v[a] = select(Mask<Real, W>{below | above}, -v[a], v[a]);
          break;
        }
        case StepBoundary::ends:
          break;
      }
      // Particles that are still outside have failed. Clamp them, so that they do not write outside the mesh.
      Native const outside = (x < 0) | (x > end);
      failed = failed | Mask<Real, W>{outside};
      Whole::store(task_.position[a] + first, outside ? Native{} : x);
    }
    return failed;
  }

  [[gnu::always_inline]] void deposit(std::size_t count) {
    using Weights = SideBySide<Real, P>;
    using Counts = SideBySide<std::int64_t, P>;
    auto const* weights = reinterpret_cast<Weights const*>(along_x_);
    for (std::size_t i = 0; i < count; ++i) {
      // Particles adjacent in memory are mostly in the same cell. Copies of the density avoid waiting for the previous
      // sum.
      auto* density = reinterpret_cast<Counts*>(task_.density) + static_cast<std::size_t>(slot_[i]) * task_.copies +
                      (i & (task_.copies - 1));
      Weights const along = weights[i] * task_.charge;
      each_row([&](std::size_t offset, int y, int z) {
        if constexpr (D == 1)
          density[0] += counts<P, Real>(along);
        else
          density[offset * task_.copies] += counts<P, Real>(along * across(y, z, i));
      });
    }
  }

  /// Writes the particles of a block to the rows, while they are in the cache.
  [[gnu::always_inline]] void write_rows(std::size_t block, std::size_t count, std::size_t end) {
    constexpr std::size_t ahead = 32;  // rows are in the user's order, so each may be a cache miss
    using Wide = SideBySide<double, W>;
    for (int a = 0; a < D; ++a)
      for (std::size_t i = 0; i < count; i += W)
        *reinterpret_cast<Wide*>(&place_[a][i]) =
            task_.low[a] + rounded_lanes<Wide>(exact(Whole::load(task_.position[a] + block + i)) * task_.part[a]);
    std::uint32_t const* const order = task_.order;
    std::size_t const stride = task_.stride, velocity = task_.row_velocity;
    double* const rows_of_all = task_.rows;
    for (std::size_t i = 0; i < count; ++i) {
      std::size_t const later = block + i + ahead;
      __builtin_prefetch(rows_of_all + stride * order[later < end ? later : end - 1], 1);
      double* const row = rows_of_all + stride * order[block + i];
      for (int a = 0; a < D; ++a) {
        row[a] = place_[a][i];
        row[velocity + static_cast<std::size_t>(a)] = static_cast<double>(now_[a][i]);
      }
    }
  }
  /// Integers in [0, 2^51).
  [[gnu::always_inline]] static SideBySide<double, W> exact(typename Whole::Native x) {
    if constexpr (std::is_same_v<Real, double>)
      return Whole::number(x).native;
    else
      return __builtin_convertvector(x, SideBySide<double, W>);
  }

  Task const task_;  // a copy, so that stores through pointers cannot change it
  Number fastest_ = Number(Real(0));
  Mask<Real, W> failed_ = Number(Real(0)) != Number(Real(0));
  alignas(64) Integer slot_[step_block];
  alignas(64) Real along_x_[step_block * P];
  alignas(64) Real across_[D == 1 ? 1 : D - 1][p][step_block];
  alignas(64) Real gathered_[step_block * V];
  alignas(64) Real now_[pass == StepPass::finish ? D : 1][step_block];  // velocities at the time between two steps
  alignas(64) double place_[pass == StepPass::finish ? D : 1][step_block];
};

template <StepPass pass, int D, int p, class Real, int W>
[[gnu::flatten]] void fused_step(StepTask<Real> const& task, StepResult& result, std::size_t begin, std::size_t end) {
  FusedStep<pass, D, p, Real, W> step(task);
  step.run(begin, end);
  double const fastest = step.fastest();
  result.fastest = fastest > result.fastest ? fastest : result.fastest;
  result.failed = result.failed || step.failed();
}

template <int D, int p, class Real, int W>
constexpr StepKernels<Real> step_kernels{fused_step<StepPass::deposit, D, p, Real, W>,
                                         fused_step<StepPass::advance, D, p, Real, W>,
                                         fused_step<StepPass::finish, D, p, Real, W>};

/// For every dimension and order.
template <class Real, int W>
constexpr StepKernelTable<Real> step_table{
    {{step_kernels<1, 1, Real, W>, step_kernels<1, 2, Real, W>, step_kernels<1, 3, Real, W>},
     {step_kernels<2, 1, Real, W>, step_kernels<2, 2, Real, W>, step_kernels<2, 3, Real, W>},
     {step_kernels<3, 1, Real, W>, step_kernels<3, 2, Real, W>, step_kernels<3, 3, Real, W>}}};

}  // namespace boltzmann::detail
