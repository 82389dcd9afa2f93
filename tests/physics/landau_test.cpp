// Landau damping (scenarios/landau.toml): a wave in a warm plasma gives its energy to electrons that ride on it.
#include <tests/physics/shipped.hpp>
#include <tests/physics/waves.hpp>

#include <boltzmann/exact/plasma.hpp>
#include <boltzmann/loaders/random_load.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

namespace boltzmann::landau_test {
namespace {

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
  auto const wave = exact::langmuir(1, 1, 0.5);
  EXPECT_GE(swing.peaks, 6u);
  EXPECT_NEAR(swing.frequency / wave.frequency, 1, 0.01);
  EXPECT_NEAR(swing.growth / wave.growth, 1, 0.01);
}

TEST(Landau, DampsAtALongerWave) {
  auto const swing = damped_wave(0.4, 0.01, 2, 30);
  auto const wave = exact::langmuir(1, 1, 0.4);
  EXPECT_GE(swing.peaks, 8u);
  EXPECT_NEAR(swing.frequency / wave.frequency, 1, 0.01);
  EXPECT_NEAR(swing.growth / wave.growth, 1, 0.01);
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
  auto const wave = exact::langmuir(1, 1, 0.5);
  EXPECT_NEAR(swing.frequency / wave.frequency, 1, 0.02);
  EXPECT_NEAR(swing.growth / wave.growth, 1, 0.03);
}

}  // namespace
}  // namespace boltzmann::landau_test
