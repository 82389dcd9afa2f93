// Particles on a circle: where they stand, ripples, and what is refused.
#include <boltzmann/loaders/ring_load.hpp>
#include <boltzmann/particles/newton.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <string>

namespace boltzmann::ring_load_test {
namespace {

TEST(RingLoad, GoesAroundItsNormal) {
  Ensemble<Newton<2>> flat("flat", 4);
  ring_load(flat, {.radius = 2, .centre = {1, -1, 0}});
  double const places[4][2] = {{3, -1}, {1, 1}, {-1, -1}, {1, -3}};
  for (std::size_t k = 0; k < 4; ++k)
    for (int a = 0; a < 2; ++a) EXPECT_NEAR(flat[k].position[a], places[k][a], 1e-15) << k;

  for (auto const& normal : {Vector<3>{0, 0, 2}, Vector<3>{1, 0, 0}, Vector<3>{1, -2, 0.5}, Vector<3>{0, -1, 0}}) {
    Ensemble<Newton<3>> ring("ring", 7);
    ring_load(ring, {.radius = 0.5, .centre = {3, 1, 2}, .normal = {normal[0], normal[1], normal[2]}});
    Vector<3> const centre{3, 1, 2};
    for (std::size_t k = 0; k < 7; ++k) {
      Vector<3> const from = Vector<3>(ring[k].position) - centre,
                      next = Vector<3>(ring[(k + 1) % 7].position) - centre;
      EXPECT_NEAR(magnitude(from), 0.5, 1e-15);
      EXPECT_NEAR(dot(from, normal), 0, 1e-15);
      EXPECT_NEAR(dot(from, next), 0.25 * std::cos(2 * pi / 7), 1e-15);
      EXPECT_NEAR(dot(cross(from, next), normal), 0.25 * std::sin(2 * pi / 7) * magnitude(normal), 1e-15);
    }
  }
}

TEST(RingLoad, HasRipplesAndTakesFewAndNone) {
  Ensemble<Newton<2>> ring("ring", 8), one("one", 1), none("none", 0);
  ring_load(ring, {.radius = 2, .mode = 4, .ripple = 0.1});
  for (std::size_t k = 0; k < 8; ++k)
    EXPECT_NEAR(magnitude(Vector<2>(ring[k].position)), k % 2 == 0 ? 2.2 : 1.8, 1e-14);
  ring_load(one, {.radius = 1});
  EXPECT_EQ(one[0].position[0], 1);
  ring_load(none, {.radius = 1});
}

TEST(RingLoad, RefusesWhatIsNoCircle) {
  Ensemble<Newton<1>> line("line", 3);
  Ensemble<Newton<3>> ring("ring", 3);
  EXPECT_NE(message([&] { ring_load(line, {.radius = 1}); }).find("on a line there is no circle"), std::string::npos);
  EXPECT_NE(message([&] { ring_load(ring, {}); }).find("the radius must be positive"), std::string::npos);
  EXPECT_NE(message([&] {
              ring_load(ring, {.radius = 1, .normal = {0, 0, 0}});
            }).find("no direction"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::ring_load_test
