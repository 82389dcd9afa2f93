// Vortex tubes: their circulation, impulse and width, whatever cells they are made of.
#include <boltzmann/diagnoses/vortex_measures.hpp>
#include <boltzmann/loaders/vortex_tube_load.hpp>
#include <boltzmann/particles/vortex.hpp>

#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann::vortex_tube_load_test {
namespace {

// Impulse of a ring of Gaussian section: Gamma pi (R^2 + a^2 / 2), for vorticity that goes as exp(-d^2 / a^2).
TEST(VortexTubeLoad, MakesRingsOfTheCirculationAndTheWidth) {
  double const a = 0.3, radius = 2, gamma = -1.5;
  for (std::size_t const layers : {0, 2, 5}) {
    Ensemble<Inviscid<3>> ring("ring");
    VortexRing const asked{.radius = radius,
                           .centre = {1, 2, 3},
                           .normal = {0, 2, 0},
                           .tube = {.circulation = gamma, .core_radius = a, .layers = layers}};
    vortex_ring_load(ring, asked);
    EXPECT_EQ(ring.size(), vortex_tube_count(2 * pi * radius, asked.tube));
    EXPECT_EQ(ring.size() % ((2 * layers + 1) * (2 * layers + 1)), 0U);
    auto const measured = vortex_measures(ring);
    for (double const sum : measured.circulation) EXPECT_NEAR(sum, 0, 1e-9);
    // The element's own core, core^2 each way, is no part of this sum: it is of the centres.
    double const spread = a * a / 2 - square(ring[0].core);
    EXPECT_NEAR(measured.impulse[1], gamma * pi * (radius * radius + spread), 1e-4);
    EXPECT_NEAR(measured.impulse[0], 0, 1e-9);
    // Through a section: the vorticity of an element over the length of line that it stands for.
    double through = 0, second = 0;
    for (auto const& p : ring) {
      Vector<3> const r = p.position - Vector<3>{1, 2, 3};
      double const from_axis = std::hypot(r[0], r[2]), along = magnitude(p.vorticity);
      double const part = along / (2 * pi * from_axis);
      through += part;
      second += part * (square(from_axis - radius) + square(r[1])) / 2;
      EXPECT_NEAR(dot(p.vorticity, Vector<3>{r[0], 0.0, r[2]}), 0, 1e-7 * along);
    }
    EXPECT_NEAR(through, std::abs(gamma), 1e-5);
    EXPECT_NEAR(second / through, spread, 1e-4 * a * a);
  }
}

// Once around a line whose tangent turns by itself: the elements fill the tube, and their lines close.
TEST(VortexTubeLoad, FollowsKnots) {
  auto const trefoil = [](double u) {
    double const t = 2 * pi * u;
    return Vector<3>{std::sin(t) + 2 * std::sin(2 * t), std::cos(t) - 2 * std::cos(2 * t), -std::sin(3 * t)};
  };
  Ensemble<Inviscid<3>> knot("knot");
  VortexTube const tube{.circulation = 2, .core_radius = 0.2, .layers = 3, .sections = 500};
  vortex_tube_load(knot, trefoil, tube);
  EXPECT_EQ(knot.size(), 500U * 49);
  auto const measured = vortex_measures(knot);
  for (double const sum : measured.circulation) EXPECT_NEAR(sum, 0, 1e-5);
  double furthest = 0;
  for (auto const& p : knot) {
    double nearest = 1e9;
    for (int k = 0; k < 1000; ++k) {
      double const d = norm2(p.position - trefoil(k / 1000.0));
      nearest = std::min(nearest, d);
    }
    furthest = std::max(furthest, std::sqrt(nearest));
    if (&p - &*knot.begin() > 2000) break;
  }
  EXPECT_GT(furthest, 0.2);
  EXPECT_LT(furthest, 0.6);
}

TEST(VortexTubeLoad, RefusesWhatMakesNoTube) {
  Ensemble<Inviscid<3>> ring("ring");
  EXPECT_NE(message([&] { vortex_ring_load(ring, {.radius = 1}); }).find("the core radius must be positive, not nan"),
            std::string::npos);
  EXPECT_NE(
      message([&] { vortex_ring_load(ring, {.radius = 1, .tube = {.core_radius = 1.5}}); }).find("wider than a ring"),
      std::string::npos);
  EXPECT_NE(message([&] { vortex_ring_load(ring, {.radius = -1, .tube = {.core_radius = 0.1}}); }).find("radius"),
            std::string::npos);
  Ensemble<Tracer<3>> dust("dust");
  EXPECT_NE(message([&] { vortex_ring_load(dust, {.radius = 1, .tube = {.core_radius = 0.1}}); }).find("vorticity"),
            std::string::npos);
  Ensemble<Vortex<2>> flat("flat");
  EXPECT_NE(
      message([&] { vortex_ring_load(flat, {.radius = 1, .tube = {.core_radius = 0.1}}); }).find("three dimensions"),
      std::string::npos);
}

}  // namespace
}  // namespace boltzmann::vortex_tube_load_test
