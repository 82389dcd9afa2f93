// Ranges that follow densities, where this is hard: at jumps, with few neighbours, and at the limits they are given.
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/isentropic_gas.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>

namespace boltzmann::variable_range_test {
namespace {

/// 40 particles at distance 1, 10 lighter (or the others closer) on the right.
void jump(Ensemble<Smooth<1>>& gas, double ratio, bool equal_masses) {
  gas.resize(50);
  double x = 0;
  for (std::size_t i = 0; i < gas.size(); ++i) {
    double const spacing = i < 40 || !equal_masses ? 1 : ratio;
    gas[i].position[0] = x + spacing / 2;
    gas[i].mass = i < 40 || equal_masses ? 1 : 1 / ratio;
    gas[i].range = 4;
    gas[i].specific_energy = 1;
    x += spacing;
  }
}

// Repeated substitution of range = spacings m / rho never settles here.
TEST(VariableRange, SettlesAtJumps) {
  for (bool const equal_masses : {true, false})
    for (double const spacings : {2.0, 3.0, 4.0, 6.0})
      for (double const ratio : {2.0, 8.0, 100.0}) {
        Ensemble<Smooth<1>> gas("gas");
        jump(gas, ratio, equal_masses);
        SmoothScheme scheme(Box(Vector{-2000.0}, Vector{3000.0}));
        scheme.material(gas, IdealGas{1.4});
        scheme.variable_range({.spacings = spacings, .longest = 5000});
        scheme.complete(0);
        for (auto const& p : gas)
          EXPECT_NEAR(p.range * p.density / (spacings * p.mass), 1, 1e-10) << ratio << " " << spacings;
      }
}

TEST(VariableRange, StaysBetweenItsLimits) {
  Ensemble<Smooth<1>> gas("gas");
  jump(gas, 8, true);
  SmoothScheme scheme(Box(Vector{-2000.0}, Vector{3000.0}));
  scheme.material(gas, IdealGas{1.4});
  scheme.variable_range({.spacings = 3, .shortest = 3.5, .longest = 12});
  EXPECT_EQ(gas[20].range, 3.5);
  EXPECT_EQ(gas[45].range, 12);
  EXPECT_GT(gas[40].range, 3.5);
  EXPECT_LT(gas[40].range, 12);
}

// A gas flies apart; one particle after the other comes to the longest range, and stays there.
TEST(VariableRange, EnergyIsConservedAtTheLimit) {
  double drift[2];
  for (int const halving : {0, 1}) {
    Ensemble<Smooth<2>> gas("gas", 400);
    for (std::size_t i = 0; i < gas.size(); ++i) {
      gas[i].position = {static_cast<double>(i % 20), static_cast<double>(i / 20)};
      gas[i].mass = 1;
      gas[i].range = 3;
      gas[i].specific_energy = 1;
    }
    SmoothScheme scheme(Box(Vector{-100.0, -100.0}, Vector{120.0, 120.0}));
    scheme.material(gas, IdealGas{2});
    scheme.heating(Heating::own);
    scheme.variable_range({.spacings = 3, .longest = 4});
    double const step = halving ? 0.01 : 0.02;
    Simulation simulation(scheme, step);
    simulation.integrate(gas, Method::rk4);
    auto const energy = [&] {
      double kinetic = 0;
      for (auto const& p : gas) kinetic += 0.5 * p.mass * norm2(p.velocity);
      return kinetic + scheme.measure().internal;
    };
    double const start = energy();
    simulation.run(halving ? 1000 : 500);
    drift[halving] = std::abs(energy() / start - 1);
    auto const held = std::count_if(gas.begin(), gas.end(), [](auto const& p) { return p.range >= 4; });
    EXPECT_GT(held, 350);
    EXPECT_LT(
        std::max_element(gas.begin(), gas.end(), [](auto const& p, auto const& q) { return p.range < q.range; })->range,
        4.1);
  }
  EXPECT_LT(drift[0], 1e-6);
  EXPECT_LT(drift[1], drift[0]);
}

}  // namespace
}  // namespace boltzmann::variable_range_test
