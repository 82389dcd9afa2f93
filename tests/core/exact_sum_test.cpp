// Exact sums: against a sum of single bits and against quadruple precision, in any order and from any parts.
#include "tests/thread_team.hpp"

#include <boltzmann/core/exact_sum.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

namespace boltzmann::exact_sum_test {
namespace {

constexpr double infinite = std::numeric_limits<double>::infinity(), least = 0x1p-1074,
                 largest = std::numeric_limits<double>::max();

std::uint64_t bits_of(double x) { return std::bit_cast<std::uint64_t>(x); }

double sum_of(std::vector<double> const& terms) {
  ExactSum sum;
  for (double const x : terms) sum += x;
  return sum.value();
}

/// How many of each power of two from 2^-1074 on the terms have, positive less negative, made to bits by hand; rounded
/// as IEEE 754 says: to 53 bits or to whole numbers of the least double, ties to even.
double sum_by_bits(std::vector<double> const& terms) {
  std::vector<std::int64_t> count(2300);
  for (double const x : terms) {
    int exponent = 0;
    auto mantissa = static_cast<std::int64_t>(std::ldexp(std::frexp(std::abs(x), &exponent), 53));
    for (int place = exponent - 53 + 1074; mantissa != 0; ++place, mantissa >>= 1)
      if (mantissa & 1) count[static_cast<std::size_t>(place)] += x < 0 ? -1 : 1;
  }
  auto const carry = [&] {
    for (std::size_t b = 0; b + 1 < count.size(); ++b) {
      std::int64_t const bit = count[b] & 1;
      count[b + 1] += (count[b] - bit) / 2;
      count[b] = bit;
    }
  };
  carry();
  bool const negative = count.back() < 0;
  if (negative)
    for (auto& n : count) n = -n;
  carry();
  std::size_t top = count.size();
  while (top > 0 && count[top - 1] == 0) --top;
  std::size_t const low = top > 53 ? top - 53 : 0;
  std::int64_t mantissa = 0;
  for (std::size_t b = top; b-- > low;) mantissa = 2 * mantissa + count[b];
  bool const half = low > 0 && count[low - 1] == 1;
  bool more = false;
  for (std::size_t b = 0; b + 1 < low; ++b) more = more || count[b] != 0;
  if (half && (more || mantissa % 2 == 1)) ++mantissa;
  double const magnitude = std::ldexp(static_cast<double>(mantissa), static_cast<int>(low) - 1074);
  return negative ? -magnitude : magnitude;
}

class Terms {
 public:
  explicit Terms(unsigned seed) : random_(seed) {}
  std::size_t below(std::size_t n) { return std::uniform_int_distribution<std::size_t>(0, n - 1)(random_); }
  double normal() { return normal_(random_); }
  /// Any finite double whose exponent is between these.
  double any(int low, int high) {
    double const mantissa = 1 + std::ldexp(static_cast<double>(random_() >> 12U), -52);
    double const x = std::ldexp(mantissa, low + static_cast<int>(below(static_cast<std::size_t>(high - low + 1))));
    return random_() & 1U ? -x : x;
  }
  /// Of one of five kinds.
  std::vector<double> some(std::size_t size) {
    std::vector<double> terms(size);
    auto const kind = below(5);
    for (double& x : terms)
      x = kind == 0   ? normal()
          : kind == 1 ? any(-1090, 1022)
          : kind == 2 ? any(-1080, -1000)
          : kind == 3 ? any(960, 1022)
                      : any(-60, 60);
    if (below(2) == 0)  // nearly all cancels
      for (std::size_t i = 0; i + 1 < size; i += 2)
        if (below(50) != 0) terms[i + 1] = -terms[i];
    shuffle(terms);
    return terms;
  }
  template <class List>
  void shuffle(List& terms) {
    std::shuffle(terms.begin(), terms.end(), random_);
  }

