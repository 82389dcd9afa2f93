// Discs against the rotation curves that are known, and against the gravity of their own particles.
#include <boltzmann/core/error.hpp>
#include <boltzmann/loaders/disc_load.hpp>
#include <boltzmann/particles/laplace.hpp>
#include <boltzmann/particles/tracer.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <cmath>

namespace boltzmann::disc_load_test {
namespace {

// K. C. Freeman (1970): v^2 = 4 pi G S0 h y^2 (I0 K0 - I1 K1), y = R / 2 h.
TEST(DiscLoad, ExponentialDiscsHaveFreemansRotationCurve) {
  double const mass = 3, h = 2, G = 0.7;
  DiscGravity const disc({.mass = mass, .radius = h, .edge = 40, .G = G}, 3);
  for (double const R : {0.05, 0.3, 1., 2., 4., 4.4, 7., 12., 20.}) {
    double const y = R / (2 * h), s0 = mass / (2 * pi * h * h);
    double const bessel =
        std::cyl_bessel_i(0, y) * std::cyl_bessel_k(0, y) - std::cyl_bessel_i(1, y) * std::cyl_bessel_k(1, y);
    EXPECT_NEAR(disc.circular_velocity(R) / std::sqrt(4 * pi * G * s0 * h * y * y * bessel), 1, 2e-3) << R;
  }
}

// v^2 = G M R^2 / (R^2 + a^2)^(3/2) of a disc without end.
TEST(DiscLoad, KuzminDiscsHaveTheirRotationCurve) {
  DiscGravity const disc({.profile = DiscProfile::kuzmin, .mass = 1 - 1 / std::hypot(1, 400), .radius = 1, .edge = 400},
                         3);
  for (double const R : {2., 5., 20., 60.})
    EXPECT_NEAR(disc.circular_velocity(R) / std::sqrt(R * R * std::pow(R * R + 1, -1.5)), 1, 5e-3) << R;
  EXPECT_NEAR(disc.mass_within(1), (1 - std::sqrt(0.5)) / (1 - 1 / std::hypot(1, 400)), 1e-12);
}

TEST(DiscLoad, InAPlaneTheMassInsideActs) {
  for (auto const profile : {DiscProfile::exponential, DiscProfile::kuzmin, DiscProfile::uniform}) {
    DiscGravity const disc({.profile = profile, .mass = 4, .radius = 1.5, .central_mass = 1}, 2);
    for (double const part : {0.1, 0.5, 0.9}) {
      double const R = disc.radius_of(part);
      EXPECT_NEAR(disc.mass_within(R), part, 1e-12);
      EXPECT_NEAR(disc.circular_velocity(R), std::sqrt(2 * (4 * part + 1)), 1e-12);
    }
  }
}

// What the particles do at some distances, averaged over circles, keeps those there on them. On one circle alone the ring of
// particles that happens to lie inside or outside of it counts too much.
template <int D>
void expect_balance(DiscProfile profile) {
  Ensemble<Kepler<D>> stars("stars", 20'000);
  disc_load(stars, {.profile = profile, .mass = 2, .radius = 1, .seed = test_seed(4)});
  constexpr int places = 16, circles = 24;
  bool const ends = profile == DiscProfile::uniform;  // at 1; further out there is more mass inside, and less noise
  double const nearest = ends ? 0.5 : 1.5, furthest = ends ? 0.9 : 3;
  double field = 0, needed = 0, count = 0, turning = 0;
  for (int c = 0; c < circles; ++c) {
    double const R = nearest + (furthest - nearest) * (c + 0.5) / circles;
    for (int k = 0; k < places; ++k) {
      Vector<D> at{};
      at[0] = R * std::cos(2 * pi * k / places), at[1] = R * std::sin(2 * pi * k / places);
      for (auto const& q : stars) {
        auto const r = q.position - at;
        double const square = dot(r, r) + 9e-4;
        field -= dot(r, at) / (R * places * circles) *
                 (D == 2 ? 2 * q.mass / square : q.mass / (square * std::sqrt(square)));
      }
    }
  }
  for (auto const& p : stars) {
    double const r = magnitude(p.position);
    turning += p.position[0] * p.velocity[1] - p.position[1] * p.velocity[0];
    if (r < nearest || r > furthest) continue;
    double const density = profile == DiscProfile::uniform  ? 1
                           : profile == DiscProfile::kuzmin ? std::pow(1 + r * r, -1.5)
                                                            : std::exp(-r);
    double const weight = 1 / (r * density);  // circles are spread evenly over distances
    needed += weight * norm2(p.velocity) / r;
    count += weight;
  }
  EXPECT_GT(turning, 0) << "counterclockwise";
  EXPECT_NEAR(field / (needed / count), 1, 0.05);
}

TEST(DiscLoad, ParticlesAreHeldByTheirOwnGravity) {
  expect_balance<3>(DiscProfile::exponential);
  expect_balance<3>(DiscProfile::kuzmin);
  expect_balance<2>(DiscProfile::exponential);
  expect_balance<2>(DiscProfile::uniform);
}

TEST(DiscLoad, LiesAcrossItsNormalAroundItsCentre) {
  Ensemble<Kepler<3>> ring("ring", 5000);
  disc_load(ring, {.profile = DiscProfile::uniform,
                   .mass = 0,
                   .radius = 2,
                   .central_mass = 9,
                   .centre = {3, -1, 2},
                   .drift = {0.5, 0, -4},
                   .normal = {0, 3, 4},
                   .seed = test_seed(5)});
  Vector<3> place{}, motion{}, spin{};
  std::size_t within = 0;
  for (auto const& p : ring) {
    place += p.position * (1. / 5000), motion += p.velocity * (1. / 5000);
    auto const r = p.position - Vector{3., -1., 2.}, v = p.velocity - Vector{0.5, 0., -4.};
    EXPECT_LT(std::abs(dot(r, Vector{0., 0.6, 0.8})), 1e-10);
    spin += cross(r, v);
    within += magnitude(r) < 1;
    if (magnitude(r) > 1) {
      EXPECT_NEAR(norm2(v) * magnitude(r), 9, 2);  // the mean was taken off
    }
    EXPECT_EQ(p.mass, 1) << "theirs, where the disc has none";
  }
  EXPECT_LT(magnitude(place - Vector{3., -1., 2.}), 1e-11);
  EXPECT_LT(magnitude(motion - Vector{0.5, 0., -4.}), 1e-11);
  EXPECT_NEAR(dot(spin, Vector{0., 0.6, 0.8}) / magnitude(spin), 1, 1e-10);
  EXPECT_NEAR(static_cast<double>(within), 1250, 5 * std::sqrt(5000 * 0.25 * 0.75) + 30);
}

TEST(DiscLoad, RefusesWhatItCantDo) {
  Ensemble<Kepler<1>> line("line", 3);
  Ensemble<Tracer<2>> light("light", 3);
  Ensemble<Kepler<2>> stars("stars", 3);
  EXPECT_NE(message([&] { disc_load(line, {.mass = 1, .radius = 1}); }).find("there is no disc"), std::string::npos);
  EXPECT_NE(message([&] { disc_load(light, {.mass = 1, .radius = 1}); }).find("mass"), std::string::npos);
  EXPECT_NE(message([&] { disc_load(stars, {.mass = 1}); }).find("the radius must be positive"), std::string::npos);
  EXPECT_NE(message([&] { disc_load(stars, {.radius = 1}); }).find("the mass must not be negative"), std::string::npos);
  EXPECT_NE(message([&] {
              disc_load(stars, {.profile = DiscProfile::uniform, .mass = 1, .radius = 1, .edge = 2});
            }).find("ends at its radius"),
            std::string::npos);
}

}  // namespace
}  // namespace boltzmann::disc_load_test
