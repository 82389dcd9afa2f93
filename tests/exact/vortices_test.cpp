// The vortices of Lamb and Oseen and of Taylor and Green against the equations that they solve.
#include <boltzmann/core/error.hpp>
#include <boltzmann/exact/lamb_oseen.hpp>
#include <boltzmann/exact/taylor_green.hpp>
#include <tests/message.hpp>

#include <gtest/gtest.h>

#include <cmath>

namespace boltzmann::exact_vortices_test {
namespace {

using exact::lamb_oseen, exact::taylor_green;

// r v 2 pi is the circulation within r: all of it far out, and at every r the integral of the vorticity.
TEST(LambOseen, HasItsCirculation) {
  double const time = 3, circulation = 5, viscosity = 0.01;
  EXPECT_NEAR(2 * pi * 9 * lamb_oseen(9, time, circulation, viscosity).velocity, circulation, 1e-14);
  double within = 0;
  int const steps = 10000;
  for (int k = 0; k < steps; ++k) {
    double const r = (k + 0.5) / steps;
    within += 2 * pi * r * lamb_oseen(r, time, circulation, viscosity).vorticity / steps;
    if (k % 2500 == 0) {
      double const end = (k + 1.0) / steps;
      EXPECT_NEAR(within, 2 * pi * end * lamb_oseen(end, time, circulation, viscosity).velocity, 1e-7);
    }
  }
  EXPECT_NEAR(within, circulation, 2e-3);
  EXPECT_EQ(lamb_oseen(0, time, circulation, viscosity).velocity, 0);
  EXPECT_NEAR(lamb_oseen(0, time, circulation, viscosity).vorticity, circulation / (4 * pi * viscosity * time), 1e-12);
}

TEST(LambOseen, IsFastestAtTheEdgeOfItsCore) {
  double const time = 0.4, viscosity = 0.3, width = std::sqrt(4 * viscosity * time);
  double best = 0, place = 0;
  for (double r = 0.5 * width; r < 2 * width; r += 1e-5 * width) {
    double const v = lamb_oseen(r, time, 1, viscosity).velocity;
    if (v > best) best = v, place = r;
  }
  EXPECT_NEAR(place / width, 1.1209, 1e-4);
  EXPECT_NEAR(best, 0.6382 / (2 * pi * width), 1e-4 * best);
}

// Vorticity diffuses: d omega/dt = nu (omega'' + omega'/r).
TEST(LambOseen, SolvesTheEquationOfHeat) {
  double const h = 1e-4, time = 2, viscosity = 0.05;
  auto const omega = [&](double r, double t) { return lamb_oseen(r, t, 3, viscosity).vorticity; };
  for (double const r : {0.1, 0.5, 1.0}) {
    double const rate = (omega(r, time + h) - omega(r, time - h)) / (2 * h);
    double const bend = (omega(r + h, time) - 2 * omega(r, time) + omega(r - h, time)) / (h * h);
    EXPECT_NEAR(rate, viscosity * (bend + (omega(r + h, time) - omega(r - h, time)) / (2 * h) / r), 1e-6);
  }
}

// The equation of Navier and Stokes, du/dt + u . grad u = -grad p / density + nu laplace u, by differences.
TEST(TaylorGreen, SolvesTheEquationOfNavierAndStokes) {
  double const h = 1e-3, time = 0.4, speed = 1.7, edge = 3, viscosity = 0.06, density = 1.4;
  auto const at = [&](double x, double y, double t) {
    return taylor_green({x, y}, t, speed, edge, viscosity, density);
  };
  for (double const x : {0.2, 1.1, 2.5})
    for (double const y : {0.4, 1.9}) {
      auto const here = at(x, y, time), east = at(x + h, y, time), west = at(x - h, y, time),
                 north = at(x, y + h, time), south = at(x, y - h, time);
      auto const by_x = (east.velocity - west.velocity) / (2 * h), by_y = (north.velocity - south.velocity) / (2 * h);
      auto const rate = (at(x, y, time + h).velocity - at(x, y, time - h).velocity) / (2 * h);
      auto const laplace =
          (east.velocity + west.velocity + north.velocity + south.velocity - here.velocity * 4) / (h * h);
      Vector<2> const push{(east.pressure - west.pressure) / (2 * h), (north.pressure - south.pressure) / (2 * h)};
      auto const left = rate + by_x * here.velocity[0] + by_y * here.velocity[1] + push / density - laplace * viscosity;
      EXPECT_LT(magnitude(left), 1e-4) << x << ", " << y;
      EXPECT_NEAR(by_x[0] + by_y[1], 0, 1e-5);
      EXPECT_NEAR(by_x[1] - by_y[0], here.vorticity, 1e-4);
    }
}

TEST(TaylorGreen, DecaysByItsRate) {
  auto const start = taylor_green({0.1, 0.3}, 0, 2, 1, 0.02), later = taylor_green({0.1, 0.3}, 0.2, 2, 1, 0.02);
  EXPECT_NEAR(later.velocity[0] / start.velocity[0], std::exp(-8 * pi * pi * 0.02 * 0.2), 1e-14);
  EXPECT_NEAR(later.pressure / start.pressure, std::exp(-16 * pi * pi * 0.02 * 0.2), 1e-14);
  EXPECT_NEAR(magnitude(taylor_green({0, 0.25}, 0, 2, 1, 0).velocity), 2, 1e-14);  // the largest speed
}

TEST(ExactVortices, RefuseWhatHasNoMeaning) {
  EXPECT_EQ(message([] { lamb_oseen(1, 0, 1, 1); }),
            "Lamb and Oseen's vortex: the time must be a positive number, it is 0");
  EXPECT_EQ(message([] { lamb_oseen(-1, 1, 1, 1); }),
            "Lamb and Oseen's vortex: the distance must be a number of zero or more, it is -1");
  EXPECT_EQ(message([] {
              taylor_green({0, 0}, 1, 1, 0, 1);
            }),
            "Taylor and Green's vortices: the edge must be a positive number, it is 0");
}

}  // namespace
}  // namespace boltzmann::exact_vortices_test
