// Quiet start: numbers in place of random ones that fill an interval evenly, and any few of them as well.
#pragma once

#include <boltzmann/core/error.hpp>

#include <array>
#include <cstddef>

namespace boltzmann {

/// How many of the numbers 0..count-1 come before i when they are sorted by their digits in this base, the last digit
/// first: a permutation in which the first b^k are spread evenly, and any b^k that follow each other too (for base 2
/// the bit-reversed order of C. K. Birdsall and A. B. Langdon, Plasma physics via computer simulation, chapter 16).
constexpr std::size_t reversed_rank(std::size_t i, std::size_t count, std::size_t base) {
  std::size_t rank = 0;
  // Before i come those that have its last digits, and the next digit smaller.
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
/// direction all particles together are exactly even. The fraction (i + 1/2) / count is one more direction. Error for
/// another direction.
constexpr double quiet_fraction(std::size_t i, std::size_t count, int direction) {
  constexpr std::array<std::size_t, 5> bases{2, 3, 5, 7, 11};
  auto const number = static_cast<std::size_t>(direction);
  if (number >= bases.size()) throw Error("a quiet start has directions 0 to 4");
  return (static_cast<double>(reversed_rank(i, count, bases[number])) + 0.5) / static_cast<double>(count);
}

}  // namespace boltzmann
