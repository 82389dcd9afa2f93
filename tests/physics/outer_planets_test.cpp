// The Sun and its giant planets: a bounded error of the energy, and the long waves of their orbits.
#include "shipped.hpp"

#include <boltzmann/exact/kepler.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdio>

namespace boltzmann::outer_planets_test {
namespace {

/// Of a planet about the Sun, from its row and that of the Sun; masses in those of the Sun, G = 1.
double eccentricity(double const* planet, double const* sun, double total_mass, int velocity) {
  exact::OrbitState state;
  for (std::size_t a = 0; a < 3; ++a) {
    state.position[a] = planet[a] - sun[a];
    state.velocity[a] = planet[static_cast<std::size_t>(velocity) + a] - sun[static_cast<std::size_t>(velocity) + a];
  }
  return exact::orbit_elements(state, total_mass).eccentricity;
}

// In 100,000 years the energy is as good at the end as at the beginning. Jupiter and Saturn
// exchange eccentricity in 54,000 years (Applegate et al. 1986): Jupiter's is between 0.025 and 0.062, Saturn's between
// 0.007 and 0.088.
TEST(OuterPlanets, EnergyIsBoundedAndOrbitsSwing) {
  double const years = 1e5;
  auto const run = shipped("outer-planets");
  auto& bodies = *run->ensembles.front();
  int const velocity = bodies.field("velocity").offset;
  double const start = total_energy(*run);
  double early = 0, late = 0, rms_early = 0, rms_late = 0;
  std::array<double, 2> jupiter{1, 0}, saturn{1, 0};
  int const looks = static_cast<int>(years / 50.5);  // not a multiple of any period
  for (int k = 0; k < looks; ++k) {
    run->simulation->run(101);
    double const error = total_energy(*run) / start - 1;
    bool const first = k < looks / 5;
    if (first || k >= looks - looks / 5) {
      (first ? early : late) = std::max(first ? early : late, std::abs(error));
      (first ? rms_early : rms_late) += error;
    }
    for (auto [range, planet] : {std::pair{&jupiter, 1}, {&saturn, 2}}) {
      double const e =
          eccentricity(bodies.row(planet), bodies.row(0), 1 + (planet == 1 ? 1 / 1047.3486 : 1 / 3497.898), velocity);
      *range = {std::min((*range)[0], e), std::max((*range)[1], e)};
    }
  }
  double const drift = (rms_late - rms_early) / (looks / 5);
  std::printf(
      "[ PLANETS  ] energy: %.3g in the first fifth, %.3g in the last, the mean changes by %.2g; eccentricity of "
      "Jupiter %.4f to %.4f, of Saturn %.4f to %.4f\n",
      early, late, drift, jupiter[0], jupiter[1], saturn[0], saturn[1]);
  EXPECT_LT(late, 1.2 * early);
  EXPECT_LT(early, 1e-7);
  EXPECT_LT(std::abs(drift), 0.05 * early);
  EXPECT_NEAR(jupiter[0], 0.026, 0.004);
  EXPECT_NEAR(jupiter[1], 0.061, 0.003);
  EXPECT_NEAR(saturn[0], 0.010, 0.006);
  EXPECT_NEAR(saturn[1], 0.086, 0.004);
}

}  // namespace
}  // namespace boltzmann::outer_planets_test
