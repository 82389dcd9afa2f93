// Threads: a loop over ranges.
#pragma once

#include <cstddef>

namespace boltzmann {

/// The number of threads of a loop by default: OMP_NUM_THREADS, or the number of processors that this process may use.
int default_threads();

namespace detail {
void parallel_ranges(std::size_t size, std::size_t grain, int threads, void const* function,
                     void (*call)(void const* function, std::size_t begin, std::size_t end));
}

/// The number of these threads that pays for a loop over this many items: one if the loop would be done before others
/// wake up. `work` is the cost of one item: 1 for a particle that an integrator moves, 1/8 for a near pair.
constexpr int threads_for(std::size_t items, double work, int threads) {
  return static_cast<double>(items) * work < 8192 ? 1 : threads;
}

namespace detail {
/// One instance for one thread and for several: two copies may be optimised to different bits.
template <class Function>
[[gnu::noinline]] void call_range(void const* function, std::size_t begin, std::size_t end) {
  (*static_cast<Function const*>(function))(begin, end);
}
}  // namespace detail

/// Calls function(begin, end) for ranges of `grain` items that cover [0, size), on `threads` threads; on the caller's
/// thread if there is only one range or thread. Ranges are assigned to threads in no fixed order, so a function must
/// write only to its own items. Then the result is bit-for-bit the same for any number of threads. An exception in a
/// range is rethrown here (that of the lowest range).
template <class Function>
void for_ranges(std::size_t size, std::size_t grain, int threads, Function const& function) {
  if (threads > 1 && size > grain)
    detail::parallel_ranges(size, grain, threads, &function, detail::call_range<Function>);
  else if (size > 0)
    detail::call_range<Function>(&function, 0, size);
}

}  // namespace boltzmann
