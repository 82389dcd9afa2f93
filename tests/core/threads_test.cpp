// The loop over ranges: everything once, failures in order, nobody waits for ever.
#include <boltzmann/core/threads.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace boltzmann::threads_test {
namespace {

TEST(Threads, EveryItemIsVisitedOnce) {
  for (int const threads : {1, 2, 3, 8})
    for (std::size_t const size : {0, 1, 7, 100, 12345})
      for (std::size_t const grain : {1, 10, 5000}) {
        std::vector<int> visits(size, 0);
        for_ranges(size, grain, threads, [&](std::size_t begin, std::size_t end) {
          for (std::size_t i = begin; i < end; ++i) ++visits[i];
        });
        EXPECT_EQ(visits, std::vector<int>(size, 1)) << threads << " threads, " << size << " by " << grain;
      }
}

TEST(Threads, ManyShortLoopsOneAfterTheOther) {
  std::atomic<long> sum{0};
  for (int n = 0; n < 20000; ++n)
    for_ranges(4, 1, 4, [&](std::size_t begin, std::size_t) { sum += static_cast<long>(begin); });
  EXPECT_EQ(sum, 20000L * 6);
}

TEST(Threads, LoopsAfterASleep) {
  for (int n = 0; n < 5; ++n) {
    std::this_thread::sleep_for(std::chrono::milliseconds(3));  // longer than the threads' patience
    std::atomic<int> ranges{0};
    for_ranges(50, 1, 3, [&](std::size_t, std::size_t) { ++ranges; });
    EXPECT_EQ(ranges, 50);
  }
}

TEST(Threads, TheFailureOfTheLowestRangeIsReported) {
  for (int const threads : {2, 4})
    for (int n = 0; n < 50; ++n) {
      std::string what;
      try {
        for_ranges(100, 1, threads, [](std::size_t begin, std::size_t) {
          if (begin == 17 || begin > 40) throw std::runtime_error(std::to_string(begin));
        });
      } catch (std::runtime_error const& error) {
        what = error.what();
      }
      EXPECT_EQ(what, "17");
    }
}

TEST(Threads, ALoopInsideALoopAndLoopsOfSeveralCallers) {
  std::atomic<int> inner{0};
  for_ranges(10, 1, 2,
             [&](std::size_t, std::size_t) { for_ranges(10, 1, 2, [&](std::size_t, std::size_t) { ++inner; }); });
  EXPECT_EQ(inner, 100);
  std::atomic<int> both{0};
  auto const caller = [&] {
    for (int n = 0; n < 200; ++n) for_ranges(20, 1, 2, [&](std::size_t, std::size_t) { ++both; });
  };
  std::thread other(caller);
  caller();
  other.join();
  EXPECT_EQ(both, 2 * 200 * 20);
}

}  // namespace
}  // namespace boltzmann::threads_test
