// Seeds of tests with chance in them: all of them change with BOLTZMANN_TEST_SEED, so that a bound can be tried over
// many seeds (tests/seeds.sh), not found by one. A result that is the same but for rounding everywhere has a fixed
// seed.
#pragma once

#include <cstdint>
#include <cstdlib>

namespace boltzmann {

/// The seed that a test means by `number`: the number itself, or, where the environment's BOLTZMANN_TEST_SEED is a
/// number other than 0, another one of 31 bits that depends on both.
inline std::uint64_t test_seed(std::uint64_t number) {
  static std::uint64_t const chosen = [] {
    char const* const text = std::getenv("BOLTZMANN_TEST_SEED");
    return text ? std::strtoull(text, nullptr, 10) : 0;
  }();
  if (chosen == 0) return number;
  std::uint64_t x = (chosen << 32U) + number + 0x9e3779b97f4a7c15;  // splitmix64
  x = (x ^ (x >> 30U)) * 0xbf58476d1ce4e5b9;
  x = (x ^ (x >> 27U)) * 0x94d049bb133111eb;
  return (x ^ (x >> 31U)) & 0x7fffffff;
}

}  // namespace boltzmann
