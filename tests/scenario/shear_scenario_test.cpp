// Sheared boxes in scenarios: keys, units, and what is refused.
#include <boltzmann/boundaries/box.hpp>
#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include "mistakes.hpp"

#include <gtest/gtest.h>

#include <string>
#include <vector>

namespace boltzmann::shear_scenario_test {
namespace {

using test::Mistake;
using test::mistake_name;

std::string const good =
    "[units]\n"                                                                               // 1
    "base = \"custom\"\n"                                                                     // 2
    "length = \"1 angstrom\"\n"                                                               // 3
    "mass = \"1 amu\"\n"                                                                      // 4
    "time = \"1 ps\"\n"                                                                       // 5
    "[box]\n"                                                                                 // 6
    "low = [0, 0, 0]\n"                                                                       // 7
    "high = [20, 20, 20]\n"                                                                   // 8
    "boundary = [\"periodic\", \"periodic\", \"periodic\"]\n"                                 // 9
    "shear = { rate = \"2e11 1/s\", flow = \"z\", gradient = \"x\", established = false }\n"  // 10
    "[run]\n"                                                                                 // 11
    "step = 0.005\n"                                                                          // 12
    "steps = 100\n"                                                                           // 13
    "cutoff = 8\n"                                                                            // 14
    "[[ensembles]]\n"                                                                         // 15
    "name = \"atoms\"\n"                                                                      // 16
    "class = \"Newton\"\n"                                                                    // 17
    "integrator = \"leap-frog\"\n"                                                            // 18
    "mass = 40\n"                                                                             // 19
    "temperature = \"100 K\"\n"                                                               // 20
    "load = { kind = \"fill\", lattice = \"fcc\", spacing = 4.5 }\n"                          // 21
    "[[influences]]\n"                                                                        // 22
    "law = \"lennard-jones\"\n"                                                               // 23
    "on = \"atoms\"\n"                                                                        // 24
    "r0 = 3.82\n"                                                                             // 25
    "depth = \"0.0103 eV\"\n"                                                                 // 26
    "[[dissipation]]\n"                                                                       // 27
    "kind = \"langevin\"\n"                                                                   // 28
    "on = \"atoms\"\n"                                                                        // 29
    "temperature = \"100 K\"\n"                                                               // 30
    "rate = 1\n"                                                                              // 31
    "[[diagnoses]]\n"                                                                         // 32
    "kind = \"viscosity\"\n";                                                                 // 33

std::string with(std::string const& old, std::string const& now, std::string text = good) {
  return test::replaced(std::move(text), old, now);
}

TEST(ShearScenario, ShearsItsBox) {
  auto const scenario = parse_scenario(good, "test.toml");
  Shear const& shear = scenario->box().shear();
  EXPECT_NEAR(shear.rate, 0.2, 1e-12);
  EXPECT_EQ(shear.flow, 2);
  EXPECT_EQ(shear.gradient, 0);
  EXPECT_FALSE(shear.established);
  scenario->simulation->run(100);
  EXPECT_NEAR(scenario->box().slide(), 0.2 * 20 * 0.5, 1e-12);
}

TEST(ShearScenario, BeginsInTheFlowUnlessToldOtherwise) {
  auto const flowing = parse_scenario(with(", established = false", ""), "test.toml");
  auto const at_rest = parse_scenario(good, "test.toml");
  for (auto const* run : {&flowing, &at_rest}) (*run)->simulation->run(0);
  AnyEnsemble const &there = *flowing->ensembles[0], &here = *at_rest->ensembles[0];
  int const along = here.field("velocity").offset + 2;
  for (std::size_t i = 0; i < here.size(); ++i)
    EXPECT_NEAR(there.row(i)[along] - here.row(i)[along], 0.2 * (here.row(i)[0] - 10), 1e-12);
  Box const& box = flowing->box();
  EXPECT_NEAR(temperature(there, 1, {.box = &box}).total, temperature(here, 1).total, 1e-9);
}

TEST(ShearScenario, ARateOfZeroIsNone) {
  auto const scenario = parse_scenario(
      with("[[diagnoses]]\nkind = \"viscosity\"\n", "", with("rate = \"2e11 1/s\"", "rate = 0")), "test.toml");
  EXPECT_FALSE(scenario->box().sheared());
}

class ShearMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(ShearMistakes, AreOneLine) { test::expect_one_line(GetParam()); }

std::vector<Mistake> const rows{
    {"no rate", with("rate = \"2e11 1/s\", ", ""), "10:9", {"shear has no 'rate'", "rate = 0.1"}},
    {"rate that is a time", with("1/s", "s"), "10:18", {"rate: '2e11 s' is a time", "1/s"}},
    {"unknown key", with("flow =", "flows ="), "10:30", {"unknown key 'flows' in shear", "did you mean 'flow'?"}},
    {"one axis", with("\"z\"", "\"x\""), "10:9", {"flow and gradient are both along x"}},
    {"no axis", with("\"z\"", "\"w\""), "10:37", {"unknown flow 'w'", "x, y, z"}},
    {"wall along the gradient",
     with("[\"periodic\"", "[\"reflecting\""),
     "10:9",
     {"axis x is reflecting", "along periodic axes"}},
    {"viscosity at rest",
     with("shear = {", "# shear = {"),
     "33:8",
     {"viscosity: the box is not sheared", "green-kubo"}},
    {"barostat",
     with("[[dissipation]]",
          "[barostat]\ntemperature = \"100 K\"\npressure = \"1 bar\"\ncompressibility = \"1e-9 1/Pa\"\nrate = 1\n"
          "[[dissipation]]"),
     "10:9",
     {"barostat", "sheared"}},
    {"shardlow",
     with("kind = \"langevin\"\non = \"atoms\"\ntemperature = \"100 K\"\nrate = 1\n",
          "kind = \"dpd\"\non = \"atoms\"\nconvention = \"fixed-temperature\"\ntemperature = \"100 K\"\nfriction = 1\n"
          "range = 8\nmethod = \"shardlow\"\n"),
     "10:9",
     {"shardlow", "simultaneous"}},
    {"mesh",
     with("[[dissipation]]", "[mesh]\nlaw = \"gravity\"\non = \"atoms\"\ncells = [8, 8, 8]\n[[dissipation]]"),
     "10:9",
     {"mesh of 8 x 8 x 8", "plain periodic boxes only"}},
};
INSTANTIATE_TEST_SUITE_P(All, ShearMistakes, testing::ValuesIn(rows), mistake_name);

}  // namespace
}  // namespace boltzmann::shear_scenario_test
