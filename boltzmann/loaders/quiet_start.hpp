// Quiet start: evenly spaced numbers in place of random ones, such that subsets are evenly spaced as well.
#pragma once

#include <boltzmann/core/error.hpp>

#include <array>
#include <cstddef>

namespace boltzmann {

/// The rank of i among the numbers 0..count-1, sorted by their digits in this base, the last digit first: a permutation
/// in which the first b^k are evenly spread, and any b^k consecutive ones, too (for base 2 the bit-reversed order of C.
/// K. Birdsall and A. B. Langdon, Plasma physics via computer simulation, chapter 16).
constexpr std::size_t reversed_rank(std::size_t i, std::size_t count, std::size_t base) {
  std::size_t rank = 0;
  // Numbers with the same last digits, and a smaller next digit, precede i.
  for (std::size_t power = 1, rest = i; rest > 0; rest /= base) {
    std::size_t const digit = rest % base, same = i % power;
    for (std::size_t d = 0; d < digit; ++d) {
      std::size_t const first = same + d * power;
      if (first < count) rank += (count - 1 - first) / power / base + 1;
    }
    if (power > count / base) break;
    power *= base;
  }
  return rank;
}

/// The fraction (rank + 1/2) / count of particle i in independent direction 0, 1, ..., 4: bases 2, 3, 5, 7, 11. In each
/// direction all particles together are exactly evenly spaced. The fraction (i + 1/2) / count is one more direction.
/// Error for another direction.
constexpr double quiet_fraction(std::size_t i, std::size_t count, int direction) {
  constexpr std::array<std::size_t, 5> bases{2, 3, 5, 7, 11};
  auto const number = static_cast<std::size_t>(direction);
  if (number >= bases.size()) throw Error("a quiet start has directions 0 to 4");
  return (static_cast<double>(reversed_rank(i, count, bases[number])) + 0.5) / static_cast<double>(count);
}

}  // namespace boltzmann
