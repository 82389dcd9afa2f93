// What SmoothScheme says to those who misuse it from C++, and to the physics that does not fit any more.
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/laws/materials/isentropic_gas.hpp>
#include <boltzmann/laws/materials/newtonian.hpp>
#include <boltzmann/schemes/smooth/smooth_scheme.hpp>
#include <boltzmann/simulation/simulation.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <string>

#include "../message.hpp"

namespace boltzmann::smooth_misuse_test {
namespace {

/// Fills the unit square with a square lattice of density 1.
void fill(Ensemble<Smooth<2>>& gas, std::size_t side, double range) {
  auto const n = static_cast<double>(side);
  gas.resize(side * side);
  for (std::size_t i = 0; i < gas.size(); ++i) {
    gas[i].position = {(static_cast<double>(i % side) + 0.5) / n, (static_cast<double>(i / side) + 0.5) / n};
    gas[i].mass = 1 / (n * n);
    gas[i].range = range;
    gas[i].specific_energy = 1;
  }
}
Box square_box(Boundary boundary = Boundary::periodic) { return {Vector{0., 0.}, Vector{1., 1.}, boundary}; }

/// The line of a physics failure, or "none".
std::string failure(auto const& call) {
  try {
    call();
  } catch (PhysicsFailure const& failed) {
    return failed.what();
  }
  return "none";
}
bool contains(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }
bool advises(SmoothScheme& scheme, std::string const& part) {
  for (auto const& line : scheme.warnings(0.001))
    if (contains(line, part)) return true;
  return false;
}

TEST(SmoothMisuse, MassesArePositive) {
  for (double const mass : {0.0, -1.0}) {
    Ensemble<Smooth<2>> gas("gas", 0);
    fill(gas, 4, 0.7);
    gas[3].mass = mass;
    SmoothScheme scheme(square_box());
    scheme.material(gas, IdealGas{1.4});
    auto const line = failure([&] { scheme.courant_step(); });
    EXPECT_TRUE(contains(line, "particle 3 of 'gas' has the mass") && contains(line, "must be positive")) << line;
  }
}

TEST(SmoothMisuse, DensitiesThatAreNotSummedAreGiven) {
  for (double const density : {0.0, -1.0}) {
    Ensemble<Smooth<2>> gas("gas", 0);
    fill(gas, 4, 0.7);
    for (auto& p : gas) p.density = density;
    SmoothScheme scheme(square_box());
    scheme.material(gas, IdealGas{1.4});
    EXPECT_EQ(failure([&] { scheme.calculate(); }), "none");  // summed
    for (auto& p : gas) p.density = density;
    scheme.density_from(DensityFrom::continuity);
    auto const line = failure([&] { scheme.calculate(); });
    EXPECT_TRUE(contains(line, "particle 0 of 'gas' has the density") && contains(line, "be given")) << line;
  }
}

TEST(SmoothMisuse, VariableRangesWantEnsemblesAndSums) {
  Ensemble<Smooth<2>> gas("gas", 0), late("late", 0);
  fill(gas, 8, 0.3);
  fill(late, 4, 0.3);
  SmoothScheme scheme(square_box());
  EXPECT_TRUE(contains(message([&] { scheme.variable_range({}); }), "set their materials before it"));
  scheme.material(gas, IdealGas{1.4});
  scheme.variable_range({});
  EXPECT_TRUE(contains(message([&] { scheme.material(late, IdealGas{1.4}); }), "after variable_range()"));
  scheme.density_from(DensityFrom::continuity);
  EXPECT_TRUE(contains(message([&] { scheme.calculate(); }), "densities that are summed"));
}

// The self-density of Lucy's weight in 2D is (5/pi) mass / range^2: no range is less than sqrt(5/pi) spacings.
TEST(SmoothMisuse, TooFewSpacingsAreRefused) {
  Ensemble<Smooth<2>> gas("gas", 0);
  fill(gas, 8, 0.3);
  SmoothScheme scheme(square_box());
  scheme.material(gas, IdealGas{1.4});
  auto const line = message([&] { scheme.variable_range({.spacings = 1.2}); });
  EXPECT_TRUE(contains(line, "no ranges of 1.2 spacings") && contains(line, "more than 1.26")) << line;
}

TEST(SmoothMisuse, WallsAreFurtherApartThanRangesReach) {
  Ensemble<Smooth<2>> gas("gas", 0);
  fill(gas, 8, 0.95);
  SmoothScheme scheme(square_box(Boundary::mirror));
  scheme.material(gas, IdealGas{1.4});
  auto const line = message([&] { scheme.calculate(); });
  EXPECT_TRUE(contains(line, "the walls of axis x are 1 apart") && contains(line, "range 0.95")) << line;
}

// A wall that is taken away, or comes back, between two calculations.
TEST(SmoothMisuse, WallsMayComeAndGo) {
  auto const influences = [](std::vector<bool> const& open) {
    Ensemble<Smooth<2>> gas("gas", 0);
    fill(gas, 8, 0.3);
    SmoothScheme scheme(square_box(Boundary::mirror));
    scheme.material(gas, IdealGas{1.4});
    for (bool const opened : open) {
      if (opened)
        scheme.box().open_end(0, Box::End::high);
      else
        scheme.box().wall(0, Box::End::high, {});
      scheme.calculate();
    }
    auto const found = gas.influences();
    return std::vector<double>(found.begin(), found.end());
  };
  EXPECT_NE(influences({true}), influences({false}));
  EXPECT_EQ(influences({false, true}), influences({true}));
  EXPECT_EQ(influences({true, false}), influences({false}));
}

// A piston that comes too near is no mistake of the input: the failure names the step.
TEST(SmoothMisuse, APistonThatComesTooNearFails) {
  Ensemble<Smooth<2>> gas("gas", 0);
  fill(gas, 8, 0.3);
  Box box = square_box(Boundary::mirror);
  box.wall(0, Box::End::low, {.velocity = {0.5, 0}});
  SmoothScheme scheme(box);
  scheme.material(gas, IdealGas{1.4});
  scheme.artificial_viscosity({});
  Simulation simulation(scheme, 0.005);
  simulation.integrate(gas, Method::leap_frog);
  auto const line = failure([&] { simulation.run(1000); });
  EXPECT_TRUE(contains(line, "step ") && contains(line, "the walls of axis x are 0.32")) << line;
  EXPECT_NEAR(simulation.time(), (1 - 0.3 * 1.08) / 0.5, 0.01);
}

// A gas between two walls becomes thin: its ranges would grow beyond what lists between the walls allow.
TEST(SmoothMisuse, RangesGrowAsFarAsWallsAllow) {
  Ensemble<Smooth<2>> gas("gas", 0);
  fill(gas, 8, 3.0 / 8);
  SmoothScheme scheme({Vector{0., 0.}, Vector{1., 1.}, {Boundary::open, Boundary::mirror}});
  scheme.material(gas, IdealGas{1.4});
  scheme.artificial_viscosity({});
  scheme.variable_range({});
  Simulation simulation(scheme, 0.02);
  simulation.integrate(gas, Method::leap_frog);
  EXPECT_NO_THROW(simulation.run(500));
  double longest = 0;
  for (auto const& p : gas) longest = std::max(longest, p.range);
  EXPECT_GT(longest, 0.8);
  EXPECT_LT(longest, 0.9);
}

TEST(SmoothMisuse, AdviceForParticlesThatAreAlone) {
  Ensemble<Smooth<2>> gas("gas", 0);
  fill(gas, 8, 0.1);  // spacing 0.125
  SmoothScheme scheme(square_box());
  scheme.material(gas, IdealGas{1.4});
  EXPECT_TRUE(advises(scheme, "100 % of their density is their own"));
  for (auto& p : gas) p.range = 3 * 0.125;
  EXPECT_FALSE(advises(scheme, "neighbours"));
}

// P = (gamma - 1) rho e = 0.4 for all, so that the volume times it is the virial, and viscosity at rest adds nothing.
TEST(SmoothMisuse, TheVirialIsThePressure) {
  for (bool const viscous : {false, true}) {
    Ensemble<Smooth<2>> gas("gas", 0);
    fill(gas, 16, 3.0 / 16);
    SmoothScheme scheme(square_box());
    if (viscous)
      scheme.material(gas, Newtonian<IdealGas>{.material = {1.4}, .shear_viscosity = 0.1});
    else
      scheme.material(gas, IdealGas{1.4});
    auto const virial = scheme.measure().virial;
    for (int a = 0; a < 2; ++a)
      for (int b = 0; b < 2; ++b) EXPECT_NEAR(virial[a][b], a == b ? 0.4 : 0.0, 1e-12);
  }
}

// Between plates that slide along each other v_x = shear rate * y: the stress is - eta times the shear rate.
TEST(SmoothMisuse, TheVirialHasTheViscousStress) {
  for (bool const variable : {false, true}) {
    Ensemble<Smooth<2>> gas("gas", 0), other("other", 0);
    fill(gas, 32, 3.0 / 32);
    double const low = square_box().low(1), high = square_box().high(1), rate = 3;
    for (auto& p : gas) p.velocity = {rate * (p.position[1] - 0.5 * (low + high)), 0};
    // Half of the particles are another ensemble, with another material.
    for (auto const& p : gas)
      if (p.position[0] > square_box().low(0) + 0.5 * square_box().length(0)) other.add(p);
    std::vector<Smooth<2>> left;
    for (auto const& p : gas)
      if (!(p.position[0] > square_box().low(0) + 0.5 * square_box().length(0))) left.push_back(p);
    gas.resize(0);
    for (auto const& p : left) gas.add(p);
    ASSERT_EQ(gas.size() + other.size(), 1024U);
    Box box(Vector{square_box().low(0), low}, Vector{square_box().high(0), high},
            std::array{Boundary::periodic, Boundary::mirror});
    box.wall(1, Box::End::low, {.slips = false, .velocity = {-rate * 0.5 * (high - low), 0, 0}});
    box.wall(1, Box::End::high, {.slips = false, .velocity = {rate * 0.5 * (high - low), 0, 0}});
    SmoothScheme scheme(box);
    scheme.material(gas, Newtonian<IdealGas>{.material = {1.4}, .shear_viscosity = 0.1});
    scheme.material(other, Newtonian<IdealGas>{.material = {1.4}, .shear_viscosity = 0.3});
    if (variable) scheme.variable_range({.spacings = 3});
    scheme.calculate();
    std::vector<double> before(gas.influence(0), gas.influence(0) + gas.size() * gas.influence_size());
    auto const virial = scheme.measure().virial;
    EXPECT_NEAR(virial[0][1], -0.2 * rate, 0.02 * 0.2 * rate);
    EXPECT_EQ(virial[1][0], virial[0][1]);
    EXPECT_NEAR(virial[0][0], 0.4, 0.02);
    EXPECT_NEAR(virial[1][1], 0.4, 0.02);
    EXPECT_TRUE(std::equal(before.begin(), before.end(), gas.influence(0))) << "measuring changes no rates";
  }
}

TEST(SmoothMisuse, AdviceForWallsThatHeatNothing) {
  Ensemble<Smooth<2>> gas("gas", 0);
  fill(gas, 8, 0.3);
  Box box = square_box(Boundary::mirror);
  box.wall(1, Box::End::low, {.temperature = 2});
  SmoothScheme insulated(box), conducting(box);
  insulated.material(gas, IdealGas{1.4});
  conducting.material(gas, Newtonian<IdealGas>{.material = {1.4}, .conductivity = 0.1});
  EXPECT_TRUE(advises(insulated, "no material conducts heat"));
  EXPECT_FALSE(advises(conducting, "conducts"));
}

TEST(SmoothMisuse, HeatIsNotSharedWithAMaterialThatKeepsNone) {
  Ensemble<Smooth<1>> gas("gas", 5), water("water", 5);
  for (std::size_t i = 0; i < 5; ++i) {
    gas[i].position = {0.1 * static_cast<double>(i)};
    water[i].position = {0.5 + 0.1 * static_cast<double>(i)};
    gas[i].range = water[i].range = 0.3;
    gas[i].specific_energy = 1;
  }
  SmoothScheme scheme(Box(Vector{0.0}, Vector{1.0}, Boundary::periodic));
  scheme.material(gas, IdealGas{1.4});
  scheme.material(water, QuadraticGas{});
  try {
    scheme.calculate();
    FAIL() << "not refused";
  } catch (Error const& error) {
    EXPECT_STREQ(
        error.what(),
        "heating: the energy of 'water' follows from its density, that of 'gas' does not, so that energy would "
        "be lost where they share the heat of a pair; heating = \"own\" (Heating::own) shares none");
  }
  scheme.heating(Heating::own);
  EXPECT_NO_THROW(scheme.calculate());
}

}  // namespace
}  // namespace boltzmann::smooth_misuse_test
