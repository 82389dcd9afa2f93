// The pool of threads for loops. Threads are started when first needed and kept. Between loops they poll for work for a
// moment, then sleep. The caller of a loop processes ranges, too. It waits for ranges in progress, but never for a
// thread that has none. So a thread that gets no processor on a busy machine causes no delay.
#include <boltzmann/core/shared_processors.hpp>
#include <boltzmann/core/threads.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <cstdlib>
#include <exception>
#include <mutex>
#include <system_error>
#include <thread>
#include <vector>
#if defined(__linux__)
#include <sched.h>
#endif

namespace boltzmann {
namespace {

// Longer than the time between two loops of a step, short enough not to waste processor time.
constexpr auto patience = std::chrono::microseconds(100);

void pause() {
#if defined(__x86_64__)
  __builtin_ia32_pause();
#endif
}

/// Polls until done() holds; true if it did within the patience.
template <class Done>
bool look_out(Done const& done) {
  for (int n = 0; n < 64; ++n) {
    if (done()) return true;
    pause();
  }
  auto const until = std::chrono::steady_clock::now() + patience;
  while (std::chrono::steady_clock::now() < until) {
    for (int n = 0; n < 32; ++n) {
      if (done()) return true;
      pause();
    }
  }
  return done();
}

struct Loop {
  std::size_t size, grain, ranges;
  void const* function;
  void (*call)(void const* function, std::size_t begin, std::size_t end);
  std::atomic<std::size_t> next{0}, finished{0};
  std::mutex failing;
  std::exception_ptr failure;
  std::size_t failed_range;

  /// Processes ranges while there are any.
  void work() {
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
      ++finished;
    }
  }
};

class Pool {
 public:
  Pool() = default;
  Pool(Pool const&) = delete;
  Pool& operator=(Pool const&) = delete;
  ~Pool() {
    stopping_ = true;
    ++loops_;
    loops_.notify_all();
    for (auto& thread : threads_) thread.join();
  }

  /// Runs the loop on this number of threads, including the caller's; on the caller's alone if the others are busy with
  /// a loop of another thread.
  void run(Loop& loop, int threads) {
    std::unique_lock const mine(busy_, std::try_to_lock);
    if (!mine.owns_lock()) return loop.work();
    auto const helpers = static_cast<std::size_t>(std::max(threads - 1, 0));
    try {
      while (threads_.size() < helpers) threads_.emplace_back([this, number = threads_.size()] { serve(number); });
    } catch (std::system_error const&) {
      // No more can be started: those that exist do the work.
    }
    helpers_ = helpers;
    loop_ = &loop;
    ++loops_;
    if (asleep_ > 0) loops_.notify_all();
    loop.work();
    while (!look_out([&] { return loop.finished == loop.ranges; })) std::this_thread::yield();
    loop_ = nullptr;
    while (!look_out([&] { return visitors_ == 0; })) std::this_thread::yield();
  }

 private:
  void serve(std::size_t number) {
    for (std::uint64_t seen = 0;;) {
      if (!look_out([&] { return loops_ != seen; })) {
        ++asleep_;
        loops_.wait(seen);
        --asleep_;
      }
      seen = loops_;
      if (stopping_) return;
      // The caller waits for a worker that has joined; a worker that comes late finds no loop.
      ++visitors_;
      if (Loop* loop = loop_; loop && number < helpers_) loop->work();
      --visitors_;
    }
  }

  std::mutex busy_;
  std::vector<std::thread> threads_;
  std::atomic<std::uint64_t> loops_{0};
  std::atomic<std::size_t> helpers_{0};
  std::atomic<Loop*> loop_{nullptr};
  std::atomic<int> visitors_{0}, asleep_{0};
  std::atomic<bool> stopping_{false};
};

Pool& pool() {
  static Pool the_pool;
  return the_pool;
}

}  // namespace

namespace {
std::atomic<int> processes{1};
std::atomic<bool> shared{false};

int processors() {
  static int const count = [] {
#if defined(__linux__)
    cpu_set_t mine;
    if (sched_getaffinity(0, sizeof(mine), &mine) == 0) return std::max(1, CPU_COUNT(&mine));
#endif
    return std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  }();
  return count;
}
}  // namespace

void share_processors(int of) {
  processes = std::max(1, of);
  shared = true;
}

bool processors_suffice() { return shared && processes * default_threads() <= processors(); }

int default_threads() {
  static int const told = [] {
    char const* wanted = std::getenv("OMP_NUM_THREADS");
    return wanted ? std::atoi(wanted) : 0;
  }();
  return told > 0 ? told : std::max(1, processors() / processes);
}

namespace detail {

void parallel_ranges(std::size_t size, std::size_t grain, int threads, void const* function,
                     void (*call)(void const* function, std::size_t begin, std::size_t end)) {
  Loop loop;
  loop.size = size;
  loop.grain = grain;
  loop.failed_range = loop.ranges = (size + grain - 1) / grain;
  loop.function = function;
  loop.call = call;
  pool().run(loop, threads);
  if (loop.failure) std::rethrow_exception(loop.failure);
}

}  // namespace detail
}  // namespace boltzmann
