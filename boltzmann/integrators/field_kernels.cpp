// Advances fields with rates of their own, for one instruction set. Products and sums are rounded one by one here
// (CMakeLists.txt), so that numbers that are given have the same bits for all sets.
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/core/pack.hpp>
#include <boltzmann/integrators/field_kernels.hpp>

namespace boltzmann {
namespace detail {

/// W numbers that stand some doubles apart.
template <int W>
[[gnu::always_inline]] inline Pack<double, W> load_apart(double const* from, std::size_t step) {
  if (step == 1) return load_pack<W>(from);
  Pack<double, W> result;
  for (int lane = 0; lane < W; ++lane) result.native[lane] = from[static_cast<std::size_t>(lane) * step];
  return result;
}

/// f(x, start, sum, rate) for the first W numbers, which then belong to the column no more; `reads` tells whether f asks
/// for x and start as they were, `sums` whether it keeps a sum. NaN where a number is not finite then, else zero.
template <bool reads, bool sums, int W, class F>
[[gnu::always_inline]] inline Pack<double, W> advance_pack(FieldColumn& column, F const& f) {
  Pack<double, W> x = 0.0, sum = 0.0, start = load_pack<W>(column.start);
  if constexpr (reads)
    for (int lane = 0; lane < W; ++lane) x.native[lane] = column.x[static_cast<std::size_t>(lane) * column.row];
  if constexpr (sums) sum = load_pack<W>(column.sum);
  f(x, start, sum, load_apart<W>(column.rate, column.rate_step));
  store_pack<W>(column.start, start);
  if constexpr (sums) store_pack<W>(column.sum, sum);
  for (int lane = 0; lane < W; ++lane) column.x[static_cast<std::size_t>(lane) * column.row] = x.native[lane];
  column.x += W * column.row;
  column.rate += W * column.rate_step;
  column.start += W;
  column.sum += W;
  column.count -= W;
  return x - x;
}

template <int W, bool reads, bool sums, class F>
[[gnu::always_inline]] inline bool advance_column(FieldColumn const& given, F const& f) {
  FieldColumn column = given;  // of which the compiler knows that no number is stored in it
  Pack<double, W> not_finite = 0.0;
  Pack<double, 1> last = 0.0;
  while (column.count >= W) not_finite += advance_pack<reads, sums, W>(column, f);
  while (column.count > 0) last += advance_pack<reads, sums, 1>(column, f);
  return !any(not_finite != not_finite) && !any(last != last);
}

template <int W>
bool euler_column(FieldColumn const& column, double dt) {
  return advance_column<W, true, false>(column, [dt](auto& x, auto&, auto&, auto rate) { x += dt * rate; });
}

/// By the mean of the rates at both ends, of which that of the second is known for what the first has predicted.
template <int W>
bool leap_frog_begin(FieldColumn const& column, double dt) {
  return advance_column<W, true, false>(column, [dt](auto& x, auto& first, auto&, auto rate) {
    first = rate;
    x += dt * rate;
  });
}
template <int W>
bool leap_frog_end(FieldColumn const& column, double dt) {
  double const half = 0.5 * dt;
  return advance_column<W, true, false>(
      column, [half](auto& x, auto const& first, auto&, auto rate) { x += half * (rate - first); });
}

template <int W>
bool rk2_begin(FieldColumn const& column, double dt) {
  double const half = 0.5 * dt;
  return advance_column<W, true, false>(column, [half](auto& x, auto& x0, auto&, auto rate) {
    x0 = x;
    x += half * rate;
  });
}
template <int W>
bool rk2_end(FieldColumn const& column, double dt) {
  return advance_column<W, false, false>(column,
                                         [dt](auto& x, auto const& x0, auto&, auto rate) { x = x0 + dt * rate; });
}

template <int W>
bool rk4_begin(FieldColumn const& column, double dt) {
  double const half = 0.5 * dt;
  return advance_column<W, true, true>(column, [half](auto& x, auto& x0, auto& sum, auto rate) {
    x0 = x;
    sum = rate;
    x += half * rate;
  });
}
/// The second and the third stage, which differ in how far they look.
template <int W, int stage>
bool rk4_go_on(FieldColumn const& column, double dt) {
  double const h = stage == 1 ? 0.5 * dt : dt;
  return advance_column<W, false, true>(column, [h](auto& x, auto const& x0, auto& sum, auto rate) {
    sum += 2.0 * rate;
    x = x0 + h * rate;
  });
}
template <int W>
bool rk4_end(FieldColumn const& column, double dt) {
  double const sixth = dt / 6;
  return advance_column<W, false, true>(
      column, [sixth](auto& x, auto const& x0, auto const& sum, auto rate) { x = x0 + sixth * (sum + rate); });
}

template <InstructionSet set>
struct FieldTable {
  static constexpr int W = native_width<double>;
  static constexpr FieldKernelTable table{euler_column<W>,
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
