// Taylor and Green's vortices (scenarios/taylor-green.toml) in a viscous fluid: speeds decay as exp(-8 pi^2 nu t /
// L^2).
#include <tests/physics/shipped.hpp>
#include <tests/physics/smooth_gas.hpp>

#include <boltzmann/exact/taylor_green.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/laws/materials/tait.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <numbers>

namespace boltzmann::taylor_green_test {
namespace {

constexpr double pi = std::numbers::pi;

Vector<2> vortices(Vector<2> const& place, double viscosity = 0, double time = 0) {
  return exact::taylor_green(place, time, 1, 1, viscosity).velocity;
}

struct Decay {
  double rate;       ///< of the vortices' amplitude, by exact
  double amplitude;  ///< at the end, by exact
  double speed;      ///< root of the mean square, by exact
  double error;      ///< mean |v - exact|, by the exact mean speed at the end
  double momentum;
};

/// n x n particles in the unit box; the greatest speed is 1, the speed of sound 10.
Decay decay(std::size_t n, double viscosity, double end_time) {
  double const spacing = 1 / static_cast<double>(n);
  Ensemble<Smooth<2>> fluid("fluid");
  fill<2>(fluid, Vector{0.0, 0.0}, spacing, {n, n});
  nudge(fluid);
  for (auto& p : fluid) {
    p.mass = spacing * spacing;
    p.range = 5 * spacing;
    p.velocity = vortices(p.position);
  }
  SmoothScheme scheme(Box(Vector{0.0, 0.0}, Vector{1.0, 1.0}, Boundary::periodic), WeightShape::wendland);
  scheme.material(fluid, Newtonian<Tait>{{.reference_density = 1, .sound_speed = 10}, viscosity, 0, 0});
  Simulation simulation(scheme, 1e-6);
  simulation.integrate(fluid, Method::leap_frog);
  run_by_courant(simulation, scheme, end_time, 0.8, 1);
  double const expected = std::exp(-8 * pi * pi * viscosity * end_time);
  double along = 0, of_wave = 0, square_of_speed = 0, apart = 0, size = 0;
  for (auto const& p : fluid) {
    Vector<2> const wave = vortices(p.position), exact = vortices(p.position, viscosity, end_time);
    along += dot(p.velocity, wave);
    of_wave += dot(wave, wave);
    square_of_speed += norm2(p.velocity);
    apart += magnitude(p.velocity - exact);
    size += magnitude(exact);
  }
  Decay result{};
  result.amplitude = along / of_wave / expected;
  result.rate = -std::log(along / of_wave) / (8 * pi * pi * viscosity * end_time);
  result.speed = std::sqrt(2 * square_of_speed / static_cast<double>(fluid.size())) / expected;
  result.error = apart / size;
  result.momentum = momentum_share(fluid);
  return result;
}

// At a Reynolds number of 50. Too much viscosity of disordered particles and too little of smoothed gradients nearly
// cancel with many particles, so no order is asked for.
TEST(TaylorGreen, SpeedsDecayAsTheyShould) {
  double const viscosity = 0.02, end_time = 0.2;
  Decay const coarse = decay(32, viscosity, end_time), fine = decay(128, viscosity, end_time);
  EXPECT_NEAR(coarse.rate, 1, 0.05);
  EXPECT_NEAR(fine.rate, 1, 0.005);
  EXPECT_NEAR(fine.amplitude, 1, 0.01);
  EXPECT_NEAR(fine.speed, 1, 0.01);
  EXPECT_LT(fine.error, 0.03);
  EXPECT_LT(fine.momentum, 1e-13);
  EXPECT_LT(std::abs(fine.rate - 1), 0.3 * std::abs(coarse.rate - 1));
}

TEST(TaylorGreen, DecayIsProportionalToTheViscosity) {
  EXPECT_NEAR(decay(80, 0.04, 0.1).rate, 1, 0.03);
  EXPECT_NEAR(decay(80, 0.1, 0.04).rate, 1, 0.03);
}

TEST(TaylorGreen, AsItIsShipped) {
  auto const run = shipped("taylor-green");
  auto& fluid = dynamic_cast<Ensemble<Smooth<2>>&>(ensemble(*run, "fluid"));
  for (auto const& p : fluid) EXPECT_NEAR(magnitude(p.velocity - vortices(p.position)), 0, 1e-12);
  run->simulation->run(static_cast<std::uint64_t>(run->steps));
  double along = 0, of_wave = 0;
  for (auto const& p : fluid) {
    along += dot(p.velocity, vortices(p.position));
    of_wave += norm2(vortices(p.position));
  }
  EXPECT_NEAR(along / of_wave, std::exp(-8 * pi * pi * 0.02 * run->simulation->time()), 0.01);
}

}  // namespace
}  // namespace boltzmann::taylor_green_test
