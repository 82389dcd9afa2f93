// ExactSum: the exact sum of doubles, rounded once, independent of the order of terms and of their distribution.
#pragma once

#include <boltzmann/core/threads.hpp>

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <mutex>
#include <optional>
#include <span>

namespace boltzmann {

/// Adds numbers exactly; value() is their sum, rounded once to the nearest double (ties to even). So it has the same
/// bits for any order of the terms, also if they were distributed over several sums that are then added. Infinite terms
/// and NaN give what IEEE addition gives. Room for 2^60 terms. No memory is allocated; an ExactSum has 2.6 kB.
///
/// The sum is a whole number of 2^-1074, the least double, kept in digits of 32 bits each in an integer of 64, so that
/// carries may wait (Kulisch's long accumulator). Terms are buffered in a block, which is split into a few numbers of
/// the same sum: exact_sum_kernels.cpp.
class ExactSum {
 public:
  static constexpr std::size_t block = 256;

  void operator+=(double x) {
    waiting_[count_] = x;
    if (++count_ == block) take_waiting();
  }
  /// Adds all these numbers.
  void add(std::span<double const> numbers);
  /// Adds all terms of another sum.
  void add(ExactSum const& other);
  double value() const;

  /// 68 digits, the lowest first, and how many terms were inf, -inf and NaN.
  static constexpr std::size_t words = 71;
  /// The words to add to the words of other sums (Team::sum). Afterwards this sum has the terms of all. At first no
  /// word is beyond 2^32 in magnitude, so that a sum over 2^29 ranks does not overflow.
  std::span<std::int64_t, words> digits();

 private:
  static constexpr std::size_t digit_count = 68, plus = 68, minus = 69, nan = 70;

  /// The number as digits. Only the digits from low to high are set; the others are zero and need not be touched.
  struct Digits {
    std::array<std::int64_t, words> word;
    std::int64_t deposits = 0;  ///< since the last carry: each changes a digit by less than 2^33
    std::size_t low = digit_count, high = 0;

    Digits() { word[plus] = word[minus] = word[nan] = 0; }
    void reach(std::size_t from, std::size_t to);
    void deposit(double x);
    void add(Digits const& other);
    void take(double const* numbers, std::size_t count);
    void carry();
    double value();
  };

  void take_waiting();

  Digits digits_;
  std::size_t count_ = 0;  ///< buffered terms
  alignas(64) double waiting_[block];
};

/// A sum of several threads, each of which first adds up its own terms. The bits do not depend on the order of threads.
class SharedSum {
 public:
  void add(ExactSum const& part) {
    std::lock_guard const lock(one_at_a_time_);
    sum_.add(part);
  }
  // Valid when all threads have added theirs.
  double value() const { return sum_.value(); }
  ExactSum& total() { return sum_; }

 private:
  std::mutex one_at_a_time_;
  ExactSum sum_;
};

/// Adds terms of `size` items to K sums, on several threads: f(i, terms) writes the terms of item i to the array, which
/// is zero before.
template <std::size_t K, class Function>
void add_terms(std::array<ExactSum, K>& sums, std::size_t size, int threads, Function const& f) {
  constexpr std::size_t grain = 32 * ExactSum::block;
  std::mutex one_at_a_time;
  for_ranges(size, grain, threads_for(size, 0.25 * K, threads), [&](std::size_t begin, std::size_t end) {
    std::optional<std::array<ExactSum, K>> own;
    auto& mine = end - begin == size ? sums : own.emplace();
    double terms[K][ExactSum::block];
    for (std::size_t first = begin; first < end; first += ExactSum::block) {
      std::size_t const count = std::min(end - first, ExactSum::block);
      for (std::size_t i = 0; i < count; ++i) {
        std::array<double, K> of_item{};
        f(first + i, of_item);
        for (std::size_t k = 0; k < K; ++k) terms[k][i] = of_item[k];
      }
      for (std::size_t k = 0; k < K; ++k) mine[k].add({terms[k], count});
    }
    if (!own) return;
    std::lock_guard const lock(one_at_a_time);
    for (std::size_t k = 0; k < K; ++k) sums[k].add(mine[k]);
  });
}

/// Adds K interleaved columns: number K i + k to sum k.
template <std::size_t K>
void add_columns(std::array<ExactSum, K>& sums, std::span<double const> numbers, int threads) {
  add_terms(sums, numbers.size() / K, threads, [&](std::size_t i, std::array<double, K>& terms) {
    for (std::size_t k = 0; k < K; ++k) terms[k] = numbers[K * i + k];
  });
}

}  // namespace boltzmann
