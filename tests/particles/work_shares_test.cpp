// Stretches of one order that ranks share: as much work for each, whatever the work of items is.
#include "tests/thread_team.hpp"

#include <boltzmann/particles/work_shares.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdint>
#include <functional>
#include <numeric>
#include <vector>

namespace boltzmann::work_shares_test {
namespace {

/// The work of the busiest rank, over that of all in the mean, after so many calculations.
double imbalance(std::function<double(std::size_t)> const& work, std::size_t items, int ranks, int calculations) {
  double worst = 0;
  test::ThreadTeam(ranks).run([&](Team& team) {
    WorkShares shares;
    shares.divide(&team);
    std::vector<double> of_rank;
    std::vector<WorkShares::Work> of_parts;
    for (int k = 0; k <= calculations; ++k) {
      auto const cuts = shares.balanced(items);
      ASSERT_EQ(cuts.size(), static_cast<std::size_t>(ranks) + 1);
      EXPECT_EQ(cuts.front(), 0U);
      EXPECT_EQ(cuts.back(), items);
      EXPECT_TRUE(std::is_sorted(cuts.begin(), cuts.end()));
      of_rank.assign(static_cast<std::size_t>(ranks), 0);
      of_parts.assign(static_cast<std::size_t>(ranks), {});
      for (std::size_t r = 0; r < of_rank.size(); ++r)
        for (std::size_t i = cuts[r]; i < cuts[r + 1]; ++i) {
          of_rank[r] += work(i);
          of_parts[r][(i - cuts[r]) * WorkShares::parts / (cuts[r + 1] - cuts[r])] +=
              static_cast<std::uint64_t>(work(i));
        }
      shares.took(cuts, of_parts);
    }
    if (team.first())
      worst = *std::max_element(of_rank.begin(), of_rank.end()) * ranks /
              std::accumulate(of_rank.begin(), of_rank.end(), 0.0);
  });
  return worst;
}

TEST(WorkShares, ComeToTakeTheSameWork) {
  EXPECT_EQ(imbalance([](std::size_t) { return 1.0; }, 1000, 5, 0), 1);
  auto const clustered = [](std::size_t i) { return i < 700 ? 1.0 : i < 720 ? 200.0 : 3.0; };
  EXPECT_GT(imbalance(clustered, 1000, 4, 0), 2);
  EXPECT_LT(imbalance(clustered, 1000, 4, 3), 1.2) << "an item of 200 is 14 % of a rank's work";
  auto const slope = [](std::size_t i) { return static_cast<double>(i); };
  EXPECT_LT(imbalance(slope, 100'000, 7, 4), 1.01);
}

TEST(WorkShares, NobodyHasWorkAndMoreRanksThanItems) {
  EXPECT_LT(imbalance([](std::size_t i) { return i == 2 ? 1.0 : 0.0; }, 3, 8, 5), 8.01);
  imbalance([](std::size_t) { return 0.0; }, 10, 3, 3);
}

TEST(WorkShares, BringWhatEachHasFound) {
  constexpr int size = 3;
  auto const thrown = test::ThreadTeam(size).run([&](Team& team) {
    WorkShares shares;
    shares.divide(&team);
    std::vector<double> numbers(70);
    std::vector<int> marks(7);
    auto const many = shares.even(7, 2), few = shares.even(2);
    EXPECT_EQ(many, (WorkShares::Cuts{0, 2, 4, 7}));
    for (std::size_t i = many[shares.rank()]; i < many[shares.rank() + 1]; ++i) {
      marks[i] = static_cast<int>(100 + i);
      for (std::size_t k = 0; k < 10; ++k) numbers[10 * i + k] = static_cast<double>(10 * i + k);
    }
    std::vector<std::size_t> two(2);
    for (std::size_t i = few[shares.rank()]; i < few[shares.rank() + 1]; ++i) two[i] = i + 5;
    shares.bring({{numbers.data(), 10 * sizeof(double), &many},
                  {marks.data(), sizeof(int), &many},
                  {two.data(), sizeof two[0], &few}});
    for (std::size_t k = 0; k < numbers.size(); ++k) EXPECT_EQ(numbers[k], static_cast<double>(k));
    for (std::size_t k = 0; k < marks.size(); ++k) EXPECT_EQ(marks[k], static_cast<int>(100 + k));
    EXPECT_EQ(two, (std::vector<std::size_t>{5, 6}));
    EXPECT_EQ(team.counts().collectives, 2U);
  });
  for (auto const& failure : thrown) EXPECT_EQ(test::line_of(failure), "");
}

}  // namespace
}  // namespace boltzmann::work_shares_test
