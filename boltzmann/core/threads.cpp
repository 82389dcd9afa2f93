// The one place that knows OpenMP.
#include <boltzmann/core/threads.hpp>

#include <algorithm>
#include <atomic>
#include <exception>
#include <mutex>

// The thread sanitizer does not see OpenMP's own locks: under it the same loop runs on plain threads.
#if defined(__SANITIZE_THREAD__)
#include <thread>
#include <vector>
#else
#include <omp.h>
#endif

namespace boltzmann {

namespace {

/// Calls body() on so many threads at once, the caller's among them.
template <class Body>
void on_threads(int threads, Body const& body) {
#if defined(__SANITIZE_THREAD__)
  std::vector<std::thread> others;
  for (int t = 1; t < threads; ++t) others.emplace_back(body);
  body();
  for (auto& thread : others) thread.join();
#else
#pragma omp parallel num_threads(threads)
  body();
#endif
}

}  // namespace

int default_threads() {
#if defined(__SANITIZE_THREAD__)
  return static_cast<int>(std::thread::hardware_concurrency());
#else
  return omp_get_max_threads();
#endif
}

namespace detail {

void parallel_ranges(std::size_t size, std::size_t grain, int threads, void const* function,
                     void (*call)(void const* function, std::size_t begin, std::size_t end)) {
  std::size_t const ranges = (size + grain - 1) / grain;
  std::atomic<std::size_t> next{0};
  std::mutex failing;
  std::exception_ptr failure;
  std::size_t failed_range = ranges;
  on_threads(threads, [&] {
    for (std::size_t range = next++; range < ranges; range = next++) {
      std::size_t const begin = range * grain;
      try {
        call(function, begin, std::min(begin + grain, size));
      } catch (...) {
        std::lock_guard const lock(failing);
        if (range < failed_range) {
          failed_range = range;
          failure = std::current_exception();
        }
      }
    }
  });
  if (failure) std::rethrow_exception(failure);
}

}  // namespace detail
}  // namespace boltzmann
