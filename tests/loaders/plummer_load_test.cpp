// Plummer's sphere against its closed forms.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/plummer_load.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/tracer.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>

namespace boltzmann::plummer_load_test {
namespace {

// M(r) = M r^3 / (r^2 + a^2)^(3/2), and everywhere a mean square of velocities of G M / (2 sqrt(r^2 + a^2)).
TEST(PlummerLoad, HasItsMassAndItsVelocities) {
  double const mass = 5, radius = 2, G = 3;
  Ensemble<Kepler<3>> stars("stars", 40000);
  plummer_load(stars, {.mass = mass, .radius = radius, .G = G, .seed = test_seed(3)});
  for (double const r : {0.5, 1.0, 2.0, 4.0, 10.0}) {
    double inside = 0, squares = 0, expected = 0, count = 0;
    for (auto const& p : stars) {
      double const here = magnitude(p.position);
      if (here < r) inside += p.mass;
      if (std::abs(here - r) > 0.2 * r) continue;
      squares += norm2(p.velocity);
      expected += G * mass / (2 * std::hypot(here, radius));
      ++count;
    }
    double const exact = mass * std::pow(r, 3) / std::pow(r * r + radius * radius, 1.5);
    EXPECT_NEAR(inside / exact, 1, 5 * std::sqrt((mass / exact - 1) / 40000) + 1e-3) << r;
    EXPECT_NEAR(squares / expected, 1, 5 * 0.8 / std::sqrt(count)) << r;
  }
}

// No direction is better than another, and the cluster is where it is wanted.
TEST(PlummerLoad, IsRoundAndStandsStill) {
  Ensemble<Kepler<3>> stars("stars", 20000);
  plummer_load(stars, {.mass = 1, .radius = 1, .centre = {3, -1, 2}, .drift = {0.5, 0, -4}, .seed = test_seed(4)});
  Vector<3> place{}, motion{}, squares{};
  for (auto const& p : stars) {
    place += p.position * p.mass, motion += p.velocity * p.mass;
    auto const v = p.velocity - Vector{0.5, 0.0, -4.0};
    for (int a = 0; a < 3; ++a) squares[a] += v[a] * v[a] * p.mass;
  }
  EXPECT_LT(magnitude(place - Vector{3.0, -1.0, 2.0}), 1e-11);
  EXPECT_LT(magnitude(motion - Vector{0.5, 0.0, -4.0}), 1e-12);
  for (int a = 0; a < 3; ++a) EXPECT_NEAR(squares[a] / (pi / 32), 1, 0.06);  // <v^2> = 3 pi / 32
}

TEST(PlummerLoad, DoesNotDependOnHowManyThereAre) {
  Ensemble<Kepler<3>> few("stars", 10), many("stars", 300), nobody("nobody");
  plummer_load(few, {.mass = 1, .radius = 1});
  plummer_load(many, {.mass = 1, .radius = 1});
  plummer_load(nobody, {.mass = 1, .radius = 1});
  auto const apart = few[7].position - few[2].position;
  EXPECT_LT(magnitude(many[7].position - many[2].position - apart), 1e-13);
}

TEST(PlummerLoad, RefusesWhatItCantDo) {
  Ensemble<Kepler<2>> flat("flat", 3);
  Ensemble<Tracer<3>> light("light", 3);
  Ensemble<Kepler<3>> stars("stars", 3);
  EXPECT_NE(message([&] { plummer_load(flat, {.mass = 1, .radius = 1}); }).find("a cluster of stars needs three"),
            std::string::npos);
  EXPECT_NE(message([&] { plummer_load(light, {.mass = 1, .radius = 1}); }).find("mass"), std::string::npos);
  EXPECT_NE(message([&] { plummer_load(stars, {.mass = 1}); }).find("the radius must be positive, it is nan"),
            std::string::npos);
  EXPECT_NE(message([&] { plummer_load(stars, {.mass = -1, .radius = 1}); }).find("the mass must be positive"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::plummer_load_test
