// Walls of reflecting axes in scenarios: pistons, open ends, and what is refused.
#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include "mistakes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::walls_scenario_test {
namespace {

using test::Mistake;
using test::mistake_name;

// A piston that drives particles to a free surface; the numbers on the right are those of the lines.
std::string const good =
    "[units]\n"                                                                                                // 1
    "base = \"reduced\"\n"                                                                                     // 2
    "[box]\n"                                                                                                  // 3
    "low = [0, 0]\n"                                                                                           // 4
    "high = [10, 8]\n"                                                                                         // 5
    "boundary = [\"reflecting\", \"periodic\"]\n"                                                              // 6
    "[[box.walls]]\n"                                                                                          // 7
    "axis = \"x\"\n"                                                                                           // 8
    "end = \"low\"\n"                                                                                          // 9
    "velocity = [2, 0]\n"                                                                                      // 10
    "[[box.walls]]\n"                                                                                          // 11
    "axis = \"x\"\n"                                                                                           // 12
    "end = \"high\"\n"                                                                                         // 13
    "open = true\n"                                                                                            // 14
    "[run]\n"                                                                                                  // 15
    "step = 0.001\n"                                                                                           // 16
    "steps = 2000\n"                                                                                           // 17
    "cutoff = 2.5\n"                                                                                           // 18
    "[[ensembles]]\n"                                                                                          // 19
    "name = \"atoms\"\n"                                                                                       // 20
    "class = \"Newton\"\n"                                                                                     // 21
    "integrator = \"leap-frog\"\n"                                                                             // 22
    "mass = 1\n"                                                                                               // 23
    "load = { kind = \"block\", lattice = \"square\", counts = [6, 8], origin = [0.5, 0.5] , spacing = 1 }\n"  // 24
    "[[influences]]\n"                                                                                         // 25
    "law = \"lennard-jones\"\n"                                                                                // 26
    "on = \"atoms\"\n"                                                                                         // 27
    "r0 = 1\n"                                                                                                 // 28
    "depth = 1\n";                                                                                             // 29

std::string with(std::string const& old, std::string const& now, std::string text = good) {
  return test::replaced(std::move(text), old, now);
}

TEST(WallsScenario, APistonDrivesParticlesToAFreeSurface) {
  auto const scenario = parse_scenario(good, "test.toml");
  Box const& box = scenario->box();
  EXPECT_EQ(box.wall(0, Box::End::low).velocity, (std::array<double, 3>{2, 0, 0}));
  EXPECT_FALSE(box.walled(0, Box::End::high));
  Simulation& simulation = *scenario->simulation;
  AnyEnsemble const& atoms = *scenario->ensembles[0];
  auto const energy = [&] { return kinetic_energy(simulation.ensembles()) + simulation.measure().potential; };
  simulation.check();
  double const before = energy();
  simulation.run(2000);
  EXPECT_NEAR(box.low(0), 4, 1e-12);
  double const work = simulation.measure().work;
  // All have been hit: they move with the piston's speed and more, so that the work is m u^2 each at least.
  EXPECT_GT(work, 48 * 4);
  EXPECT_NEAR(energy() - before, work, 0.01 * work);
  double furthest = 0;
  for (std::size_t i = 0; i < atoms.size(); ++i) {
    EXPECT_GE(atoms.row(i)[0], box.low(0));
    furthest = std::max(furthest, atoms.row(i)[0]);
  }
  EXPECT_GT(furthest, box.high(0));
}

TEST(WallsScenario, VelocitiesHaveUnits) {
  auto text =
      with("base = \"reduced\"\n", "base = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n");
  text = with("velocity = [2, 0]", "velocity = [\"3000 m/s\", 0]", text);
  EXPECT_NEAR(parse_scenario(text, "test.toml")->box().wall(0, Box::End::low).velocity[0], 30, 1e-12);
}

TEST(WallsScenario, AMomentumMirrorIsTheWallAtRest) {
  auto const scenario = parse_scenario(with("velocity = [2, 0]\n", "slips = true\n"), "test.toml");
  EXPECT_FALSE(scenario->box().walls_move());
  scenario->simulation->run(100);
  EXPECT_EQ(scenario->simulation->measure().work, 0);
}

class WallsMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(WallsMistakes, AreOneLine) { test::expect_one_line(GetParam()); }

std::vector<Mistake> const rows{
    {"periodic axis", with("axis = \"x\"", "axis = \"y\""), "8:8", {"y is periodic", "\"mirror\" or \"reflecting\""}},
    {"open axis",
     with("\"reflecting\"", "\"open\"", with("[[box.walls]]\naxis = \"x\"\nend = \"high\"\nopen = true\n", "")),
     "8:8",
     {"x is open", "\"mirror\" or \"reflecting\""}},
    {"rough wall",
     with("velocity = [2, 0]", "slips = false"),
     "10:9",
     {"slips: x is reflecting", "always slip", "mirror"}},
    {"warm wall", with("velocity = [2, 0]", "temperature = 1"), "10:15", {"temperature: x is reflecting", "insulated"}},
    {"wall along itself", with("[2, 0]", "[2, 1]"), "10:12", {"velocity: x is reflecting", "along it only"}},
    {"wall of another dimension", with("[2, 0]", "[2, 0, 0]"), "10:12", {"velocity", "2"}},
    {"no wall left", with("velocity = [2, 0]", "open = true"), "11:1", {"no wall would be left on axis x"}},
    {"velocity of an open end", with("open = true", "open = true\nvelocity = [1, 0]"), "15:12", {"open = true"}},
    {"particles behind the wall", with("origin = [0.5", "origin = [-0.5"), "24:8", {"outside the box", "x = -0.5"}},
    {"a grid under a piston",
     with("\"leap-frog\"", "\"reversible-leap-frog\""),
     "15:1",
     {"walls that move", "reversible leap-frog"}},
};
INSTANTIATE_TEST_SUITE_P(All, WallsMistakes, testing::ValuesIn(rows), mistake_name);

TEST(WallsScenario, MistakesOfOneWallAreToldTogether) {
  auto const lines = test::mistakes_of(with("velocity = [2, 0]", "slips = false\ntemperature = 1\nvelocity = [0, 3]"));
  ASSERT_EQ(lines.size(), 3U) << testing::PrintToString(lines);
  EXPECT_NE(lines[0].find("slips"), std::string::npos);
  EXPECT_NE(lines[1].find("temperature"), std::string::npos);
  EXPECT_NE(lines[2].find("velocity"), std::string::npos);
}

}  // namespace
}  // namespace boltzmann::walls_scenario_test
