// Cold beams (scenarios/cold-beams.toml): two equal beams through each other bunch as theory has it, if they are slow
// enough; otherwise they pass.
#include <tests/physics/mesh_factor.hpp>
#include <tests/physics/shipped.hpp>
#include <tests/physics/waves.hpp>

#include <boltzmann/exact/plasma.hpp>
#include <boltzmann/loaders/fields.hpp>
#include <boltzmann/loaders/sinusoidal_load.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

namespace boltzmann::cold_beams_test {
namespace {

constexpr double pi = std::numbers::pi;

/// Of wave number 1, where k v0 = a.
double growth(double plasma_frequency, double a) { return exact::two_stream_growth(plasma_frequency, a, 0, 1); }

struct Beams {
  std::vector<double> times, amplitudes;
  double first_energy = 0, last_energy = 0;
};

/// One wavelength of two quiet beams at k v0 = a wp, with a ripple of 1e-5 in the velocities of one.
Beams beams(double a, double until) {
  double const k = 1, step = 0.05;
  Box const box(Vector{0.0}, Vector{2 * pi / k}, Boundary::periodic);
  Ensemble<Coulomb<1>> right("right", 8192), left("left", 8192);
  MeshScheme mesh(box, {128}, reduced_law());
  mesh.background(true);
  for (auto* beam : {&right, &left}) {
    reduced_plasma(*beam, box, 0.5);
    quiet_load(*beam, box);
    for (auto& p : *beam) p.velocity[0] = (beam == &right ? a : -a) / k;
    mesh.add(*beam);
  }
  velocity_ripple(right, box, {.wave = wave_of_mode(box, 0, 1), .amplitude = 1e-5});
  Simulation simulation(mesh, step);
  simulation.integrate(right, Method::leap_frog);
  simulation.integrate(left, Method::leap_frog);
  Beams result;
  simulation.observe(2, [&](Simulation const& s) {
    result.times.push_back(s.time());
    result.amplitudes.push_back(std::abs(mode_of(mesh_field(mesh, "field"), 0, {1, 0, 0})));
  });
  simulation.run(static_cast<std::uint64_t>(until / step));
  return result;
}

// The other three roots of the wave (one shrinks, two swing) are 1e-2 of the growing one after five of its times; a
// field of 0.02 is still small to the 0.2 or so at which particles turn back.
void expect_growth(double a, double largest) {
  double const factor = mesh_factor(2, false, {pi / 128}, {1}), gamma = growth(std::sqrt(factor), a);
  EXPECT_NEAR(gamma / growth(1, a), 1, 0.003);
  auto const run = beams(a, 10 / gamma);
  double to = 0;
  for (std::size_t i = 0; i < run.times.size() && run.amplitudes[i] < 0.005; ++i) to = run.times[i];
  EXPECT_GT(to, 6.5 / gamma);
  EXPECT_NEAR(growth_rate(run.times, run.amplitudes, 5 / gamma, to) / gamma, 1, largest) << a;
}

TEST(ColdBeams, FastestGrowth) { expect_growth(std::sqrt(0.375), 0.01); }
TEST(ColdBeams, SlowerBeamsGrowSlower) {
  EXPECT_LT(growth(1, 0.3), 0.8 / std::sqrt(8));
  expect_growth(0.3, 0.01);
}

TEST(ColdBeams, FastBeamsAreStable) {
  auto const run = beams(1.1, 60);
  double first = 0, last = 0;
  for (std::size_t i = 0; i < run.times.size(); ++i)
    (run.times[i] < 20 ? first : last) = std::max(run.times[i] < 20 ? first : last, run.amplitudes[i]);
  EXPECT_GT(first, 1e-6);
  EXPECT_LT(last / first, 1.5);
}

// The shipped run grows at 1/sqrt(8) between 14/wp and 20/wp: before, its other roots are more than a percent; after,
// the field is no longer small. Then the beams curl up: particles of one go the other way.
TEST(ColdBeams, TheShippedRunGrowsAndTurns) {
  auto const run = shipped("cold-beams");
  std::vector<double> times, amplitudes;
  run->simulation->observe(4, [&](Simulation const& s) {
    times.push_back(s.time());
    amplitudes.push_back(std::abs(mode_of(mesh_field(*run->schemes.front(), "field"), 0, {1, 0, 0})));
  });
  double const start = total_energy(*run);
  run->simulation->run(static_cast<std::uint64_t>(run->steps));
  EXPECT_NEAR(growth_rate(times, amplitudes, 14, 20) * std::sqrt(8), 1, 0.02);
  EXPECT_NEAR(total_energy(*run) / start, 1, 0.005);
  auto& right = ensemble(*run, "right");
  Field const& velocity = *right.find_field("velocity");
  std::size_t turned = 0;
  for (std::size_t i = 0; i < right.size(); ++i) turned += right.row(i)[velocity.offset] < 0 ? 1 : 0;
  EXPECT_GT(turned, right.size() / 20);
}

}  // namespace
}  // namespace boltzmann::cold_beams_test
