// Sedov's blast against its closed form, published values, and what is conserved in it.
#include <boltzmann/core/error.hpp>
#include <boltzmann/core/number.hpp>
#include <boltzmann/exact/sedov.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann::sedov_solution_test {
namespace {

using exact::SedovBlast;

// J. R. Kamm, F. X. Timmes, LA-UR-07-2849: the energies with which the shock of air is at 0.75 (2D) and 1 (3D) at t = 1.
TEST(SedovBlast, HasPublishedEnergies) {
  EXPECT_NEAR(SedovBlast(2, 1.4).radius(0.311357, 1, 1), 0.75, 1e-5);
  EXPECT_NEAR(SedovBlast(3, 1.4).radius(0.851072, 1, 1), 1, 1e-6);
  EXPECT_NEAR(SedovBlast(2, 1.4).xi(), 1.004022, 1e-6);
  EXPECT_NEAR(SedovBlast(3, 1.4).xi(), 1.032777, 1e-6);
  // G. I. Taylor 1950 has K = 0.856, of E = K density R^5 / t^2.
  EXPECT_NEAR(SedovBlast(3, 1.4).alpha(), 0.856, 0.006);
}

// Sedov's closed form, its energy integrated in 90 digits.
TEST(SedovBlast, HasTheEnergyOfTheClosedForm) {
  struct Case {
    int dimension;
    double gamma, alpha, kinetic_share;
  };
  for (auto const& c :
       {Case{1, 1.4, 1.077485584735, 0.1836941714058}, Case{2, 1.4, 0.98407401688, 0.2088022276389},
        Case{3, 1.4, 0.8510718547582, 0.2187256693379}, Case{1, 5.0 / 3, 0.6029352379199, 0.2271637481333},
        Case{2, 5.0 / 3, 0.564283436899, 0.2665454906811}, Case{3, 5.0 / 3, 0.4935901495826, 0.2827554937816},
        Case{1, 1.2, 2.239147800095, 0.1251005267879}, Case{3, 1.2, 1.71980348995, 0.1407024730423},
        Case{1, 3, 0.1419234360411, 0.3012111724918}, Case{3, 3, 0.1325240836444, 0.4095887784503}}) {
    SedovBlast const blast(c.dimension, c.gamma);
    EXPECT_NEAR(blast.alpha() / c.alpha, 1, 1e-9) << c.dimension << "D, " << c.gamma;
    EXPECT_NEAR(blast.kinetic_share() / c.kinetic_share, 1, 3e-9) << c.dimension << "D, " << c.gamma;
    EXPECT_NEAR(blast.alpha() * std::pow(blast.xi(), c.dimension + 2), 1, 1e-14);
  }
}

// Mass, and the energy through a sphere that grows with the flow: u (rho u^2/2 + gamma p/(gamma - 1)) is what a
// self-similar blast loses by its growth, x (rho u^2/2 + p/(gamma - 1)), at every part of the radius.
TEST(SedovBlast, KeepsMassAndEnergyInside) {
  for (double const gamma : {1.1, 1.4, 5.0 / 3, 3.0})
    for (int const dimension : {1, 2, 3}) {
      SedovBlast const blast(dimension, gamma);
      double mass = 0;
      constexpr int steps = 20000;
      for (int k = 0; k < steps; ++k) {
        double const x = (k + 0.5) / steps;
        mass += blast.at(x).density * dimension * std::pow(x, dimension - 1) / steps;
      }
      EXPECT_NEAR(mass, 1, 1e-5);
      for (double const x : {0.5, 0.7, 0.9, 0.99}) {
        auto const p = blast.at(x);
        double const kinetic = 0.5 * p.density * p.velocity * p.velocity, heat = p.pressure / (gamma - 1);
        EXPECT_NEAR(p.velocity * (kinetic + heat + p.pressure) / (p.part * (kinetic + heat)), 1, 1e-7);
      }
    }
}

// The equations of the gas themselves, by differences in space and time.
TEST(SedovBlast, SolvesEulersEquations) {
  for (int const dimension : {1, 2, 3}) {
    double const gamma = 1.4, energy = 3, density = 0.5, time = 0.7, h = 1e-5;
    SedovBlast const blast(dimension, gamma);
    auto const at = [&](double r, double t) { return blast.state(r, t, energy, density); };
    for (double const part : {0.4, 0.8, 0.95}) {
      double const r = part * blast.radius(energy, density, time);
      auto const here = at(r, time), in = at(r - h, time), out = at(r + h, time), before = at(r, time - h),
                 after = at(r, time + h);
      auto const by_r = [&](auto member) { return (out.*member - in.*member) / (2 * h); };
      auto const along = [&](auto member) {
        return (after.*member - before.*member) / (2 * h) + here.velocity * by_r(member);
      };
      using exact::GasState;
      double const spread = by_r(&GasState::velocity) + (dimension - 1) * here.velocity / r;
      EXPECT_NEAR(along(&GasState::density) / (here.density * spread), -1, 1e-5);
      EXPECT_NEAR(along(&GasState::velocity) * here.density / by_r(&GasState::pressure), -1, 1e-3);
      EXPECT_NEAR(along(&GasState::pressure) / (gamma * here.pressure * spread), -1, 1e-5);
    }
  }
}

TEST(SedovBlast, HasAStrongShockAndGasAtRestBefore) {
  SedovBlast const blast(2, 1.4);
  double const time = 0.3, radius = blast.radius(2, 5, time), speed = blast.shock_speed(2, 5, time);
  EXPECT_NEAR((blast.radius(2, 5, time + 1e-6) - radius) / 1e-6 / speed, 1, 1e-5);
  auto const behind = blast.state((1 - 1e-12) * radius, time, 2, 5), before = blast.state(1.001 * radius, time, 2, 5);
  EXPECT_NEAR(behind.density / 5, 6, 1e-9);
  EXPECT_NEAR(behind.velocity / speed, 2 / 2.4, 1e-9);
  EXPECT_NEAR(behind.pressure / (5 * speed * speed), 2 / 2.4, 1e-9);
  EXPECT_EQ(before.density, 5);
  EXPECT_EQ(before.velocity, 0);
  EXPECT_EQ(before.pressure, 0);
  auto const middle = blast.at(0);
  EXPECT_EQ(middle.density, 0);
  EXPECT_EQ(middle.velocity, 0);
  EXPECT_NEAR(middle.pressure, blast.at(0.01).pressure, 1e-9);
  EXPECT_EQ(blast.radius(2, 5, 0), 0);
}

TEST(SedovBlast, RefusesWhatItCannotSolve) {
  EXPECT_EQ(message([] { SedovBlast(4, 1.4); }), "Sedov's blast: the dimension must be 1, 2 or 3, it is 4");
  EXPECT_EQ(message([] { SedovBlast(2, 1); }), "Sedov's blast: gamma must be a number above 1, it is 1");
  EXPECT_EQ(message([] { SedovBlast(3, 7); }),
            "Sedov's blast: in 3D gamma must be below 7, beyond which the middle is empty; it is 7");
  SedovBlast const blast(3, 1.4);
  EXPECT_EQ(message([&] { blast.radius(-1, 1, 1); }), "Sedov's blast: the energy must be a positive number, it is -1");
  EXPECT_EQ(message([&] { blast.state(0.1, 0, 1, 1); }), "Sedov's blast: the time must be a positive number, it is 0");
  EXPECT_EQ(message([&] { blast.state(-0.1, 1, 1, 1); }),
            "Sedov's blast: the distance must be a number of zero or more, it is -0.1");
}

}  // namespace
}  // namespace boltzmann::sedov_solution_test
