// Advances fields with rates of their own, for one instruction set. Products and sums are rounded separately here
// (CMakeLists.txt), so that constant fields have the same bits for all sets.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/core/pack.hpp>
#include <boltzmann/integrators/field_kernels.hpp>

#include <cstddef>
#include <cstdint>
#include <utility>

namespace boltzmann {
namespace detail {

/// W numbers at a fixed distance.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> load_apart(double const* from, std::size_t step) {
  if (step == 1) return load_pack<W>(from);
  Pack<double, W> result;
  for (int lane = 0; lane < W; ++lane) result.native[lane] = from[static_cast<std::size_t>(lane) * step];
  return result;
}

typedef double Two __attribute__((vector_size(16), may_alias));
template <int W>
using Native = typename Pack<double, W>::Native;

// Numbers of W rows as packs: one number of each row, or two adjacent ones, which halves the loads and stores.

/// Lanes 0 of a and b, 2 of a and b, ...; or lanes 1, 3, ...: from pairs to packs, and back.
template <int W, bool second, std::size_t... I>
[[gnu::always_inline]] inline Native<W> alternate(Native<W> a, Native<W> b, std::index_sequence<I...>) {
  return __builtin_shufflevector(a, b, static_cast<int>(I / 2 * 2 + second + I % 2 * W)...);
}
template <int W, bool second>
[[gnu::always_inline]] inline Native<W> alternate(Native<W> a, Native<W> b) {
  return alternate<W, second>(a, b, std::make_index_sequence<W>{});
}

template <int W>
[[gnu::always_inline]] inline void load_numbers(double const* from, std::size_t row, Pack<double, W> (&x)[1]) {
  for (int lane = 0; lane < W; ++lane) x[0].native[lane] = from[static_cast<std::size_t>(lane) * row];
}
template <int W>
[[gnu::always_inline]] inline void store_numbers(double* to, std::size_t row, Pack<double, W> const (&x)[1]) {
  for (int lane = 0; lane < W; ++lane) to[static_cast<std::size_t>(lane) * row] = x[0].native[lane];
}
template <int W>
[[gnu::always_inline]] inline void load_numbers(double const* from, std::size_t row, Pack<double, W> (&x)[2]) {
  auto const two = [&](std::size_t lane) { return *reinterpret_cast<Two const*>(from + lane * row); };
  Native<W> of_even, of_odd;
  if constexpr (W == 2) {
    of_even = two(0), of_odd = two(1);
  } else {
    auto const four = [&](std::size_t lane) { return __builtin_shufflevector(two(lane), two(lane + 2), 0, 1, 2, 3); };
    if constexpr (W == 4) {
      of_even = four(0), of_odd = four(1);
    } else {
      of_even = __builtin_shufflevector(four(0), four(4), 0, 1, 2, 3, 4, 5, 6, 7);
      of_odd = __builtin_shufflevector(four(1), four(5), 0, 1, 2, 3, 4, 5, 6, 7);
    }
  }
  x[0] = alternate<W, false>(of_even, of_odd);
  x[1] = alternate<W, true>(of_even, of_odd);
}
template <int W>
[[gnu::always_inline]] inline void store_numbers(double* to, std::size_t row, Pack<double, W> const (&x)[2]) {
  auto const of_even = alternate<W, false>(x[0].native, x[1].native);
  auto const of_odd = alternate<W, true>(x[0].native, x[1].native);
  [&]<std::size_t... K>(std::index_sequence<K...>) {
    ((*reinterpret_cast<Two*>(to + 2 * K * row) = __builtin_shufflevector(of_even, of_even, 2 * K, 2 * K + 1),
      *reinterpret_cast<Two*>(to + (2 * K + 1) * row) = __builtin_shufflevector(of_odd, of_odd, 2 * K, 2 * K + 1)),
     ...);
  }
  (std::make_index_sequence<W / 2>{});
}

/// f(x, start, sum, rate) for W particles, from particle k on, and `count` adjacent numbers of their rows. `reads`: f
/// reads the old x; `sums`: f keeps a sum. Returns NaN where a number is not finite afterwards, else zero.
template <bool reads, bool sums, int W, int count, class F>
[[gnu::always_inline]] inline Pack<double, W> advance_pack(FieldColumn const* columns, std::size_t row, std::size_t k,
                                                           F const& f) {
  Pack<double, W> x[count], not_finite = 0.0;
  if constexpr (reads) load_numbers<W>(columns->x + k * row, row, x);
  for (int n = 0; n < count; ++n) {
    FieldColumn const& column = columns[n];
    Pack<double, W> start = load_pack<W>(column.start + k), sum = 0.0;
    if constexpr (sums) sum = load_pack<W>(column.sum + k);
    f(x[n], start, sum, load_apart<W>(column.rate + k * column.rate_step, column.rate_step));
    store_pack<W>(column.start + k, start);
    if constexpr (sums) store_pack<W>(column.sum + k, sum);
    not_finite += x[n] - x[n];
  }
  store_numbers<W>(columns->x + k * row, row, x);
  return not_finite;
}

template <int W, bool reads, bool sums, int count, class F>
[[gnu::always_inline]] inline bool advance_columns(FieldColumn const* given, std::size_t row, std::size_t particles,
                                                   F const& f) {
  FieldColumn columns[count];  // a local copy, which stores of numbers can't alias
  for (int n = 0; n < count; ++n) columns[n] = given[n];
  Pack<double, W> not_finite = 0.0;
  Pack<double, 1> last = 0.0;
  std::size_t k = 0;
  for (; k + W <= particles; k += W) not_finite += advance_pack<reads, sums, W, count>(columns, row, k, f);
  for (; k < particles; ++k)
    for (int n = 0; n < count; ++n) last += advance_pack<reads, sums, 1, 1>(columns + n, row, k, f);
  return !any(not_finite != not_finite) && !any(last != last);
}

template <int W, bool reads, bool sums, class F>
[[gnu::always_inline]] inline bool advance_block(FieldBlock const& block, F const& f) {
  bool finite = true;
  for (std::size_t n = 0; n < block.numbers;) {
    FieldColumn const* const columns = block.columns + n;
    // Rows begin at multiples of 32 bytes, so that two such numbers are in one cache line.
    if (n + 1 < block.numbers && columns[1].x == columns->x + 1 &&
        reinterpret_cast<std::uintptr_t>(columns->x) % 16 == 0) {
      finite = advance_columns<W, reads, sums, 2>(columns, block.row, block.particles, f) && finite;
      n += 2;
    } else {
      finite = advance_columns<W, reads, sums, 1>(columns, block.row, block.particles, f) && finite;
      n += 1;
    }
  }
  return finite;
}

template <int W>
bool euler_block(FieldBlock const& block, double dt) {
  return advance_block<W, true, false>(block, [dt](auto& x, auto&, auto&, auto rate) { x += dt * rate; });
}

/// By the mean of the rates at both ends; the second is computed for the values that the first predicts.
template <int W>
bool leap_frog_begin(FieldBlock const& block, double dt) {
  return advance_block<W, true, false>(block, [dt](auto& x, auto& first, auto&, auto rate) {
    first = rate;
    x += dt * rate;
  });
}
template <int W>
bool leap_frog_end(FieldBlock const& block, double dt) {
  double const half = 0.5 * dt;
  return advance_block<W, true, false>(
      block, [half](auto& x, auto const& first, auto&, auto rate) { x += half * (rate - first); });
}

template <int W>
bool rk2_begin(FieldBlock const& block, double dt) {
  double const half = 0.5 * dt;
  return advance_block<W, true, false>(block, [half](auto& x, auto& x0, auto&, auto rate) {
    x0 = x;
    x += half * rate;
  });
}
template <int W>
bool rk2_end(FieldBlock const& block, double dt) {
  return advance_block<W, false, false>(block, [dt](auto& x, auto const& x0, auto&, auto rate) { x = x0 + dt * rate; });
}

template <int W>
bool rk4_begin(FieldBlock const& block, double dt) {
  double const half = 0.5 * dt;
  return advance_block<W, true, true>(block, [half](auto& x, auto& x0, auto& sum, auto rate) {
    x0 = x;
    sum = rate;
    x += half * rate;
  });
}
/// The second and the third stage, which differ in the length of their trial step.
template <int W, int stage>
bool rk4_go_on(FieldBlock const& block, double dt) {
  double const h = stage == 1 ? 0.5 * dt : dt;
  return advance_block<W, false, true>(block, [h](auto& x, auto const& x0, auto& sum, auto rate) {
    sum += 2.0 * rate;
    x = x0 + h * rate;
  });
}
template <int W>
bool rk4_end(FieldBlock const& block, double dt) {
  double const sixth = dt / 6;
  return advance_block<W, false, true>(
      block, [sixth](auto& x, auto const& x0, auto const& sum, auto rate) { x = x0 + sixth * (sum + rate); });
}

template <InstructionSet set>
struct FieldTable {
  static constexpr int W = native_width<double>;
  static constexpr FieldKernelTable table{euler_block<W>,
                                          {leap_frog_begin<W>, leap_frog_end<W>},
                                          {rk2_begin<W>, rk2_end<W>},
                                          {rk4_begin<W>, rk4_go_on<W, 1>, rk4_go_on<W, 2>, rk4_end<W>}};
};

}  // namespace detail

template <>
FieldKernelTable const& field_kernels<this_set>() {
  return detail::FieldTable<this_set>::table;
}

}  // namespace boltzmann
