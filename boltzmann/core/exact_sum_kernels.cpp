// The kernel that splits numbers so that they can be added without rounding (Rump, Ogita and Oishi 2008, "Accurate
// floating-point summation I", section 3: ExtractVector).
//
// With a power of two s >= 1024 max |x|, q = (s + x) - s is x rounded to a multiple of s / 2^53, and the rest x - q is
// exact. At most 1024 of the q add up to no more than s, so that neither they nor any part of them is rounded, in
// whatever order. The rest is below s / 2^53, and is split in the same way: two parts have 86 bits below the largest.
#include <boltzmann/core/exact_sum_kernels.hpp>
#include <boltzmann/core/kernel_unit.hpp>
#include <boltzmann/core/pack.hpp>

#include <bit>
#include <cstdint>
#include <limits>

namespace boltzmann {
namespace detail {

/// Reduces all lanes by an operation that allows any order.
template <int W, class Operation>
[[gnu::always_inline]] inline double over_lanes(Pack<double, W> a, Operation const& operation) {
  double lane[W];
  for (int l = 0; l < W; ++l) lane[l] = a.native[l];
  for (int half = W / 2; half > 0; half /= 2)
    for (int l = 0; l < half; ++l) lane[l] = operation(lane[l], lane[l + half]);
  return lane[0];
}

template <int W>
[[gnu::always_inline]] inline double sum_of_lanes(Pack<double, W> a) {
  return over_lanes<W>(a, [](double x, double y) { return x + y; });
}

template <int W>
[[gnu::always_inline]] inline double largest_lane(Pack<double, W> a) {
  return over_lanes<W>(a, [](double x, double y) { return x < y ? y : x; });
}

template <int W>
[[gnu::flatten]] void split_numbers(SplitTask& task) {
  using Number = Pack<double, W>;
  constexpr int chains = 8 / W < 2 ? 2 : 8 / W < 4 ? 8 / W : 4;
  static_assert(split_unit % (chains * W) == 0);
  Number largest[chains];  // NaN is ignored
  for (auto& of_chain : largest) of_chain = 0.0;
  for (std::size_t i = 0; i < task.count; i += chains * W)
    for (int c = 0; c < chains; ++c) largest[c] = max(largest[c], abs(load_pack<W>(task.numbers + i + c * W)));
  for (int c = 1; c < chains; ++c) largest[0] = max(largest[0], largest[c]);
  double const most = largest_lane<W>(largest[0]);
  task.largest_rest = std::numeric_limits<double>::quiet_NaN();
  if (!(most < 0x1p1000)) return;
  // The power of two above the largest number, times split_most, from the bits of the exponent.
  constexpr int margin = std::countr_zero(split_most);
  double const above = std::bit_cast<double>((std::bit_cast<std::uint64_t>(most) & 0x7ff0000000000000U) +
                                             (std::uint64_t{margin + 1} << 52U));
  constexpr double next = 1.0 / static_cast<double>(std::uint64_t{1} << (53U - margin));
  Number const first = above, second = above * next;
  Number sums[chains], further[chains], rests[chains];
  for (int c = 0; c < chains; ++c) sums[c] = further[c] = rests[c] = 0.0;
  for (std::size_t i = 0; i < task.count; i += chains * W)
    for (int c = 0; c < chains; ++c) {
      std::size_t const at = i + static_cast<std::size_t>(c * W);
      Number const x = load_pack<W>(task.numbers + at);
      Number const q = (first + x) - first, left = x - q;
      Number const r = (second + left) - second, rest = left - r;
      sums[c] += q;
      further[c] += r;
      rests[c] = max(rests[c], abs(rest));
      __builtin_memcpy(task.rest + at, &rest.native, sizeof(rest.native));
    }
  for (int c = 1; c < chains; ++c) {
    sums[0] += sums[c];
    further[0] += further[c];
    rests[0] = max(rests[0], rests[c]);
  }
  task.sums[0] = sum_of_lanes<W>(sums[0]);
  task.sums[1] = sum_of_lanes<W>(further[0]);
  if (task.sums[0] == task.sums[0]) task.largest_rest = largest_lane<W>(rests[0]);
}

}  // namespace detail

template <>
SplitKernel split_kernel<this_set>() {
  return detail::split_numbers<native_width<double>>;
}

}  // namespace boltzmann
