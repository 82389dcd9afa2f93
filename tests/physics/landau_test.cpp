// Landau damping (scenarios/landau.toml): a wave in a warm plasma gives its energy to electrons that ride on it.
#include <tests/physics/dispersion.hpp>
#include <tests/physics/shipped.hpp>
#include <tests/physics/waves.hpp>

#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

namespace boltzmann::landau_test {
namespace {

// Z by 30-digit arithmetic (erfc), above, on and below the real axis.
TEST(Dispersion, OfTheFunctionZ) {
  std::pair<Complex, Complex> const values[] = {
      {{0, 0}, {0, 1.7724538509055159}},
      {{1, 0}, {-1.0761590138255368, 0.6520493321732922}},
      {{0, 1}, {0, 0.757872156141312}},
      {{1, -1}, {-3.592433910440379, -2.0153471661090174}},
      {{2.5, -0.7}, {-0.3852164545251291, -0.143549995172859}},
      {{0.3, -2}, {-164.9218202560933, 63.65035504476006}},
      {{6, 0.01}, {-0.1690848717672699, 0.00029024445624663156}},
      {{-3.2, 0.4}, {0.3236955895148753, 0.0458392929360981}},
  };
  for (auto const& [z, exact] : values) EXPECT_LT(std::abs(plasma_dispersion(z) - exact), 1e-11 * std::abs(exact)) << z;
}

// The published root at k lambda_D = 0.5, and one of 30-digit arithmetic at 0.4.
TEST(Dispersion, OfLandausRoots) {
  Complex const half = plasma_root({{1, 1, 0}}, 0.5, {1.3, -0.1});
  EXPECT_NEAR(half.real(), 1.415662, 1e-6);
  EXPECT_NEAR(half.imag(), -0.153359, 1e-6);
  Complex const lower = plasma_root({{1, 1, 0}}, 0.4, {1.3, -0.1});
  EXPECT_NEAR(lower.real(), 1.28505697, 1e-8);
  EXPECT_NEAR(lower.imag(), -0.06612796, 1e-8);
}

/// A quiet Maxwellian with a ripple of one wavelength in the box; the wave's field over time.
Swing damped_wave(double k, double amplitude, double from, double to) {
  Box const box(Vector{0.0}, Vector{2 * std::numbers::pi / k}, Boundary::periodic);
  Ensemble<Coulomb<1>> electrons("electrons", 400000);
  reduced_plasma(electrons, box);
  quiet_load(electrons, box, {.wave = wave_of_mode(box, 0, 1), .amplitude = amplitude});
  maxwellian_load(electrons, {.temperature = electrons[0].mass, .quiet = true});  // thermal velocity 1
  MeshScheme mesh(box, {64}, reduced_law());
  mesh.background(true);
  mesh.add(electrons);
  Simulation simulation(mesh, 0.05);
  simulation.integrate(electrons, Method::leap_frog);
  std::vector<double> times, field;
  simulation.observe(2, [&](Simulation const& s) {
    times.push_back(s.time());
    field.push_back(mode_of(mesh_field(mesh, "field"), 0, {1, 0, 0}).real());  // the density is a sine: E is a cosine
  });
  simulation.run(static_cast<std::uint64_t>(to / 0.05));
  return swing_of(times, field, from, to);
}

TEST(Landau, DampsAtHalfADebyeLength) {
  auto const swing = damped_wave(0.5, 0.01, 2, 18);
  EXPECT_GE(swing.peaks, 6u);
  EXPECT_NEAR(swing.frequency / 1.415662, 1, 0.01);
  EXPECT_NEAR(swing.growth / -0.153359, 1, 0.01);
}

TEST(Landau, DampsAtALongerWave) {
  auto const swing = damped_wave(0.4, 0.01, 2, 30);
  EXPECT_GE(swing.peaks, 8u);
  EXPECT_NEAR(swing.frequency / 1.285057, 1, 0.01);
  EXPECT_NEAR(swing.growth / -0.066128, 1, 0.01);
}

// The shipped run, with a quarter of the electrons.
TEST(Landau, TheShippedRunDampsToo) {
  auto const run = shipped("landau");
  std::vector<double> times, field;
  run->simulation->observe(2, [&](Simulation const& s) {
    times.push_back(s.time());
    field.push_back(mode_of(mesh_field(*run->schemes.front(), "field"), 0, {1, 0, 0}).real());
  });
  run->simulation->run(350);
  auto const swing = swing_of(times, field, 2, 13);
  EXPECT_NEAR(swing.frequency / 1.415662, 1, 0.02);
  EXPECT_NEAR(swing.growth / -0.153359, 1, 0.03);
}

}  // namespace
}  // namespace boltzmann::landau_test
