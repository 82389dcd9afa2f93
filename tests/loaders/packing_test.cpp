// Random sequential addition: no overlaps, the fraction that was asked for, and its end where it is known to be.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/particles/newton.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>

namespace boltzmann::packing_test {
namespace {

template <int D>
Box periodic(double side) {
  Vector<D> low{}, high{};
  for (int a = 0; a < D; ++a) high[a] = side;
  return Box(low, high, Boundary::periodic);
}

template <int D>
double nearest_distance(Ensemble<Newton<D>> const& balls, Box const& box) {
  double nearest = INFINITY;
  for (std::size_t i = 0; i < balls.size(); ++i)
    for (std::size_t j = 0; j < i; ++j) {
      auto d = balls[i].position - balls[j].position;
      box.nearest_image(&d[0]);
      nearest = std::min(nearest, magnitude(d));
    }
  return nearest;
}

template <int D>
void expect_packing(double fraction, std::size_t count, double volume_of_one) {
  Ensemble<Newton<D>> balls("balls", count);
  Box const box = periodic<D>(10);
  random_load(balls, box, {.packing_fraction = fraction, .seed = test_seed(2)});
  double const diameter = balls.appearance.diameter;
  EXPECT_NEAR(volume_of_one * std::pow(diameter, D) * static_cast<double>(count) / std::pow(10., D), fraction, 1e-12);
  EXPECT_GE(nearest_distance(balls, box), diameter);
  EXPECT_LT(nearest_distance(balls, box), 1.01 * diameter);
}

TEST(Packing, FillsTheFractionWithoutOverlaps) {
  expect_packing<1>(0.7, 400, 1);
  expect_packing<2>(0.53, 400, pi / 4);  // 97 % of what can be reached
  expect_packing<3>(0.36, 400, pi / 6);
}

/// How many there are when there is no place for another one.
template <int D>
double saturated(double side, std::size_t more_than) {
  Ensemble<Newton<D>> balls("balls", more_than);
  std::string const text =
      message([&] { random_load(balls, periodic<D>(side), {.minimum_distance = 1, .seed = test_seed(3)}); });
  std::size_t const at = text.find("full with ");
  EXPECT_NE(at, std::string::npos) << text;
  return at == std::string::npos ? 0 : std::stod(text.substr(at + 10));
}

// The number of rods on a long line has a variance of 0.0382 of the line's length (J. K. Mackenzie, J. Chem. Phys. 37, 723
// (1962)); that of discs and spheres is smaller still in parts of their number.
TEST(Packing, EndsAtSaturation) {
  double const rods = saturated<1>(5000, 5000), discs = saturated<2>(36, 1500), spheres = saturated<3>(10, 1500);
  std::printf("[ PACKING  ] saturated at %.4f, %.4f and %.4f\n", rods / 5000, discs * pi / 4 / 1296,
              spheres * pi / 6 / 1000);
  EXPECT_NEAR(rods, 0.7475979 * 5000, 5 * std::sqrt(0.0382 * 5000));
  EXPECT_NEAR(discs * pi / 4 / 1296, 0.547, 0.01);
  EXPECT_NEAR(spheres * pi / 6 / 1000, 0.384, 0.01);
}

TEST(Packing, IsRefusedAboveItsLimit) {
  Ensemble<Newton<2>> discs("discs", 100);
  Box const box = periodic<2>(10);
  EXPECT_EQ(message([&] { random_load(discs, box, {.packing_fraction = 0.6}); }),
            "the packing fraction 0.6 is out of reach: 2-dimensional discs that are added at random leave no place for "
            "another one at 0.547; take less, or a lattice");
  EXPECT_NE(message([&] { random_load(discs, box, {.packing_fraction = -0.1}); }).find("out of reach"),
            std::string::npos);
  EXPECT_NE(
      message([&] { random_load(discs, box, {.minimum_distance = 1, .packing_fraction = 0.1}); }).find("leave one out"),
      std::string::npos);
  EXPECT_NE(message([&] {
              random_load(discs, box, {.packing_fraction = 0.1, .where = [](double const*) { return true; }});
            }).find("leave an unknown part"),
            std::string::npos);
  EXPECT_EQ(count_for_packing(box, distance_for_packing(box, 77, 0.4), 0.4), 77);
}

// Where there is no more place, blocks that no particle covers don't go on for ever.
TEST(Packing, EndsWherePartsOfTheBoxAreForbidden) {
  Ensemble<Newton<2>> discs("discs", 100);
  Box const box = periodic<2>(10);
  auto const text = message([&] {
    random_load(discs, box, {.minimum_distance = 1, .where = [](double const* x) { return x[0] < 2 && x[1] < 2; }});
  });
  EXPECT_NE(text.find("the box is full with "), std::string::npos) << text;
}

}  // namespace
}  // namespace boltzmann::packing_test
