// Neighbourhoods against brute force: particles that drift, some fast, lists of different and changing cut-offs, more
// particles, and a state that is taken back.
#include <boltzmann/core/error.hpp>
#include <boltzmann/neighbours/neighbourhood.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <random>
#include <utility>
#include <vector>

namespace boltzmann::neighbourhood_test {
namespace {

using Pairs = std::vector<std::pair<std::uint32_t, std::uint32_t>>;

struct Gas {
  Box box{Vector{-1.0, 0.0}, Vector{9.0, 11.0}, {Boundary::periodic, Boundary::reflecting}};
  Ensemble<Newton<2>> few{"few", 40}, many{"many", 900};
  std::mt19937_64 random{test_seed(3)};

  Gas() {
    scatter(few);
    scatter(many);
    many[7].velocity = Vector{0.9, -0.6};
    few[3].velocity = Vector{-0.4, 0.7};
  }
  void scatter(Ensemble<Newton<2>>& ensemble) {
    for (auto& p : ensemble)
      for (int a = 0; a < 2; ++a) {
        p.position[a] = std::uniform_real_distribution(box.low(a), box.high(a))(random);
        p.velocity[a] = std::uniform_real_distribution(-0.004, 0.004)(random);
      }
  }
  void step() {
    for (auto* ensemble : {&few, &many}) {
      for (auto& p : *ensemble) p.position = p.position + p.velocity;
      box.apply(*ensemble);
    }
  }
  /// All (i, j) of two ensembles whose nearest images are within the cut-off.
  Pairs near(Ensemble<Newton<2>>& a, Ensemble<Newton<2>>& b, double cutoff) const {
    Pairs pairs;
    for (std::uint32_t i = 0; i < a.size(); ++i)
      for (std::uint32_t j = 0; j < b.size(); ++j) {
        auto d = b[j].position - a[i].position;
        box.nearest_image(&d[0]);
        if (!(&a == &b && i == j) && norm2(d) < cutoff * cutoff) pairs.emplace_back(i, j);
      }
    return pairs;
  }
};

/// The same, as a list has them: those within its cut-off among what is read.
Pairs listed(Neighbourhood const& hood, std::size_t list, Box const& box) {
  SortedCopy const &target = hood.target(list), &source = hood.source(list);
  double const cutoff = hood.cutoff(list);
  Pairs pairs;
  for (std::size_t i = 0; i < target.owned(); ++i)
    for (std::uint32_t k = 0; k < hood.list(list).lengths(hood.ring())[i]; ++k) {
      std::size_t const row = row_of_item(hood.list(list).rows()[i][k]);
      double const *x = target.rows() + 4 * i, *y = source.rows() + 4 * row;
      double const dx = y[0] - x[0], dy = y[1] - x[1];
      if (!(dx * dx + dy * dy < cutoff * cutoff)) continue;  // the sentinel too
      // An image is told by its place.
      std::size_t owned = row;
      for (std::size_t s = 0; row > source.sentinel() && s < source.owned(); ++s) {
        double d[2] = {source.rows()[4 * s] - y[0], source.rows()[4 * s + 1] - y[1]};
        box.nearest_image(d);
        if (std::max(std::abs(d[0]), std::abs(d[1])) < 1e-12) owned = s;
      }
      pairs.emplace_back(target.order()[i], owned < source.owned() ? source.order()[owned] : ~0U);
    }
  std::sort(pairs.begin(), pairs.end());
  return pairs;
}

TEST(Neighbourhood, ListsHaveAllThatAreNear) {
  Gas gas;
  Neighbourhood hood(gas.box);
  EXPECT_TRUE(hood.empty());
  hood.refresh(1);  // of nothing
  std::size_t const own = hood.add(gas.many, gas.many, 0.5), other = hood.add(gas.few, gas.many, 0.8);
  EXPECT_DOUBLE_EQ(hood.skin(), 0.12 * 0.8);
  Neighbourhood other_hood(gas.box, 0.7);
  other_hood.add(gas.many, gas.many, 0.5);
  EXPECT_DOUBLE_EQ(other_hood.skin(), 0.12 * 0.7);
  for (int n = 0; n < 60; ++n) {
    if (n == 20) hood.cutoff(own, 1.1);
    if (n == 40) hood.cutoff(other, 0.3);
    if (n == 50) {
      gas.many.resize(1000);
      gas.scatter(gas.many);
    }
    hood.refresh(2);
    ASSERT_EQ(listed(hood, own, gas.box), gas.near(gas.many, gas.many, n < 20 ? 0.5 : 1.1)) << n;
    ASSERT_EQ(listed(hood, other, gas.box), gas.near(gas.few, gas.many, n < 40 ? 0.8 : 0.3)) << n;
    gas.step();
  }
  // The crowd goes half a skin in some 10 steps; the fast ones go ten skins in one.
  EXPECT_LE(hood.builds(), 15u);
  EXPECT_GE(hood.moves(), 20u);
}

TEST(Neighbourhood, CutoffsOfNowMakeNothingStale) {
  Gas gas;
  Neighbourhood hood(gas.box);
  std::size_t const list = hood.add(gas.many, gas.many, 0.5);
  hood.refresh(1);
  hood.cutoff(list, 0.5);
  hood.refresh(1);
  EXPECT_EQ(hood.builds(), 1u);
  hood.stale();
  hood.refresh(1);
  EXPECT_EQ(hood.builds(), 2u);
}

TEST(Neighbourhood, GoesOnFromAState) {
  Gas gas;
  Neighbourhood hood(gas.box), again(gas.box);
  for (auto* each : {&hood, &again}) {
    each->add(gas.many, gas.many, 0.5);
    each->add(gas.few, gas.many, 0.8);
    each->add(gas.many, gas.few, 0.8);
  }
  for (int n = 0; n < 30; ++n) {
    hood.refresh(1);
    gas.step();
  }
  ASSERT_GT(hood.moves(), 0u);
  again.restore(hood.state(), 1);
  for (int n = 0; n < 30; ++n) {
    hood.refresh(1);
    again.refresh(2);
    ASSERT_EQ(hood.ring(), again.ring());
    ASSERT_EQ(hood.state(), again.state());
    for (std::size_t list = 0; list < 3; ++list)
      for (std::size_t i = 0; i < hood.target(list).owned(); ++i) {
        ASSERT_EQ(hood.target(list).order()[i], again.target(list).order()[i]);
        auto const row = [&](Neighbourhood const& of) {
          std::vector<std::pair<double, double>> places;
          for (std::uint32_t k = 0; k < of.list(list).lengths(of.ring())[i]; ++k) {
            double const* y = of.source(list).rows() + 4 * row_of_item(of.list(list).rows()[i][k]);
            if (!std::isnan(y[0])) places.emplace_back(y[0], y[1]);
          }
          return places;
        };
        ASSERT_EQ(row(hood), row(again)) << n;
      }
    gas.step();
  }
  auto state = hood.state();
  state.pop_back();
  EXPECT_THROW(again.restore(state, 1), Error);
  EXPECT_THROW(again.restore({}, 1), Error);
}

TEST(Neighbourhood, RefusesLengthsThatAreNone) {
  Gas gas;
  Neighbourhood hood(gas.box);
  double const nan = std::numeric_limits<double>::quiet_NaN(), infinity = std::numeric_limits<double>::infinity();
  for (double const wrong : {0.0, -1.0, nan, infinity}) EXPECT_THROW(hood.add(gas.few, gas.few, wrong), Error) << wrong;
  hood.add(gas.few, gas.few, 0.4);
  for (double const wrong : {0.0, -1.0, nan, infinity}) EXPECT_THROW(hood.cutoff(0, wrong), Error) << wrong;
  for (double const wrong : {-1.0, nan, infinity}) EXPECT_THROW(hood.skin(wrong), Error) << wrong;
  hood.skin(0);
  EXPECT_EQ(hood.skin(), 0);
  gas.few[2].position[0] = nan;
  EXPECT_THROW(hood.refresh(1), PhysicsFailure);
}

TEST(Neighbourhood, NobodyHasNeighboursAlone) {
  Box const box(Vector{0.0, 0.0}, Vector{1.0, 1.0});
  Ensemble<Newton<2>> none("none", 0), one("one", 1);
  Neighbourhood hood(box);
  std::size_t const self = hood.add(one, one, 0.4), nobody = hood.add(one, none, 0.4),
                    for_nobody = hood.add(none, one, 0.4);
  hood.refresh(1);
  for (std::size_t const list : {self, nobody, for_nobody}) EXPECT_TRUE(listed(hood, list, box).empty());
}

}  // namespace
}  // namespace boltzmann::neighbourhood_test
