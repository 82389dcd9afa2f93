// Integrators with steps of their own, and divided steps, in scenarios: what the keys do, and what is refused.
#include <boltzmann/scenario/scenario.hpp>

#include "mistakes.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <string>
#include <vector>

namespace boltzmann::steps_scenario_test {
namespace {

using test::Mistake;
using test::mistake_name;

// A light body on an orbit of eccentricity 0.6; the numbers on the right are those of the lines.
std::string const good =
    "[units]\n"                                                                // 1
    "base = \"reduced\"\n"                                                     // 2
    "[box]\n"                                                                  // 3
    "low = [-2, -2, -2]\n"                                                     // 4
    "high = [2, 2, 2]\n"                                                       // 5
    "[run]\n"                                                                  // 6
    "step = 0.6283185307179586\n"                                              // 7
    "steps = 10\n"                                                             // 8
    "tolerance = 1e-6\n"                                                       // 9
    "[[ensembles]]\n"                                                          // 10
    "name = \"bodies\"\n"                                                      // 11
    "class = \"Kepler\"\n"                                                     // 12
    "integrator = \"gauss-radau\"\n"                                           // 13
    "mass = [1, 1e-15]\n"                                                      // 14
    "load = { kind = \"positions\", positions = [[0, 0, 0], [0.4, 0, 0]] }\n"  // 15
    "velocity = [[0, 0, 0], [0, 2, 0]]\n"                                      // 16
    "[[influences]]\n"                                                         // 17
    "law = \"gravity\"\n"                                                      // 18
    "on = \"bodies\"\n"                                                        // 19
    "G = 1\n";                                                                 // 20

std::string with(std::string const& old, std::string const& now) { return test::replaced(good, old, now); }

std::string divided(std::string const& substeps) {
  return test::replaced(with("tolerance = 1e-6", "substeps = " + substeps), "gauss-radau", "leap-frog");
}

TEST(StepsScenario, GaussRadauWithATolerance) {
  auto const loose = parse_scenario(good, "loose.toml"), tight = parse_scenario(with("1e-6", "1e-10"), "tight.toml");
  for (auto const* run : {&loose, &tight}) {
    EXPECT_EQ((*run)->simulation->method(*(*run)->ensembles[0]), Method::gauss_radau);
    (*run)->simulation->run(10);
    EXPECT_NEAR((*run)->ensembles[0]->row(1)[0], 0.4, 1e-9);
    EXPECT_NEAR((*run)->ensembles[0]->row(1)[1], 0, 1e-9);
  }
  EXPECT_EQ(loose->simulation->gauss_radau().tolerance(), 1e-6);
  EXPECT_GT(tight->simulation->gauss_radau().counts().steps, 2 * loose->simulation->gauss_radau().counts().steps);
}

TEST(StepsScenario, DividedStepsFollowThePericentre) {
  auto const run = parse_scenario(divided("{ distance = 0.001 }"), "divided.toml");
  run->simulation->run(10);
  EXPECT_NEAR(run->ensembles[0]->row(1)[0], 0.4, 1e-4);
  EXPECT_GT(run->simulation->substeps().done, 1000U);
}

class StepsMistake : public testing::TestWithParam<Mistake> {};
TEST_P(StepsMistake, IsOneLine) { test::expect_one_line(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    Steps, StepsMistake,
    testing::Values(
        Mistake{"integrator", with("gauss-radau", "gauss-randau"), "13:14", {"did you mean 'gauss-radau'?"}},
        Mistake{"tolerance too small", with("1e-6", "0"), "9:13", {"tolerance: 0 is out of range", "1e-14"}},
        Mistake{"tolerance of leap-frog",
                with("gauss-radau", "leap-frog"),
                "9:13",
                {"tolerance: it is that of gauss-radau, by which no ensemble moves"}},
        Mistake{"substeps of nothing", divided("{}"), "9:12", {"substeps: no limit is set"}},
        Mistake{"substeps as a number", divided("0.1"), "9:12", {"substeps: a table is needed"}},
        Mistake{"substeps of a wrong key", divided("{ distanc = 1 }"), "9:14", {"did you mean 'distance'?"}},
        Mistake{"substeps below zero", divided("{ energy = -1 }"), "9:23", {"energy", "positive"}},
        Mistake{"substeps without sound",
                divided("{ courant = 0.5 }"),
                "9:12",
                {"substeps: no scheme of the simulation has a Courant step"}},
        Mistake{"substeps of gauss-radau",
                with("tolerance = 1e-6", "substeps = { distance = 1 }"),
                "15:8",
                {"ensemble 'bodies' moves by gauss-radau"}},
        Mistake{"frozen",
                good + "[[ensembles.set]]\nparticles = [0]\nfreeze = true\n",
                "15:8",
                {"some particles of ensemble 'bodies' are frozen, which gauss-radau does not know"}}),
    mistake_name);

}  // namespace
}  // namespace boltzmann::steps_scenario_test
