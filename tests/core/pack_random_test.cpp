// Philox4x32 in packs against the published known answers, and the distribution of its normals.
#include <boltzmann/core/pack_random.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <vector>

namespace boltzmann::pack_random_test {
namespace {

constexpr int W = native_width<double>;
using Words = detail::Words<W>;

Words widened(std::array<std::uint32_t, W> const& numbers) {
  Words words{};
  for (int lane = 0; lane < W; ++lane) words[lane] = numbers[lane];
  return words;
}

std::array<std::uint32_t, 4> philox(std::array<std::uint32_t, 4> counter, std::uint64_t seed, int lane) {
  RandomWords<W> words = {{Words{}, Words{}, Words{}, Words{}}};
  for (int k = 0; k < 4; ++k) {
    words.word[k] = Words{} + 0xdeadbeef12345678U;  // other lanes, and high halves, must not matter
    words.word[k][lane] = counter[k] | 0xabcdef0100000000U;
  }
  auto const result = philox4x32<W>(words, PhiloxKey(seed));
  std::array<std::uint32_t, 4> out;
  for (int k = 0; k < 4; ++k) out[k] = static_cast<std::uint32_t>(result.word[k][lane]);
  return out;
}

// The known answers that come with the authors' library (kat_vectors).
TEST(PackRandom, philox_gives_the_known_answers) {
  for (int lane = 0; lane < W; ++lane) {
    EXPECT_EQ(philox({0, 0, 0, 0}, 0, lane),
              (std::array<std::uint32_t, 4>{0x6627e8d5, 0xe169c58d, 0xbc57ac4c, 0x9b00dbd8}));
    EXPECT_EQ(philox({0xffffffff, 0xffffffff, 0xffffffff, 0xffffffff}, 0xffffffffffffffff, lane),
              (std::array<std::uint32_t, 4>{0x408f276d, 0x41c83b0e, 0xa20bc7c6, 0x6d5451fd}));
    EXPECT_EQ(philox({0x243f6a88, 0x85a308d3, 0x13198a2e, 0x03707344}, 0x299f31d0a4093822, lane),
              (std::array<std::uint32_t, 4>{0xd16cfe09, 0x94fdcceb, 0x5001e420, 0x24126ea1}));
  }
}

std::array<double, 2> normal_pair(std::uint32_t radius, std::uint32_t angle) {
  auto const pair = normals<W>(Words{} + radius, Words{} + angle);
  return {pair[0][0], pair[1][0]};
}

TEST(PackRandom, normals_lie_where_their_words_say) {
  for (std::uint32_t const radius : {0U, 1U, 2U, 0x7fffffffU, 0x80000000U, 0xb504f333U, 0xfffffff0U, 0xffffffffU})
    for (std::uint32_t angle = 7; angle < 0xfffffff0U - 0x01234567U; angle += 0x01234567U) {
      auto const [x, y] = normal_pair(radius, angle);
      double const expected = std::sqrt(-2 * std::log((radius + 0.5) * 0x1p-32));
      EXPECT_NEAR(std::hypot(x, y), expected, radius > 0xffffff00U ? 3e-5 : 1e-8) << radius;
    }
  // Every direction once: 2^20 evenly spaced angles fill the circle evenly.
  constexpr int sectors = 64;
  std::array<int, sectors> count{};
  for (std::uint32_t k = 0; k < (1U << 20U); ++k) {
    auto const [x, y] = normal_pair(0x80000000U, (k << 12U) + 2048);
    ++count[std::min(sectors - 1, static_cast<int>((std::atan2(y, x) + M_PI) / (2 * M_PI) * sectors))];
  }
  for (int const c : count) EXPECT_NEAR(c, (1 << 20) / sectors, 4);
}

TEST(PackRandom, normals_are_normal) {
  // Moments of 2 * 10^6 numbers within 5 standard errors, and Kolmogorov and Smirnov's largest distance.
  std::vector<double> x;
  PhiloxKey const key(test_seed(42));
  for (std::uint32_t n = 0; x.size() < 2000000; ++n) {
    std::array<std::uint32_t, W> numbers;
    for (int lane = 0; lane < W; ++lane) numbers[lane] = n * W + lane;
    RandomWords<W> const counter = {{widened(numbers), Words{}, Words{}, Words{}}};
    auto const words = philox4x32<W>(counter, key);
    for (int half = 0; half < 2; ++half) {
      auto const pair = normals<W>(words.word[2 * half], words.word[2 * half + 1]);
      for (int lane = 0; lane < W; ++lane) {
        x.push_back(pair[0][lane]);
        x.push_back(pair[1][lane]);
      }
    }
  }
  double const n = static_cast<double>(x.size());
  std::array<double, 5> moment{};
  double neighbours = 0;
  for (std::size_t i = 0; i < x.size(); ++i) {
    for (int k = 1; k < 5; ++k) moment[k] += std::pow(x[i], k) / n;
    if (i > 0) neighbours += x[i] * x[i - 1] / n;
  }
  EXPECT_NEAR(moment[1], 0, 5 / std::sqrt(n));
  EXPECT_NEAR(moment[2], 1, 5 * std::sqrt(2 / n));
  EXPECT_NEAR(moment[3], 0, 5 * std::sqrt(15 / n));
  EXPECT_NEAR(moment[4], 3, 5 * std::sqrt(96 / n));
  EXPECT_NEAR(neighbours, 0, 5 / std::sqrt(n));
  std::sort(x.begin(), x.end());
  double distance = 0;
  for (std::size_t i = 0; i < x.size(); ++i)
    distance =
        std::max(distance, std::abs(0.5 * std::erfc(-x[i] / std::sqrt(2.0)) - (static_cast<double>(i) + 0.5) / n));
  EXPECT_LT(distance, 2.74 / std::sqrt(n));  // exceeded once in 2 million times
}

}  // namespace
}  // namespace boltzmann::pack_random_test
