// The Riemann problem against published values, and against what defines its solution.
#include <boltzmann/core/error.hpp>
#include <boltzmann/exact/riemann.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>

namespace boltzmann::riemann_test {
namespace {

using exact::GasState, exact::Riemann;

// E. F. Toro, table 4.2 and 4.3: two shocks, two rarefactions and one of each on either side.
TEST(Riemann, HasTheStarValuesOfToro) {
  struct Case {
    GasState left, right;
    double pressure, velocity, left_density, right_density;
  };
  for (auto const& c :
       {Case{{1, 0, 1}, {0.125, 0, 0.1}, 0.30313, 0.92745, 0.42632, 0.26557},
        Case{{1, -2, 0.4}, {1, 2, 0.4}, 0.00189, 0, 0.02185, 0.02185},
        Case{{1, 0, 1000}, {1, 0, 0.01}, 460.894, 19.5975, 0.57506, 5.99924},
        Case{{1, 0, 0.01}, {1, 0, 100}, 46.0950, -6.19633, 5.99242, 0.57511},
        Case{{5.99924, 19.5975, 460.894}, {5.99242, -6.19633, 46.0950}, 1691.64, 8.68975, 14.2823, 31.0426}}) {
    Riemann const tube(c.left, c.right, 1.4);
    EXPECT_NEAR(tube.star_pressure(), c.pressure, 5e-6 + 1e-5 * c.pressure);
    EXPECT_NEAR(tube.star_velocity(), c.velocity, 1e-5 + 3e-6 * std::abs(c.velocity));
    EXPECT_NEAR(tube.left_density(), c.left_density, 6e-6 + 5e-6 * c.left_density);
    EXPECT_NEAR(tube.right_density(), c.right_density, 6e-6 + 5e-6 * c.right_density);
  }
}

TEST(Riemann, HasTheStarValuesOfSod) {
  Riemann const diatomic = exact::sod();
  EXPECT_NEAR(diatomic.star_pressure(), 0.303130, 1e-6);
  EXPECT_NEAR(diatomic.star_velocity(), 0.927453, 1e-6);
  EXPECT_NEAR(diatomic.left_density(), 0.426319, 1e-6);
  EXPECT_NEAR(diatomic.right_density(), 0.265574, 1e-6);
  EXPECT_NEAR(diatomic.shock_speed(), 1.752156, 1e-6);
  Riemann const monatomic = exact::sod(5.0 / 3);
  EXPECT_NEAR(monatomic.star_pressure(), 0.293945, 1e-6);
  EXPECT_NEAR(monatomic.star_velocity(), 0.841195, 1e-6);
}

// What defines the solution: mass, momentum and energy flow through the shock; along the fan entropy and u + 2c/(g - 1)
// stay; seen in a mirror, and from a moving frame, it is the same.
TEST(Riemann, KeepsWhatFlowsThroughItsWaves) {
  double const gamma = 1.4;
  GasState const right_state{0.125, 0, 0.1};
  Riemann const tube = exact::sod(gamma);
  GasState const behind = tube.at(1.5, 1);
  auto const flux = [&](GasState const& s) {
    double const u = s.velocity - tube.shock_speed(), e = s.pressure / ((gamma - 1) * s.density);
    return std::array{s.density * u, s.density * u * u + s.pressure, u * (s.density * (e + 0.5 * u * u) + s.pressure)};
  };
  for (std::size_t k = 0; k < 3; ++k) EXPECT_NEAR(flux(behind)[k], flux(right_state)[k], 1e-12);
  for (double const speed : {-1.1, -0.8, -0.4, -0.1}) {
    GasState const s = tube.at(2 * speed, 2);
    double const c = std::sqrt(gamma * s.pressure / s.density);
    EXPECT_NEAR(s.pressure / std::pow(s.density, gamma), 1, 1e-12);
    EXPECT_NEAR(s.velocity + 5 * c, 5 * std::sqrt(gamma), 1e-12);
    EXPECT_NEAR(s.velocity - c, speed, 1e-12);
  }
  Riemann const mirrored({0.125, 3, 0.1}, {1, 3, 1}, gamma);
  for (double const speed : {-1.3, -0.9, -0.2, 0.1, 0.5, 1.0, 1.6, 1.9}) {
    EXPECT_NEAR(mirrored.at(3 - speed, 1).density, tube.at(speed, 1).density, 1e-12);
    EXPECT_NEAR(mirrored.at(3 - speed, 1).velocity, 3 - tube.at(speed, 1).velocity, 1e-12);
    EXPECT_NEAR(mirrored.at(3 - speed, 1).pressure, tube.at(speed, 1).pressure, 1e-12);
  }
}

TEST(Riemann, IsTheStartAtTimeZero) {
  Riemann const tube({1, 2, 3}, {4, 5, 6}, 1.4);
  EXPECT_EQ(tube.at(-1e-9, 0).pressure, 3);
  EXPECT_EQ(tube.at(1e-9, 0).velocity, 5);
  EXPECT_EQ(tube.at(-100, 1).density, 1);
  EXPECT_EQ(tube.at(100, 1).density, 4);
}

// Two cold streams that meet: shocks run out at (gamma - 1)/2 of their speed, behind them the gas is (gamma + 1)/(gamma -
// 1) times as dense and at rest (strong shocks).
TEST(Riemann, StopsStreamsThatMeet) {
  double const gamma = 5.0 / 3;
  Riemann const wall({1, 1, 1e-12}, {1, -1, 1e-12}, gamma);
  EXPECT_NEAR(wall.star_pressure(), (gamma + 1) / 2, 1e-9);
  EXPECT_NEAR(wall.left_density(), 4, 1e-9);
  EXPECT_NEAR(wall.shock_speed(), (gamma - 1) / 2, 1e-9);
  EXPECT_EQ(wall.star_velocity(), 0);
  Riemann const uneven({1, 1e3, 1e-9}, {1e-6, -1e3, 1e5}, 1.1);  // pressures of all magnitudes
  auto const behind = uneven.at(uneven.shock_speed() - 1e-6, 1);
  double const u = behind.velocity - uneven.shock_speed(), before = -1e3 - uneven.shock_speed();
  EXPECT_NEAR(behind.density * u / (1e-6 * before), 1, 1e-11);
  EXPECT_NEAR((behind.density * u * u + behind.pressure) / (1e-6 * before * before + 1e5), 1, 1e-11);
}

TEST(Riemann, RefusesWhatItCannotSolve) {
  auto const said = [](GasState left, GasState right, double gamma) {
    return message([&] { Riemann(left, right, gamma); });
  };
  EXPECT_EQ(said({1, -6, 1}, {1, 6, 1}, 1.4),
            "Riemann problem: the gases part at a velocity of 12, and a vacuum opens between them; below 11.8322 "
            "(2 (c_left + c_right)/(gamma - 1)) there is none");
  EXPECT_EQ(said({1, -5.9, 1}, {1, 5.9, 1}, 1.4), "no error");
  EXPECT_EQ(said({0, 0, 1}, {1, 0, 1}, 1.4),
            "Riemann problem: the density on the left must be a positive number, it is 0");
  EXPECT_EQ(said({1, 0, 1}, {1, 0, -2}, 1.4),
            "Riemann problem: the pressure on the right must be a positive number, it is -2");
  EXPECT_EQ(said({1, NAN, 1}, {1, 0, 1}, 1.4),
            "Riemann problem: the velocity on the left must be a finite number, it is nan");
  EXPECT_EQ(said({1, 0, 1}, {1, 0, 1}, 1), "Riemann problem: gamma must be a number above 1, it is 1");
  EXPECT_EQ(message([] { exact::sod().at(0, -1); }),
            "Riemann problem: the time must be a number of zero or more, it is -1");
}

}  // namespace
}  // namespace boltzmann::riemann_test