 private:
  std::mt19937_64 random_;
  std::normal_distribution<double> normal_;
};

TEST(ExactSum, HasTheBitsOfASumOfBits) {
  Terms random(1);
  for (int n = 0; n < 600; ++n) {
    auto const terms = random.some(random.below(n % 20 == 0 ? 3000 : 300));
    ASSERT_EQ(bits_of(sum_of(terms)), bits_of(sum_by_bits(terms))) << "case " << n << " of " << terms.size();
  }
}

TEST(ExactSum, IsQuadruplePrecisionRoundedOnce) {
  Terms random(2);
  std::vector<double> terms((1U << 20U) + 77);
  __float128 quad = 0;
  for (double& x : terms) {
    x = std::round(std::ldexp(random.normal(), 60)) * 0x1p-60;  // so that no more than 113 bits are needed
    quad += x;
  }
  EXPECT_EQ(bits_of(sum_of(terms)), bits_of(static_cast<double>(quad)));
}

TEST(ExactSum, DoesNotDependOnOrderOrParts) {
  Terms random(3);
  for (int n = 0; n < 60; ++n) {
    auto terms = random.some(1 + random.below(5000));
    double const truth = sum_of(terms);
    random.shuffle(terms);
    std::vector<ExactSum> parts(1 + random.below(9));
    std::span<double const> left = terms;
    while (!left.empty()) {
      auto const some = std::min(left.size(), random.below(1500));
      auto& part = parts[random.below(parts.size())];
      if (random.below(2) == 0)
        part.add(left.first(some));
      else
        for (double const x : left.first(some)) part += x;
      left = left.subspan(some);
    }
    random.shuffle(parts);
    ExactSum all;
    for (auto const& part : parts) all.add(part);
    ASSERT_EQ(bits_of(all.value()), bits_of(truth)) << "case " << n;
    for (std::size_t p = 1; p < parts.size(); ++p) {
      auto const more = parts[p].digits();
      for (auto const digit : more) ASSERT_LE(std::abs(digit), std::int64_t{1} << 32U);
      auto const digits = parts[0].digits();
      for (std::size_t w = 0; w < digits.size(); ++w) digits[w] += more[w];
    }
    ASSERT_EQ(bits_of(parts[0].value()), bits_of(truth)) << "case " << n;
  }
}

TEST(ExactSum, IsThatOfAllRanksOfATeam) {
  Terms random(4);
  auto const terms = random.some(4000);
  double const truth = sum_of(terms);
  for (int const size : {1, 2, 3, 5}) {
    auto const thrown = test::ThreadTeam(size).run([&](Team& team) {
      ExactSum sum;
      for (std::size_t i = static_cast<std::size_t>(team.rank()); i < terms.size(); i += static_cast<std::size_t>(size))
        sum += terms[i];
      team.sum(sum.digits());
      EXPECT_EQ(bits_of(sum.value()), bits_of(truth));
    });
    for (auto const& one : thrown) EXPECT_FALSE(one);
  }
}

TEST(ExactSum, ManyRanksDoNotOverflow) {
  ExactSum sum;
  for (int k = 0; k < 1000; ++k) sum += k % 2 ? -0x1.fffffffffffffp1022 : 0x1.ffffffffffffbp900;
  double const one = sum.value();
  auto const digits = sum.digits();
  for (auto& digit : digits) digit *= std::int64_t{1} << 20U;
  EXPECT_EQ(sum.value(), -infinite);
  sum += -0x1p1000;  // and goes on from there
  auto const again = sum.digits();
  EXPECT_LE(std::abs(again[67]), std::int64_t{1} << 32U);
  EXPECT_EQ(one, -infinite);

  ExactSum small;
  for (int k = 0; k < 1000; ++k) small += 1 / (1.0 + k);
  double const value = small.value();
  for (auto& digit : small.digits()) digit *= std::int64_t{1} << 20U;
  small += 0x1p-1074;
  EXPECT_EQ(small.value(), std::ldexp(value, 20));
}

TEST(ExactSum, WhatCancelsIsGone) {
  EXPECT_EQ(sum_of({1e300, 1, -1e300}), 1);
  EXPECT_EQ(sum_of({1, 0x1p-53}), 1);                      // a tie
  EXPECT_EQ(sum_of({1, 0x1p-53, least}), 1 + 0x1p-52);     // not quite
  EXPECT_EQ(sum_of({1 + 0x1p-52, 0x1p-53}), 1 + 0x1p-51);  // ties go to even
  EXPECT_EQ(sum_of({1e300, least, -1e300}), least);
  EXPECT_EQ(sum_of({-1e300, -least, 1e300}), -least);
  EXPECT_EQ(bits_of(sum_of({5, -5})), bits_of(0.0));
  EXPECT_EQ(bits_of(sum_of({})), bits_of(0.0));
  EXPECT_EQ(bits_of(sum_of({-0.0, -0.0})), bits_of(0.0));
}

TEST(ExactSum, SubnormalsCount) {
  EXPECT_EQ(sum_of(std::vector<double>(1000, least)), 1000 * least);
  EXPECT_EQ(sum_of({0x1p-1022, -least}), 0x1p-1022 - least);
  EXPECT_EQ(sum_of({0x1p-1022, -0x1p-1022, -3 * least}), -3 * least);
}

TEST(ExactSum, IsInfiniteOnlyWhereTheSumIs) {
  EXPECT_EQ(sum_of({largest, largest, -largest}), largest);
  EXPECT_EQ(sum_of({largest, largest, largest, -largest, -largest, -largest, 1}), 1);
  EXPECT_EQ(sum_of({largest, largest}), infinite);
  EXPECT_EQ(sum_of({-largest, -largest}), -infinite);
  double const half = 0x1p970;  // half of the last place of the largest
  EXPECT_EQ(sum_of({largest, half}), infinite);
  EXPECT_EQ(sum_of({largest, half, -least}), largest);
  EXPECT_EQ(sum_of({largest, std::nextafter(half, 0)}), largest);
  EXPECT_EQ(sum_of(std::vector<double>(100000, -largest)), -infinite);
}

TEST(ExactSum, InfinityAndNaNAreThoseOfIEEE) {
  double const nan = std::numeric_limits<double>::quiet_NaN();
  std::vector<double> const kinds{1, -0x1p1000, infinite, -infinite, nan};
  Terms random(5);
  for (int n = 0; n < 300; ++n) {
    std::vector<double> terms(1 + random.below(700), 0.5);
    for (auto k = random.below(4); k > 0; --k) terms[random.below(terms.size())] = kinds[random.below(5)];
    double ieee = 0;
    for (double const x : terms) ieee += x;
    double const found = sum_of(terms);
    if (std::isnan(ieee)) {
      ASSERT_TRUE(std::isnan(found));
    } else if (std::isinf(ieee) || std::abs(ieee) < 1000) {
      ASSERT_EQ(found, ieee);
    }
    ExactSum first, second;
    for (std::size_t i = 0; i < terms.size(); ++i) (i % 3 ? first : second) += terms[i];
    auto const digits = first.digits(), others = second.digits();
    for (std::size_t w = 0; w < digits.size(); ++w) digits[w] += others[w];
    double const merged = first.value();
    ASSERT_TRUE(std::isnan(found) ? std::isnan(merged) : bits_of(merged) == bits_of(found));
  }
}

TEST(ExactSum, HasRoomForMoreThanAThousandMillionTerms) {
  Terms random(6);
  std::vector<double> terms(1U << 16U);
  for (double& x : terms) x = 1 + random.any(-40, 3);
  double const one = sum_by_bits(terms);
  ExactSum sum;
  for (int k = 0; k < 1 << 14; ++k) sum.add(terms);
  EXPECT_EQ(sum.value(), std::ldexp(one, 14));
  for (int k = 0; k < 45; ++k) {
    ExactSum const same = sum;
    sum.add(same);
  }
  EXPECT_EQ(sum.value(), std::ldexp(one, 59));
}

TEST(ExactSum, OfItemsOnThreadsHasTheSameBits) {
  Terms random(7);
  std::size_t const size = 70001;
  std::vector<double> x(size), y(size);
  for (double& a : x) a = random.normal();
  for (double& a : y) a = random.any(-30, 30);
  std::vector<double> products(size);
  for (std::size_t i = 0; i < size; ++i) products[i] = x[i] * y[i];
  for (int const threads : {1, 2, 5}) {
    std::array<ExactSum, 3> sums;
    sums[2] += 1;
    add_terms(sums, size, threads, [&](std::size_t i, std::array<double, 3>& terms) {
      terms[0] = x[i];
      terms[1] = x[i] * y[i];
    });
    EXPECT_EQ(bits_of(sums[0].value()), bits_of(sum_by_bits(x)));
    EXPECT_EQ(bits_of(sums[1].value()), bits_of(sum_by_bits(products)));
    EXPECT_EQ(sums[2].value(), 1);
  }
}

}  // namespace
}  // namespace boltzmann::exact_sum_test
