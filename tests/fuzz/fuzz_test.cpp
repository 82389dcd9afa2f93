// Many inputs, one like the other but for something: whatever they are, they are read or refused, in time and with
// little memory.
#include "targets.hpp"

#include <gtest/gtest.h>
#include <sys/resource.h>
#include <tests/seed.hpp>

#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <random>

namespace boltzmann::fuzz {
namespace {

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// Another input than that: some bytes, words, lines or pieces of others.
class Mutator {
 public:
  Mutator(std::vector<std::string> const& pool, std::vector<std::string> const& words, std::uint64_t seed)
      : pool_(pool), words_(words), random_(seed) {}

  std::string next() {
    std::string text = pool_[below(pool_.size())];
    for (std::size_t k = 1 + below(4); k > 0; --k) change(text);
    return text;
  }

 private:
  std::size_t below(std::size_t n) {
    return n == 0 ? 0 : std::uniform_int_distribution<std::size_t>(0, n - 1)(random_);
  }
  std::string piece(std::string const& text) {
    std::size_t const at = below(text.size() + 1);
    return text.substr(at, below(std::min<std::size_t>(text.size() - at, 64) + 1));
  }
  /// The number or word around a place.
  static std::pair<std::size_t, std::size_t> token(std::string const& text, std::size_t at) {
    auto const part = [&](std::size_t k) {
      return k < text.size() && (std::isalnum(static_cast<unsigned char>(text[k])) || text[k] == '.' || text[k] == '-');
    };
    std::size_t from = at, to = at;
    while (from > 0 && part(from - 1)) --from;
    while (part(to)) ++to;
    return {from, to - from};
  }
  void change(std::string& text) {
    std::size_t const at = below(text.size() + 1);
    switch (below(words_.empty() ? 5 : 9)) {
      case 0:
        if (at < text.size()) text[at] = static_cast<char>(below(256));
        break;
      case 1:
        if (at < text.size()) text[at] = static_cast<char>(static_cast<unsigned char>(text[at]) ^ (1U << below(8)));
        break;
      case 2:
        text.erase(at, below(std::min<std::size_t>(text.size() - at, 40) + 1));
        break;
      case 3:
        text.insert(at, piece(pool_[below(pool_.size())]));
        break;
      case 4:
        if (below(20) == 0) text.resize(at);
        break;
      case 5:
        text.insert(at, words_[below(words_.size())]);
        break;
      case 6:
      case 7: {
        auto const [from, count] = token(text, at);
        text.replace(from, count, words_[below(words_.size())]);
        break;
      }
      default: {  // a line twice, or gone
        std::size_t const from = text.rfind('\n', at) + 1, to = text.find('\n', at);
        if (to == std::string::npos) break;
        std::string const line = text.substr(from, to + 1 - from);
        if (below(2) == 0)
          text.erase(from, line.size());
        else
          text.insert(from, line);
      }
    }
  }

  std::vector<std::string> const& pool_;
  std::vector<std::string> const& words_;
  std::mt19937_64 random_;
};

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
  char const* told = std::getenv("BOLTZMANN_FUZZ_SECONDS");
  double const seconds = told ? std::atof(told) : 10;
  auto const start = Clock::now();
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
  while (seconds_since(start) < seconds && !HasFailure()) read(mutator.next());
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
