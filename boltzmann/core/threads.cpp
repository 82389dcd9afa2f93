// The one place that knows OpenMP.
#include <boltzmann/core/threads.hpp>

#include <omp.h>

#include <algorithm>
#include <exception>

namespace boltzmann {

int default_threads() { return omp_get_max_threads(); }

namespace detail {

void parallel_ranges(std::size_t size, std::size_t grain, int threads, void const* function,
                     void (*call)(void const* function, std::size_t begin, std::size_t end)) {
  auto const ranges = static_cast<std::ptrdiff_t>((size + grain - 1) / grain);
  std::exception_ptr failure;
  std::ptrdiff_t failed_range = ranges;
#pragma omp parallel for schedule(dynamic) num_threads(threads)
  for (std::ptrdiff_t range = 0; range < ranges; ++range) {
    std::size_t const begin = static_cast<std::size_t>(range) * grain;
    try {
      call(function, begin, std::min(begin + grain, size));
    } catch (...) {
#pragma omp critical
      if (range < failed_range) {
        failed_range = range;
        failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

}  // namespace detail
}  // namespace boltzmann
