// Many inputs, one like the other but for something: whatever they are, they are read or refused, in time and with
// little memory.
#include "mutator.hpp"
#include "targets.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tests/cpu_time.hpp>
#include <tests/seed.hpp>

#include <chrono>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>

namespace boltzmann::fuzz {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

class Fuzz : public testing::TestWithParam<std::string> {};

TEST_P(Fuzz, WhateverIsReadIsTakenOrRefused) {
  auto const& what = target(GetParam());
  auto pool = what.seeds();
  ASSERT_FALSE(pool.empty());
  // Inputs that have been a defect once.
  auto const corpus = std::filesystem::path(BOLTZMANN_SOURCE) / "tests/fuzz/corpus" / GetParam();
  if (std::filesystem::is_directory(corpus))
    for (auto const& entry : std::filesystem::directory_iterator(corpus)) {
      std::ifstream file(entry.path(), std::ios::binary);
      pool.emplace_back(std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>());
    }
  Mutator mutator(pool, what.words, test_seed(1));
  // Ten thousand, or as many as can be read in some seconds; all that can be read in the seconds that somebody wants.
  char const* told = std::getenv("BOLTZMANN_FUZZ_SECONDS");
  double const end = cpu_seconds() + (told ? std::atof(told) : 4);
  std::size_t const most = told ? SIZE_MAX : 10000;
  std::size_t cases = 0;
  auto const read = [&](std::string const& bytes) {
    auto const since = Clock::now();
    try {
      what.read(bytes);
    } catch (std::exception const& error) {
      ADD_FAILURE() << error.what() << "\nfrom case " << cases << ":\n" << bytes.substr(0, 4000);
    }
    ++cases;
    EXPECT_LT(seconds_since(since), 10) << bytes.substr(0, 4000);
  };
  for (auto const& bytes : pool) read(bytes);
  rusage before{};
  getrusage(RUSAGE_SELF, &before);
  while (cases < most && cpu_seconds() < end && !HasFailure()) read(mutator.next());
  rusage after{};
  getrusage(RUSAGE_SELF, &after);
  EXPECT_LT(after.ru_maxrss - before.ru_maxrss, 1'000'000) << "kB";
  RecordProperty("cases", static_cast<int>(cases));
  std::printf("%s: %zu cases\n", GetParam().c_str(), cases);
}

std::vector<std::string> names() {
  std::vector<std::string> all;
  for (auto const& one : targets()) all.push_back(one.name);
  return all;
}
INSTANTIATE_TEST_SUITE_P(Targets, Fuzz, testing::ValuesIn(names()), [](auto const& info) { return info.param; });

}  // namespace
}  // namespace boltzmann::fuzz
