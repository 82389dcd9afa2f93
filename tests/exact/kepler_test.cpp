// Kepler's problem against its laws, closed forms and the planets.
#include <boltzmann/core/error.hpp>
#include <boltzmann/exact/kepler.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann::kepler_test {
namespace {

using exact::OrbitElements, exact::OrbitState;

double energy(OrbitState const& s, double mu) { return 0.5 * norm2(s.velocity) - mu / magnitude(s.position); }

double apart(OrbitState const& a, OrbitState const& b) {
  return magnitude(a.position - b.position) / magnitude(b.position) +
         magnitude(a.velocity - b.velocity) / magnitude(b.velocity);
}

constexpr double astronomical_unit = 1.495978707e11, sun = 1.32712440018e20, day = 86400;

// Mercury (a = 0.38710 AU, e = 0.20563) and Halley's comet: their years, their least and greatest distances and speeds.
TEST(Kepler, HasTheYearsOfPlanets) {
  EXPECT_NEAR(exact::orbit_period(0.387099 * astronomical_unit, sun) / day, 87.969, 1e-3);
  EXPECT_NEAR(exact::orbit_period(5.2044 * astronomical_unit, sun) / day, 4332.6, 5);
  EXPECT_NEAR(exact::orbit_period(8, 2) / exact::orbit_period(2, 2), 8, 1e-14);
  auto const mercury = exact::orbit_state({0.387099 * astronomical_unit, 0.20563, 0.1222, 0.8435, 0.5083, 0}, sun);
  EXPECT_NEAR(magnitude(mercury.position) / 4.6e10, 1, 1e-3);
  EXPECT_NEAR(magnitude(mercury.velocity) / 58980, 1, 1e-3);
  double const period = exact::orbit_period(0.387099 * astronomical_unit, sun);
  auto const far = exact::kepler(mercury, sun, period / 2);
  EXPECT_NEAR(magnitude(far.position) / 6.982e10, 1, 1e-3);
  EXPECT_NEAR(magnitude(far.velocity) / 38860, 1, 1e-3);
  EXPECT_LT(apart(exact::kepler(mercury, sun, period), mercury), 1e-13);
  EXPECT_LT(apart(exact::kepler(mercury, sun, -1000 * period), mercury), 1e-10);
}

TEST(Kepler, MovesOnACircleAsOneTurns) {
  OrbitState const start{{2, 0, 0}, {0, 3, 0}};  // mu = r v^2
  for (double const t : {0.1, 1.0, -2.0, 30.0}) {
    auto const now = exact::kepler(start, 18, t);
    EXPECT_NEAR(now.position[0], 2 * std::cos(1.5 * t), 1e-12);
    EXPECT_NEAR(now.position[1], 2 * std::sin(1.5 * t), 1e-12);
    EXPECT_NEAR(now.velocity[0], -3 * std::sin(1.5 * t), 1e-12);
  }
}

// Barker's equation of a parabola: t = sqrt(2 q^3/mu) (s + s^3/3), s = tan(anomaly / 2), r = q (1 + s^2).
TEST(Kepler, SolvesBarkersEquation) {
  double const q = 1.5, mu = 2;
  OrbitState const start{{q, 0, 0}, {0, std::sqrt(2 * mu / q), 0}};
  for (double const s : {0.01, 0.5, 3.0, 100.0}) {
    auto const now = exact::kepler(start, mu, std::sqrt(2 * q * q * q / mu) * (s + s * s * s / 3));
    EXPECT_NEAR(now.position[0] / q, 1 - s * s, 1e-11 * (1 + s * s)) << s;
    EXPECT_NEAR(now.position[1] / q, 2 * s, 1e-11 * (1 + s * s)) << s;
  }
}

// A body at rest falls into the centre within pi sqrt(r^3 / (8 mu)), and has half of its way behind it after 0.8183 of
// that (cos^2 = 1/2: (pi/4 + 1/2) / (pi/2)).
TEST(Kepler, FallsStraightDown) {
  OrbitState const start{{0, 0, 3}, {0, 0, 0}};
  double const mu = 0.7, fall = pi * std::sqrt(27 / (8 * mu));
  auto const half = exact::kepler(start, mu, (pi / 4 + 0.5) / (pi / 2) * fall);
  EXPECT_NEAR(half.position[2], 1.5, 1e-12);
  EXPECT_NEAR(half.velocity[2], -std::sqrt(2 * mu / 3), 1e-12);
  EXPECT_LT(magnitude(exact::kepler(start, mu, 0.99999 * fall).position), 0.01);
}

// Newton's equation by differences, the constants of motion, and there and back, on orbits of all kinds.
TEST(Kepler, SolvesNewtonsEquation) {
  double const mu = 1.3, h = 1e-3;
  for (double const speed : {0.3, 0.9, 1.2, std::sqrt(2 * 1.3), 1.7, 4.0})
    for (double const t : {0.05, 0.7, 5.0}) {
      OrbitState const start{{0.6, 0.48, 0.64}, speed * Vector{-0.8, 0.36, 0.48}};
      OrbitState const now = exact::kepler(start, mu, t);
      auto const before = exact::kepler(start, mu, t - h), after = exact::kepler(start, mu, t + h);
      double const r = magnitude(now.position);
      auto const force = now.position * (-mu / (r * r * r));
      auto const found = (after.position - now.position * 2 + before.position) / (h * h);
      if (r > 0.2) {  // where h is short
        EXPECT_LT(magnitude(found - force) / magnitude(force), 1e-4) << speed << ", " << t;
        EXPECT_LT(magnitude((after.position - before.position) / (2 * h) - now.velocity), 1e-4) << speed << ", " << t;
      }
      EXPECT_NEAR(energy(now, mu), energy(start, mu), 1e-12 * (1 + norm2(now.velocity)));
      auto const spin = cross(start.position, start.velocity);
      EXPECT_LT(magnitude(cross(now.position, now.velocity) - spin), 1e-12 * magnitude(spin) + 1e-13);
      EXPECT_LT(apart(exact::kepler(now, mu, -t), start), 1e-10) << speed << ", " << t;
    }
}

TEST(Kepler, ElementsGiveTheirStateAndBack) {
  double const mu = 2.5;
  for (auto const& e : {OrbitElements{1.2, 0.3, 0.4, 1, 2, 0.5}, OrbitElements{7, 0.97, 2.9, -3, -0.1, -3},
                        OrbitElements{-2, 1.8, 1.5, 0.2, 3, 4}, OrbitElements{-1, 5, 0.1, -2, 1, -30},
                        OrbitElements{1, 0.5, 0, 0, 1.5, 2}}) {
    auto const state = exact::orbit_state(e, mu);
    auto const found = exact::orbit_elements(state, mu);
    EXPECT_NEAR(found.semi_major_axis / e.semi_major_axis, 1, 1e-12);
    EXPECT_NEAR(found.eccentricity, e.eccentricity, 1e-12);
    EXPECT_NEAR(found.inclination, e.inclination, 1e-12);
    EXPECT_NEAR(found.node, e.node, 1e-12);
    EXPECT_NEAR(found.pericentre, e.pericentre, 1e-12);
    EXPECT_NEAR(found.mean_anomaly, e.mean_anomaly, 1e-11);
    // The anomaly grows in time as it should.
    double const time = 0.37, axis = std::abs(e.semi_major_axis);
    auto later = e;
    later.mean_anomaly += time * std::sqrt(mu / (axis * axis * axis));
    EXPECT_LT(apart(exact::kepler(state, mu, time), exact::orbit_state(later, mu)), 1e-12);
  }
  // A circle in the plane has neither node nor pericentre, but a place on it.
  auto const circle = exact::orbit_elements({{0, 2, 0}, {-1, 0, 0}}, 2);
  EXPECT_EQ(circle.node, 0);
  EXPECT_EQ(circle.pericentre, 0);
  EXPECT_NEAR(circle.mean_anomaly, pi / 2, 1e-15);
  EXPECT_NEAR(circle.semi_major_axis, 2, 1e-15);
}

// What the elements mean: the pericentre is a (1 - e) away; up through the plane at the node; i is the orbit's tilt.
TEST(Kepler, ElementsMeanWhatTheySay) {
  auto const start = exact::orbit_state({2, 0.25, pi / 2, 0, pi / 2, 0}, 1);  // over the pole
  EXPECT_NEAR(start.position[2], 1.5, 1e-14);
  EXPECT_NEAR(start.velocity[0], -std::sqrt(1.25 / 1.5), 1e-14);
  auto const rising = exact::orbit_state({2, 0, 0.3, pi / 2, 0, 0}, 1);
  EXPECT_NEAR(rising.position[1], 2, 1e-14);
  EXPECT_NEAR(rising.velocity[2] / magnitude(rising.velocity), std::sin(0.3), 1e-14);
}

TEST(Kepler, SolvesKeplersEquation) {
  // 1.498701133517848 solves M = 1 for e = 0.5.
  EXPECT_NEAR(exact::eccentric_anomaly(1, 0.5), 1.498701133517848, 1e-15);
  for (double const e : {0.0, 0.1, 0.9, 0.9999, 1.0001, 3.0})
    for (double const M : {-3.0, -1e-6, 0.0, 0.2, pi, 40.0}) {
      double const E = exact::eccentric_anomaly(M, e);
      EXPECT_NEAR(e < 1 ? E - e * std::sin(E) : e * std::sinh(E) - E, M, 2e-14 * (1 + std::abs(M))) << e << ", " << M;
    }
}

TEST(Kepler, RefusesWhatIsNoOrbit) {
  OrbitState const fine{{1, 0, 0}, {0, 1, 0}};
  EXPECT_EQ(message([&] { exact::kepler(fine, 0, 1); }),
            "Kepler's problem: the constant mu = G (M + m) must be a positive number, it is 0");
  EXPECT_EQ(message([&] {
              exact::kepler({{0, 0, 0}, {0, 1, 0}}, 1, 1);
            }),
            "Kepler's problem: the body is in the centre");
  EXPECT_EQ(message([&] { exact::kepler(fine, 1, INFINITY); }),
            "Kepler's problem: the time must be a finite number, it is inf");
  EXPECT_EQ(message([&] {
              exact::orbit_elements({{1, 2, 3}, {2, 4, 6}}, 1);
            }),
            "Kepler's problem: a body that moves straight to the centre or from it has no elements");
  EXPECT_EQ(message([&] {
              exact::orbit_state({1, 1.5, 0, 0, 0, 0}, 1);
            }),
            "Kepler's problem: the semi-major axis is positive for eccentricities below 1 and negative above, not 1 "
            "with the eccentricity 1.5");
  EXPECT_EQ(message([&] { exact::orbit_period(-1, 1); }),
            "Kepler's problem: the semi-major axis must be a positive number, it is -1");
  EXPECT_EQ(message([&] { exact::eccentric_anomaly(1, 1); }),
            "Kepler's problem: a parabola (eccentricity 1) has no eccentric anomaly");
}

}  // namespace
}  // namespace boltzmann::kepler_test
