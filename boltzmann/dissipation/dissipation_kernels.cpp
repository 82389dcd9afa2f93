// Kernels of the dissipation of pairs.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/dissipation/dissipation_kernels.hpp>
#include <boltzmann/dissipation/dissipation_point.hpp>
#include <boltzmann/dissipation/strength.hpp>
#include <boltzmann/formulas/evaluate.hpp>
#include <boltzmann/neighbours/near_task.hpp>
#include <boltzmann/particles/rows.hpp>

#include <array>

namespace boltzmann {
namespace detail {

template <int W>
using Reals = Pack<double, W>;

/// chi = x^exponent, x = 1 - r / range; `x` is zero or more.
template <int W>
[[gnu::always_inline]] inline Reals<W> weight_of(Reals<W> x, PairNoise const& noise) {
  if (noise.twice_exponent < 0) return pow(max(x, Reals<W>(1e-300)), Reals<W>(noise.exponent));
  Reals<W> chi = (noise.twice_exponent & 1) ? sqrt(x) : Reals<W>(1.0);
  for (int k = noise.twice_exponent; k > 1; k -= 2) chi *= x;
  return chi;
}

/// 1, or -1 where the numbers of the pair are in reverse order: the sign of noise along axes.
template <int W>
[[gnu::always_inline]] inline Reals<W> order_of(Words<W> target, Words<W> source, PairNoise const& noise) {
  if (!noise.same) return noise.first ? 1.0 : -1.0;
  Bits<W> const swapped = (Bits<W>)target > (Bits<W>)source;
  return from_bits<W>(bits_of<W>(Reals<W>(1.0)) | (swapped & sign_bit));
}

/// `count` normals of a pair of particles with these numbers, the same in either order.
template <int W, int count>
[[gnu::always_inline]] inline void draw_normals(Words<W> target, Words<W> source, PairNoise const& noise,
                                                Reals<W> (&normal)[count + count % 2]) {
  RandomWords<W> counter;
  if (noise.same) {
    auto const swapped = (Bits<W>)target > (Bits<W>)source;
    counter.word[0] = swapped ? source : target;
    counter.word[1] = swapped ? target : source;
  } else {
    counter.word[0] = noise.first ? target : source;
    counter.word[1] = noise.first ? source : target;
  }
  counter.word[2] = Words<W>{} + noise.step;
  counter.word[3] = Words<W>{} + noise.tag;
  auto const words = philox4x32<W>(counter, noise.key);
  auto const first = normals<W>(words.word[0], words.word[1]);
  normal[0] = first[0];
  normal[1] = first[1];
  if constexpr (count > 2) {
    auto const second = normals<W>(words.word[2], words.word[3]);
    normal[2] = second[0];
    normal[3] = second[1];
  }
}

template <int W>
struct narrow_of {
  typedef std::uint32_t type __attribute__((vector_size(4 * W), aligned(4), may_alias));
};
template <int W>
using Narrow = typename narrow_of<W>::type;

/// W numbers of 32 bits, each in a lane of 64.
template <int W>
[[gnu::always_inline]] inline Words<W> widened(std::uint32_t const* numbers) {
  return __builtin_convertvector(*reinterpret_cast<Narrow<W> const*>(numbers), Words<W>);
}

/// The exchange between two particles: the momentum of one from the other, the energy that both lose, and the further
/// energy that the first loses and the second gains.
template <int W, int D>
struct Exchange {
  Vector<D, Reals<W>> momentum;
  Reals<W> loss, transfer;
};

// ---- Typed friction ----

/// The results of its program for this number of pairs are contiguous.
inline constexpr std::size_t typed_results = 3;

/// Runs the program of typed friction for `count` pairs, at most block_pairs, with points `p(lane)` and `q(lane)`. The
/// results of pair k are written to out[k], out[stride + k], ...
template <int W, int D, class P, class Q>
[[gnu::always_inline]] inline void run_typed(Workspace<W>& work, PairNoise const& noise, std::size_t count, P const& p,
                                             Q const& q, double* out, std::size_t stride) {
  FormulaProgram const& program = *noise.typed;
  std::size_t const packs = (count + W - 1) / W;
  for (std::size_t k = 0; k < packs; ++k) {
    auto const a = p(k * W), b = q(k * W);
    Reals<W> const square = norm2(a.position - b.position);
    store_pack<W>(work.column(0) + k * W, min(max(square, Reals<W>(least_square)), Reals<W>(noise.greatest_square)));
    store_pack<W>(work.column(1) + k * W, 2.0 / (a.inverse_temperature + b.inverse_temperature));
  }
  run_program<W>(work, program, packs);
  for (std::size_t c = 0; c < typed_results; ++c) {
    double const* const from = work.place(program.results[c]);
    std::size_t const step = stride_of<W>(program.results[c]);
    for (std::size_t k = 0; k < packs; ++k) store_pack<W>(out + c * stride + k * W, load_pack<W>(from + k * step));
  }
}

template <int W>
[[gnu::always_inline]] inline void begin_typed(Workspace<W>& work, FormulaProgram const& program) {
  work.set_constants(program);
  run_row<W>(work, program);
}

/// The geometry of two particles: the vector from the second to the first, one over the distance, and chi. chi is zero
/// out of range, and for projected friction of coincident particles, which have no line of centres. `typed`: results of
/// the program of typed friction for these pairs, if it is typed.
template <int W, int D, bool projected, bool is_typed>
struct Separation {
  Vector<D, Reals<W>> line;
  Reals<W> inverse, chi;
  Reals<W> conduction;  ///< chi of conduction
  Reals<W> change;      ///< of friction with the temperature, times chi^2; of typed friction only

