// Layers and columns of space: who knows least, and as much work for each.
#include <boltzmann/neighbours/shares_of_space.hpp>

#include <tests/bzm/environment.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numeric>
#include <vector>

namespace boltzmann::shares_of_space_test {
namespace {

// A cube of side 67.2 in which 2.8 are read: a rank of 64 in columns of 8.4 x 8.4 knows (8.4 + 5.6)^2 of the plane, in
// layers 67.2 * (1.05 + 5.6), which is 2.3 times that.
TEST(SharesOfSpace, ManyRanksGetColumnsFewOnesLayers) {
  PlaneOfLines const plane{{48, 48}, {1.4, 1.4}};
  auto const layers = [](PlaneOfLines const& of, int ranks) { return layers_for(of, 2.8, ranks, 0.95); };
  EXPECT_EQ(layers(plane, 64), 8);
  EXPECT_EQ(layers_for(plane, 2.8, 64, 0.45), 8);
  EXPECT_EQ(layers_for(plane, 2.8, 64, 0.43), 64) << "(196 of 447 are known)";
  EXPECT_EQ(layers(plane, 16), 4);
  EXPECT_EQ(layers(plane, 4), 4);
  EXPECT_EQ(layers(plane, 2), 2);
  EXPECT_EQ(layers(plane, 1), 1);
  EXPECT_EQ(layers({{4000, 1}, {1.4, 1}}, 64), 64) << "there is one line of lines";
  EXPECT_EQ(layers({{48, 4000}, {1.4, 1.4}}, 64), 64) << "layers of a long box are thick";
}

TEST(SharesOfSpace, AreChosenByAWord) {
  PlaneOfLines const plane{{48, 48}, {1.4, 1.4}};
  test::Environment environment;
  environment.set("BOLTZMANN_SHARES", "layers");
  EXPECT_EQ(layers_for(plane, 2.8, 64, 0.95), 64);
  environment.set("BOLTZMANN_SHARES", "columns");
  EXPECT_EQ(layers_for(plane, 2.8, 4, 0.95), 2);
  environment.set("BOLTZMANN_SHARES", "rows");
  EXPECT_EQ(message([&] { layers_for(plane, 2.8, 4, 0.95); }), "BOLTZMANN_SHARES is 'layers' or 'columns', not 'rows'");
}

std::vector<std::int64_t> ascending(std::int64_t count) {
  std::vector<std::int64_t> all(static_cast<std::size_t>(count));
  std::iota(all.begin(), all.end(), 0);
  return all;
}

/// Lines with work of very unlike density: each rank has its part of it, as whole lines allow, in one block of the plane.
TEST(SharesOfSpace, ColumnsHaveAsMuchWork) {
  PlaneOfLines const plane{{40, 56}, {1, 1}};
  std::vector<std::int64_t> work;
  std::int64_t all = 0, most_of_line = 0;
  for (int second = 0; second < 56; ++second)
    for (int first = 0; first < 40; ++first) {
      work.push_back(first < 10 && second < 30 ? 900 + first : 40);
      all += work.back();
      most_of_line = std::max(most_of_line, work.back());
    }
  for (int const ranks : {1, 5, 12, 30}) {
    int const layers = std::max(1, static_cast<int>(std::sqrt(ranks)));
    auto const owner = columns_of(plane, {ascending(40), ascending(56)}, work, layers, ranks);
    std::vector<std::int64_t> of_rank(static_cast<std::size_t>(ranks));
    std::vector<std::vector<int>> at(static_cast<std::size_t>(ranks));
    for (std::size_t line = 0; line < owner.size(); ++line) {
      ASSERT_LT(owner[line], ranks);
      of_rank[owner[line]] += work[line];
      at[owner[line]].push_back(static_cast<int>(line / 40));
    }
    for (std::size_t r = 0; r < of_rank.size(); ++r) {
      EXPECT_NEAR(static_cast<double>(of_rank[r]), static_cast<double>(all) / ranks,
                  2.0 * static_cast<double>(most_of_line))
          << r << " of " << ranks;
      auto const [low, high] = std::minmax_element(at[r].begin(), at[r].end());
      EXPECT_LE(*high - *low, 56 / layers + 40) << "of a layer";
    }
  }
}

TEST(SharesOfSpace, ThereMayBeMoreRanksThanLines) {
  auto const owner = columns_of({{2, 2}, {1, 1}}, {ascending(2), ascending(2)}, {5, 0, 5, 5}, 3, 9);
  EXPECT_TRUE(std::all_of(owner.begin(), owner.end(), [](auto rank) { return rank < 9; }));
  EXPECT_EQ(columns_of({{2, 2}, {1, 1}}, {ascending(2), ascending(2)}, {0, 0, 0, 0}, 2, 4),
            std::vector<std::uint16_t>(4, 0))
      << "no work at all";
}

}  // namespace
}  // namespace boltzmann::shares_of_space_test
