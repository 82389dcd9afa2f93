// The random path: through every site once, from neighbour to neighbour, and crumpled.
#include <boltzmann/loaders/path_load.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <set>

namespace boltzmann::path_load_test {
namespace {

template <int D>
void expect_a_path(std::array<std::size_t, 3> const& counts) {
  Vector<D> low, high;
  std::size_t size = 1;
  for (int a = 0; a < D; ++a) {
    low[a] = 1, high[a] = 1 + static_cast<double>(counts[static_cast<std::size_t>(a)]);
    size *= counts[static_cast<std::size_t>(a)];
  }
  Box const box(low, high, Boundary::periodic);
  Ensemble<Newton<D>> beads("beads", size);
  path_load(beads, box, {.counts = counts, .seed = test_seed(1)});
  std::set<std::array<double, D>> places;
  for (std::size_t i = 0; i < size; ++i) {
    std::array<double, D> place;
    for (int a = 0; a < D; ++a) {
      place[static_cast<std::size_t>(a)] = beads[i].position[a];
      EXPECT_GT(beads[i].position[a], low[a]);
      EXPECT_LT(beads[i].position[a], high[a]);
    }
    EXPECT_TRUE(places.insert(place).second) << i;
    if (i > 0) {
      EXPECT_NEAR(magnitude(Vector<D>(beads[i].position) - Vector<D>(beads[i - 1].position)), 1, 1e-12) << i;
    }
  }
}
TEST(PathLoad, GoesThroughEverySiteOnceIn1D) { expect_a_path<1>({17, 1, 1}); }
TEST(PathLoad, GoesThroughEverySiteOnceIn2D) { expect_a_path<2>({9, 8, 1}); }
TEST(PathLoad, GoesThroughEverySiteOnceIn3D) { expect_a_path<3>({6, 5, 7}); }

TEST(PathLoad, IsCrumpledAlike) {
  // Of a random path in space no direction is before another: the bonds go along each axis a third of the time.
  Ensemble<Newton<3>> beads("beads", 1000), again("beads", 1000), other("beads", 1000);
  Box const box({0., 0., 0.}, {10., 10., 10.}, Boundary::periodic);
  path_load(beads, box, {.counts = {10, 10, 10}, .seed = test_seed(2)});
  path_load(again, box, {.counts = {10, 10, 10}, .seed = test_seed(2)});
  path_load(other, box, {.counts = {10, 10, 10}, .seed = test_seed(3)});
  double along[3] = {};
  std::size_t same = 0;
  for (std::size_t i = 0; i < 999; ++i) {
    auto const bond = Vector<3>(beads[i + 1].position) - Vector<3>(beads[i].position);
    for (int a = 0; a < 3; ++a) along[a] += std::abs(bond[a]) / 999;
    EXPECT_EQ(Vector<3>(beads[i].position), Vector<3>(again[i].position));
    same += Vector<3>(beads[i].position) == Vector<3>(other[i].position) ? 1 : 0;
  }
  for (double const part : along) EXPECT_NEAR(part, 1.0 / 3, 0.09);  // straight rows would be 0.9, 0.09, 0.01
  EXPECT_LT(same, 100u);
}

TEST(PathLoad, RefusesWhatDoesNotFit) {
  Ensemble<Newton<2>> beads("beads", 10);
  Box const box({0., 0.}, {1., 1.});
  EXPECT_EQ(message([&] {
              path_load(beads, box, {.counts = {3, 3, 1}});
            }),
            "path load: 'beads' has 10 particles, the path goes through 9 sites");
  EXPECT_EQ(message([&] {
              path_load(beads, box, {.counts = {5, 2, 2}});
            }),
            "path load: counts are positive, one for each of 2 axes");
}

}  // namespace
}  // namespace boltzmann::path_load_test