  [[gnu::always_inline]] Separation(DissipationPoint<D, Reals<W>> const& p, DissipationPoint<D, Reals<W>> const& q,
                                    PairNoise const& noise, double const* typed, std::size_t stride)
      : line(p.position - q.position) {
    Reals<W> const zero = 0.0, r2 = norm2(line), safe = max(r2, Reals<W>(1e-300));
    inverse = rsqrt(safe);
    auto const within = [&](Reals<W> x) __attribute__((always_inline)) {
      Reals<W> const inside = select(r2 < noise.range2, x, zero);
      return projected ? select(r2 > zero, inside, zero) : inside;
    };
    if constexpr (is_typed) {
      chi = within(load_pack<W>(typed));
      conduction = within(load_pack<W>(typed + stride));
      change = within(load_pack<W>(typed + 2 * stride));
    } else {
      chi = within(weight_of<W>(max(1.0 - safe * inverse * noise.inverse_range, zero), noise));
      conduction = chi;
    }
  }
};

template <int W, int D, bool projected, bool conducts, bool is_typed>
[[gnu::always_inline]] inline Exchange<W, D> exchange(DissipationPoint<D, Reals<W>> const& p,
                                                      DissipationPoint<D, Reals<W>> const& q, Reals<W> const* normal,
                                                      Reals<W> sign, PairNoise const& noise, double asymmetry,
                                                      double const* typed, std::size_t typed_stride) {
  constexpr int directions = projected ? 1 : D;
  Separation<W, D, projected, is_typed> const apart(p, q, noise, typed, typed_stride);
  Reals<W> const chi = apart.chi, chi2 = chi * chi;
  Vector<D, Reals<W>> const v = p.velocity - q.velocity;
  Exchange<W, D> result;
  Reals<W> const inverse_masses = p.inverse_mass + q.inverse_mass;
  Reals<W> const inverse_temperatures = p.inverse_temperature + q.inverse_temperature;
  Reals<W> const product = p.inverse_temperature * q.inverse_temperature;
  auto const drag_of = [&](Strength<Reals<W>> const& s) __attribute__((always_inline)) {
    if constexpr (is_typed) return s.friction * chi2 + s.by_change * apart.change;
    return s.friction * chi2;
  };
  auto const strength = [&](Reals<W> square) {
    return Strength<Reals<W>>(noise, inverse_temperatures, product, p.curvature + q.curvature, inverse_masses, square,
                              directions);
  };
  if constexpr (projected) {
    Vector<D, Reals<W>> const e = apart.line * apart.inverse;
    Reals<W> const u = dot(v, e);
    auto const s = strength(u * u);
    Reals<W> const push = s.noise * chi * normal[0] - drag_of(s) * u;
    result.momentum = e * push;
    result.loss = 0.5 * push * u;
    result.transfer = asymmetry * push * push * (q.inverse_mass - p.inverse_mass);
  } else {
    auto const s = strength(norm2(v));
    Reals<W> const amplitude = s.noise * chi * sign, drag = drag_of(s);
    for (int a = 0; a < D; ++a) result.momentum[a] = amplitude * normal[a] - drag * v[a];
    result.loss = 0.5 * dot(result.momentum, v);
    result.transfer = asymmetry * norm2(result.momentum) * (q.inverse_mass - p.inverse_mass);
  }
  if constexpr (conducts)
    result.transfer -=
        noise.conduction * (apart.conduction * apart.conduction) * (p.inverse_temperature - q.inverse_temperature) +
        noise.conduction_noise * apart.conduction * sign * normal[directions];
  return result;
}

typedef double Octet __attribute__((vector_size(64)));

/// Four columns of eight numbers as rows of four: rows 0 and 4, 1 and 5, 2 and 6, 3 and 7.
[[gnu::always_inline]] inline std::array<Octet, 4> rows_of(Reals<8> const (&columns)[4]) {
  Octet const a = columns[0].native, b = columns[1].native, c = columns[2].native, d = columns[3].native;
  Octet const ab0 = __builtin_shufflevector(a, b, 0, 8, 2, 10, 4, 12, 6, 14);
  Octet const ab1 = __builtin_shufflevector(a, b, 1, 9, 3, 11, 5, 13, 7, 15);
  Octet const cd0 = __builtin_shufflevector(c, d, 0, 8, 2, 10, 4, 12, 6, 14);
  Octet const cd1 = __builtin_shufflevector(c, d, 1, 9, 3, 11, 5, 13, 7, 15);
  return {__builtin_shufflevector(ab0, cd0, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(ab1, cd1, 0, 1, 8, 9, 4, 5, 12, 13),
          __builtin_shufflevector(ab0, cd0, 2, 3, 10, 11, 6, 7, 14, 15),
          __builtin_shufflevector(ab1, cd1, 2, 3, 10, 11, 6, 7, 14, 15)};
}

/// Adds W rows of four numbers, given as columns, to the rows `row(lane)`.
template <int W, class RowOf>
[[gnu::always_inline]] inline void scatter(RowOf row, Reals<W> const (&columns)[4]) {
  if constexpr (W == 8) {
    auto const rows = rows_of(columns);
    for (int k = 0; k < 4; ++k)
      *reinterpret_cast<Quad*>(row(k)) += __builtin_shufflevector(rows[k], rows[k], 0, 1, 2, 3);
    for (int k = 0; k < 4; ++k)
      *reinterpret_cast<Quad*>(row(k + 4)) += __builtin_shufflevector(rows[k], rows[k], 4, 5, 6, 7);
  } else {
    for (int lane = 0; lane < W; ++lane)
      for (int c = 0; c < 4; ++c) row(lane)[c] += columns[c][lane];
  }
}

/// Adds the sum of each column over its lanes to four numbers.
template <int W>
[[gnu::always_inline]] inline void gather_sums(double* sums, Reals<W> const (&columns)[4]) {
  if constexpr (W == 8) {
    auto const rows = rows_of(columns);
    Octet const all = (rows[0] + rows[1]) + (rows[2] + rows[3]);
    *reinterpret_cast<Quad*>(sums) +=
        __builtin_shufflevector(all, all, 0, 1, 2, 3) + __builtin_shufflevector(all, all, 4, 5, 6, 7);
  } else {
    for (int c = 0; c < 4; ++c) sums[c] += sum(columns[c]);
  }
}

/// Groups of a row whose noise is drawn in advance, so that the long latency from a counter to a normal overlaps for
/// several.
inline constexpr std::size_t noise_groups = 48;

/// The noise of groups [first, last) of a row.
template <int W, int count>
[[gnu::always_inline]] inline double* draw_row(DissipationTask const& task, std::size_t i, std::size_t first,
                                               std::size_t last, double* out) {
  Words<W> const self = Words<W>{} + task.number[i];
  for (std::uint32_t const* group = task.row[i - task.listed] + 2 * list_padding * first;
       group < task.row[i - task.listed] + 2 * list_padding * last; group += 2 * list_padding)
    for (std::size_t lane = 0; lane < list_padding; lane += W) {
      Reals<W> normal[count + count % 2];
      draw_normals<W, count>(self, widened<W>(group + list_padding + lane), task.noise, normal);
      for (int n = 0; n < count; ++n, out += W) store_pack<W>(out, normal[n]);
    }
  return out;
}

inline constexpr std::size_t typed_stride = noise_groups * list_padding;

/// The results of typed friction's program for groups [first, last) of a row; returns the end of the output.
template <int W, int D>
[[gnu::noinline]] double* weigh_row(DissipationTask const& task, std::size_t i, std::size_t first, std::size_t last,
                                    double* out) {
  constexpr std::size_t stride = dissipation_point_stride(D), blocks = stride / 4;
  Workspace<W> work;
  begin_typed<W>(work, *task.noise.typed);
  auto const p = broadcast<DissipationPoint<D>, Reals<W>>(task.target + stride * i);
  for (std::size_t group = first; group < last; group += block_pairs / list_padding) {
    std::size_t const left = (last - group) * list_padding, count = left < block_pairs ? left : block_pairs;
    std::uint32_t const* const entries = task.row[i - task.listed] + 2 * list_padding * group;
    run_typed<W, D>(
        work, task.noise, count, [&](std::size_t) { return p; },
        [&](std::size_t k) {
          std::uint32_t const* const j = entries + 2 * list_padding * (k / list_padding) + k % list_padding;
          return load_rows<DissipationPoint<D>, W>([&](int lane) { return task.source + blocks * j[lane]; });
        },
        out, typed_stride);
    out += count;
  }
  return out;
}

/// Friction and noise between a row and its groups [first, last). `typed`: results of typed friction's program for
/// them, if it is typed.
template <int W, int D, bool projected, bool conducts, bool is_typed>
[[gnu::always_inline]] inline double const* exchange_row(DissipationTask const& task, std::size_t i, std::size_t first,
                                                         std::size_t last, double const* noise, double const* typed) {
  constexpr std::size_t stride = dissipation_point_stride(D), blocks = stride / 4;
  constexpr int count = (projected ? 1 : D) + (conducts ? 1 : 0);
  double const* const source = task.source;
  auto const rows = static_cast<std::uint32_t>(task.rows), begin = static_cast<std::uint32_t>(task.first);
  auto const place_of = [=](std::uint32_t row) { return row - begin < rows ? row - begin : rows; };
  Reals<W> const zero = 0.0;
  auto const p = broadcast<DissipationPoint<D>, Reals<W>>(task.target + stride * i);
  Words<W> const self = Words<W>{} + task.number[i];
  Vector<D, Reals<W>> momentum;
  for (int a = 0; a < D; ++a) momentum[a] = zero;
  Reals<W> loss = zero;
  for (std::uint32_t const* group = task.row[i - task.listed] + 2 * list_padding * first;
       group < task.row[i - task.listed] + 2 * list_padding * last; group += 2 * list_padding)
    for (std::uint32_t const* j = group; j < group + list_padding; j += W) {
      auto const q = load_rows<DissipationPoint<D>, W>([&](int lane) { return source + blocks * j[lane]; });
      Reals<W> normal[count];
      for (int n = 0; n < count; ++n, noise += W) normal[n] = load_pack<W>(noise);
      Reals<W> const sign = order_of<W>(self, widened<W>(j + list_padding), task.noise);
      auto const pair = exchange<W, D, projected, conducts, is_typed>(p, q, normal, sign, task.noise, task.asymmetry,
                                                                      typed, typed_stride);
      if constexpr (is_typed) typed += W;
      momentum += pair.momentum;
      loss += pair.loss + pair.transfer;
      if (!task.noise.same) continue;
      Reals<W> columns[4] = {zero, zero, zero, zero};
      for (int a = 0; a < D; ++a) columns[a] = -pair.momentum[a];
      columns[D] = pair.loss - pair.transfer;
      std::uint32_t place[W];
      for (int lane = 0; lane < W; ++lane) place[lane] = place_of(j[lane] / 4);
      scatter<W>([&](int lane) { return task.sums + 4 * std::size_t{place[lane]}; }, columns);
    }
  Reals<W> columns[4] = {zero, zero, zero, zero};
  for (int a = 0; a < D; ++a) columns[a] = momentum[a];
  columns[D] = loss;
  gather_sums<W>(task.sums + 4 * std::size_t{place_of(static_cast<std::uint32_t>(i))}, columns);
  return noise;
}

template <int W, int D, bool projected, bool conducts, bool is_typed>
[[gnu::always_inline]] inline void simultaneous_rows(DissipationTask const& task) {
  constexpr int count = (projected ? 1 : D) + (conducts ? 1 : 0);
  alignas(64) double noise[noise_groups * list_padding * count];
  alignas(64) double weighed[is_typed ? typed_results * typed_stride : 1];
  auto const groups = [&](std::size_t i) { return (task.length[i - task.listed] + list_padding - 1) / list_padding; };
  for (std::size_t i = task.begin; i < task.end;) {
    std::size_t stop = i + 1, all = groups(i);
    for (std::size_t more; stop < task.end && all + (more = groups(stop)) <= noise_groups; ++stop) all += more;
    if (all > noise_groups) {  // one long row
      for (std::size_t first = 0; first < all; first += noise_groups) {
        std::size_t const last = first + noise_groups < all ? first + noise_groups : all;
        draw_row<W, count>(task, i, first, last, noise);
        if constexpr (is_typed) weigh_row<W, D>(task, i, first, last, weighed);
        exchange_row<W, D, projected, conducts, is_typed>(task, i, first, last, noise, weighed);
      }
    } else {
      double* drawn = noise;
      for (std::size_t k = i; k < stop; ++k) drawn = draw_row<W, count>(task, k, 0, groups(k), drawn);
      if constexpr (is_typed) {
        double* to = weighed;
        for (std::size_t k = i; k < stop; ++k) to = weigh_row<W, D>(task, k, 0, groups(k), to);
      }
      double const *used = noise, *results = weighed;
      for (std::size_t k = i; k < stop; ++k) {
        used = exchange_row<W, D, projected, conducts, is_typed>(task, k, 0, groups(k), used, results);
        if constexpr (is_typed) results += groups(k) * list_padding;
      }
    }
    i = stop;
  }
}

template <int W, int D, bool projected, bool is_typed>
[[gnu::flatten]] void simultaneous_of(DissipationTask const& task) {
  if (task.noise.conduction > 0)
    simultaneous_rows<W, D, projected, true, is_typed>(task);
  else
    simultaneous_rows<W, D, projected, false, is_typed>(task);
}

template <int W, int D, bool projected>
void simultaneous(DissipationTask const& task) {
  if (task.noise.typed)
    simultaneous_of<W, D, projected, true>(task);
  else
    simultaneous_of<W, D, projected, false>(task);
}

/// The results of typed friction's program for all pairs of the task.
template <int W, int D>
[[gnu::noinline]] void weigh_pairs(GeometryTask const& task, double* out) {
  constexpr std::size_t stride = dissipation_point_stride(D);
  Workspace<W> work;
  begin_typed<W>(work, *task.noise.typed);
  for (std::size_t first = 0; first < task.count; first += block_pairs) {
    std::size_t const left = task.count - first, count = left < block_pairs ? left : block_pairs;
    auto const pair = [&](std::size_t k) { return task.pairs[first + (first + k < task.count ? k : count - 1)]; };
    run_typed<W, D>(
        work, task.noise, count,
        [&](std::size_t k) {
          return load_rows<DissipationPoint<D>, W>(
              [&](int lane) { return task.first + stride * pair(k + static_cast<std::size_t>(lane)).first; });
        },
        [&](std::size_t k) {
          return load_rows<DissipationPoint<D>, W>(
              [&](int lane) { return task.second + stride * pair(k + static_cast<std::size_t>(lane)).seen; });
        },
        out + first, geometry_block);
  }
}

template <int W, int D, bool projected>
[[gnu::flatten]] void geometry(GeometryTask const& task) {
  constexpr std::size_t stride = dissipation_point_stride(D);
  alignas(64) double weighed[typed_results * geometry_block];
  bool const typed = task.noise.typed != nullptr;
  if (typed && !task.noise.of_temperature) weigh_pairs<W, D>(task, weighed);
  constexpr int directions = projected ? 1 : D;
  auto const store = [&](std::size_t column, std::size_t k, Reals<W> x) {
    store_pack<W>(task.columns + column * geometry_block + k, x);
  };
  for (std::size_t k = 0; k < task.count; k += W) {
    auto const pair = [&](int lane) { return task.pairs[k + lane < task.count ? k + lane : task.count - 1]; };
    auto const p = load_rows<DissipationPoint<D>, W>([&](int lane) { return task.first + stride * pair(lane).first; });
    auto const q = load_rows<DissipationPoint<D>, W>([&](int lane) { return task.second + stride * pair(lane).seen; });
    Separation<W, D, projected, false> const apart(p, q, task.noise, nullptr, 0);
    Reals<W> chi = apart.chi, conduction = apart.chi;
    if (typed && !task.noise.of_temperature) {
      Separation<W, D, projected, true> const by_formula(p, q, task.noise, weighed + k, geometry_block);
      chi = by_formula.chi;
      conduction = by_formula.conduction;
    }
    store(0, k, chi);
    store(weight_column, k, conduction);
    if (task.noise.of_temperature) {  // temperatures change from pair to pair: chi is computed later
      Reals<W> const one = 1.0, zero = 0.0, r2 = norm2(apart.line), inside = select(r2 < task.noise.range2, one, zero);
      store(0, k, projected ? select(r2 > zero, inside, zero) : inside);
      store(weight_column, k, r2);
    }
    if constexpr (projected)
      for (int a = 0; a < D; ++a) store(1 + a, k, apart.line[a] * apart.inverse);
    Words<W> first{}, second{};
    for (int lane = 0; lane < W; ++lane) {
      first[lane] = task.first_number[pair(lane).first];
      second[lane] = task.second_number[pair(lane).second];
    }
    Reals<W> normal[directions + 1 + (directions + 1) % 2];
    draw_normals<W, directions + 1>(first, second, task.noise, normal);
    Reals<W> const sign = order_of<W>(first, second, task.noise);
    for (int a = 0; a < directions; ++a) store(4 + a, k, projected ? normal[a] : normal[a] * sign);
    store(4 + directions, k, normal[directions] * sign);
  }
}

template <int W, int D, bool projected>
constexpr DissipationKernels dissipation_kernels_of() {
  return {simultaneous<W, D, projected>, geometry<W, D, projected>, rounds_as_machine_code<W> ? W : 0};
}

template <InstructionSet set>
struct FlowTable {
  static constexpr int W = native_width<double>;
  static constexpr DissipationKernelTable table{
      {{dissipation_kernels_of<W, 1, false>(), dissipation_kernels_of<W, 1, true>()},
       {dissipation_kernels_of<W, 2, false>(), dissipation_kernels_of<W, 2, true>()},
       {dissipation_kernels_of<W, 3, false>(), dissipation_kernels_of<W, 3, true>()}}};
};

}  // namespace detail

template <>
DissipationKernelTable const& dissipation_kernels<this_set>() {
  return detail::FlowTable<this_set>::table;
}

}  // namespace boltzmann
