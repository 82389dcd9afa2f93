// [minimise], and starts that are refused, in scenarios; what is frozen stays.
#include <boltzmann/scenario/scenario.hpp>

#include "mistakes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace boltzmann::starts_test {
namespace {

using test::Mistake;
using test::mistake_name;

// Six beads on a chain of springs that hangs from the first; the numbers on the right are those of the lines.
std::string const chain =
    "[units]\n"                                                                           // 1
    "base = \"reduced\"\n"                                                                // 2
    "[box]\n"                                                                             // 3
    "low = [-99]\n"                                                                       // 4
    "high = [1]\n"                                                                        // 5
    "[run]\n"                                                                             // 6
    "step = 0.01\n"                                                                       // 7
    "steps = 10\n"                                                                        // 8
    "[minimise]\n"                                                                        // 9
    "force = 1e-9\n"                                                                      // 10
    "[[ensembles]]\n"                                                                     // 11
    "name = \"beads\"\n"                                                                  // 12
    "class = \"Newton\"\n"                                                                // 13
    "mass = 2\n"                                                                          // 14
    "load = { kind = \"positions\", positions = [[0], [-1], [-2], [-3], [-4], [-5]] }\n"  // 15
    "[[ensembles.set]]\n"                                                                 // 16
    "particles = [0]\n"                                                                   // 17
    "freeze = true\n"                                                                     // 18
    "[[influences]]\n"                                                                    // 19
    "energy = \"50*(r - 1)^2\"\n"                                                         // 20
    "on = \"beads\"\n"                                                                    // 21
    "connect = [[0, 5, 1]]\n"                                                             // 22
    "[[influences]]\n"                                                                    // 23
    "influence = \"[-3*mass]\"\n"                                                         // 24
    "from_outside = true\n"                                                               // 25
    "on = \"beads\"\n";                                                                   // 26

std::string with(std::string const& old, std::string const& now) { return test::replaced(chain, old, now); }

// A spring of stiffness 100 under n beads of weight 6 is 1 + 0.06 n long.
TEST(Starts, AChainHangsAtItsLength) {
  auto const run = parse_scenario(chain, "chain.toml");
  run->simulation->run(0);
  auto const& beads = *run->ensembles[0];
  EXPECT_EQ(beads.row(0)[0], 0);
  double place = 0;
  for (int i = 1; i < 6; ++i) {
    place -= 1 + 0.06 * (6 - i);
    EXPECT_NEAR(beads.row(static_cast<std::size_t>(i))[0], place, 1e-9) << i;
  }
  ASSERT_TRUE(run->simulation->minimised());
  EXPECT_TRUE(run->simulation->minimised()->converged);
  EXPECT_FALSE(run->simulation->minimised()->energy_after) << "the weight is typed as a force";
  run->simulation->run(10);
  EXPECT_NEAR(beads.row(5)[0], place, 1e-9);
}

TEST(Starts, AllKeysAreRead) {
  auto const run = parse_scenario(
      test::replaced(with("force = 1e-9", "force = 1e-9\nsteps = 2\nstep = 0.02\ndistance = 0.001"), "[-5]", "[-5.5]"),
      "chain.toml");
  run->simulation->run(0);
  auto const& found = *run->simulation->minimised();
  EXPECT_FALSE(found.converged);
  EXPECT_EQ(found.steps, 2);
  EXPECT_LT(std::abs(run->ensembles[0]->row(5)[0] + 5.5), 0.0021);
}

// A load that overlaps can't be run, but after [minimise] it can.
TEST(Starts, OverlapsAreRefusedOrPushedApart) {
  std::string const gas =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0, 0]\nhigh = [6, 6, 6]\nboundary = \"periodic\"\n[run]\nstep = "
      "0.01\nsteps = 20\ncutoff = 2\nseed = 3\n[minimise]\nforce = 0.1\n[[ensembles]]\nname = \"gas\"\nclass = "
      "\"Newton\"\ntemperature = 1\nnumber = 150\nload = { kind = \"random\" }\n[[influences]]\nlaw = "
      "\"lennard-jones\"\non = \"gas\"\ndepth = 1\nr0 = 1\n";
  auto const run = parse_scenario(gas, "gas.toml");
  run->simulation->run(20);
  EXPECT_TRUE(run->simulation->minimised()->converged);
  try {
    parse_scenario(test::replaced(gas, "[minimise]\nforce = 0.1\n", ""), "gas.toml");
    FAIL() << "it was not refused";
  } catch (ScenarioErrors const& errors) {
    ASSERT_EQ(errors.lines.size(), 1U);
    EXPECT_NE(errors.lines[0].find("apart at the start: their force would move the first by "), std::string::npos)
        << errors.lines[0];
    EXPECT_NE(errors.lines[0].find("let [minimise] push them apart"), std::string::npos) << errors.lines[0];
    EXPECT_TRUE(errors.lines[0].starts_with("gas.toml:17:8: ")) << errors.lines[0];
  }
}

// A slow law is a scheme of its own: the motion is nearly that of each step, and less is calculated.
TEST(Starts, SlowLawsHaveASchemeOfTheirOwn) {
  auto const gas = [](std::string const& every) {
    return parse_scenario(
        "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [12, 12]\nboundary = \"periodic\"\n[run]\nstep = "
        "0.004\nsteps = 40\n[[ensembles]]\nname = \"gas\"\nclass = \"Newton\"\ntemperature = 1\nload = { kind = "
        "\"fill\", spacing = 1.2 }\n[[influences]]\nlaw = \"lennard-jones\"\non = \"gas\"\ndepth = 1\nr0 = "
        "1.1\ncutoff = 2.5\n[[influences]]\nenergy = \"0.3*exp(-r/2)\"\non = \"gas\"\ncutoff = 5\n" +
            every,
        "gas.toml");
  };
  auto const each = gas(""), fourth = gas("every = 4\n");
  EXPECT_EQ(each->schemes.size(), 1U);
  ASSERT_EQ(fourth->schemes.size(), 2U);
  EXPECT_EQ(fourth->simulation->every(*fourth->schemes[1]), 4);
  double const start = each->simulation->measure().potential;
  each->simulation->run(40);
  fourth->simulation->run(40);
  EXPECT_NEAR(each->simulation->measure().potential, fourth->simulation->measure().potential, 1e-2 * std::abs(start));
  double most = 0;
  for (std::size_t i = 0; i < 100; ++i)
    most = std::max(most, std::abs(each->ensembles[0]->row(i)[0] - fourth->ensembles[0]->row(i)[0]));
  EXPECT_LT(most, 1e-3);
  EXPECT_GT(most, 0);
}

std::string const too_long =
    test::replaced(test::replaced(test::replaced(chain, "[minimise]\nforce = 1e-9\n", ""), "[-5]", "[-5.5]"),
                   "step = 0.01", "step = 3");

class StartsMistake : public testing::TestWithParam<Mistake> {};
TEST_P(StartsMistake, IsOneLine) { test::expect_one_line(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Starts, StartsMistake,
    testing::Values(Mistake{"tolerance", with("force = 1e-9", "force = 0"), "10:9", {"force", "positive"}},
                    Mistake{"key", with("force = 1e-9", "forces = 1"), "10:1", {"did you mean 'force'?"}},
                    Mistake{"steps", with("force = 1e-9", "steps = 0"), "10:9", {"steps", "1"}},
                    Mistake{"step",
                            too_long,
                            "7:8",
                            {"the step 3 is too long for the forces of the start: particle 4 of 'beads'",
                             "take a step below "}}),
    mistake_name);

}  // namespace
}  // namespace boltzmann::starts_test
