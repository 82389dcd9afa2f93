// Rezoning in scenarios: the same run as a program's, restarts, and what is refused.
#include <boltzmann/laws/materials/ideal_gas.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/simulation/rezoner.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/same_rows.hpp>
#include <tests/scenario/mistakes.hpp>

#include <cstring>
#include <string>

namespace boltzmann::rezone_scenario_test {
namespace {

// Gas in a tube that flows fastest in the middle.
std::string const jet =
    "[units]\nbase = \"si\"\n"
    "[box]\nlow = [0, 0]\nhigh = [1, 1]\nboundary = [\"periodic\", \"mirror\"]\n"
    "[run]\nstep = 0.005\nsteps = 40\n"
    "[smooth]\n"
    "[[smooth.rezone]]\nevery = 10\non = \"gas\"\nsplit_above = \"1.1 kg/m^2\"\nsmallest_mass = \"1 g\"\n"
    "merge_below = \"900 g/m^2\"\nlargest_mass = 0.005\nmerge_within = 0.7\n"
    "[[smooth.rezone]]\nevery = 20\nby = \"volume\"\nsplit_above = \"20 cm^2\"\nlow = [\"20 cm\", 0]\nhigh = [0.6, 1]\n"
    "[[ensembles]]\nname = \"gas\"\nclass = \"Smooth\"\nrange = 0.13\nintegrator = \"leap-frog\"\n"
    "load = { kind = \"fill\", spacing = 0.05 }\n"
    "formulas = { density = \"(1 + 0.4*sin(2*pi*x/(1 m)))*(1 kg/m^2)\", specific_energy = \"1\", velocity = [\"(0.4 "
    "m/s)*sin(pi*y/(1 m))\", \"0\"] }\n"
    "material = { kind = \"ideal-gas\", gamma = 1.4, specific_heat = 1 }\n"
    "[[diagnoses]]\nkind = \"energies\"\n";

using test::replaced;

std::unique_ptr<ScenarioSimulation> read(std::string const& text) { return parse_scenario(text, "jet.toml"); }

std::string reports(Simulation const& simulation) {
  std::string all;
  for (auto const* adaptation : simulation.adaptations()) all += adaptation->report(UnitSystem::si()) + '\n';
  return all;
}

TEST(RezoneScenario, IsTheRezoningOfAProgram) {
  auto const scenario = read(jet);
  Ensemble<Smooth<2>> gas("gas");
  auto const& loaded = *scenario->ensembles[0];
  gas.resize(loaded.size());
  std::memcpy(gas.row(0), loaded.row(0), gas.size() * gas.stride() * sizeof(double));
  SmoothScheme scheme(Box(Vector{0.0, 0.0}, Vector{1.0, 1.0}, {Boundary::periodic, Boundary::mirror}));
  scheme.material(gas, IdealGas{1.4, 1});
  Simulation simulation(scheme, 0.005);
  simulation.integrate(gas, Method::leap_frog);
  simulation.adapt(10, Rezoner(gas, scheme.box(),
                               {.split_above = 1.1,
                                .merge_below = 0.9,
                                .smallest_mass = 0.001,
                                .largest_mass = 0.005,
                                .merge_within = 0.7}));
  simulation.adapt(
      20, Rezoner(gas, scheme.box(),
                  {.by = Rezoning::By::volume, .split_above = 0.002, .region = Rezoning::Block{{0.2, 0}, {0.6, 1}}}));
  simulation.run(40);
  scenario->simulation->run(40);
  EXPECT_NE(gas.size(), 400U);
  expect_same_rows(gas, loaded);
  auto const text = reports(*scenario->simulation);
  EXPECT_EQ(text, reports(simulation));
  EXPECT_NE(text.find("merges"), std::string::npos);
  EXPECT_NE(text.find("kg m^2/s"), std::string::npos) << text;
}

TEST(RezoneScenario, TheStoredOneGoesOn) {
  auto const whole = read(jet), first = read(jet), second = read(first->resolved);
  whole->simulation->run(40);
  first->simulation->run(20);
  auto &from = *first->ensembles[0], &to = *second->ensembles[0];
  EXPECT_NE(from.size(), 400U);
  to.resize(from.size());
  std::memcpy(to.row(0), from.row(0), from.size() * from.stride() * sizeof(double));
  second->simulation->restore(20, 0.005, 1, first->simulation->state());
  second->simulation->run(20);
  expect_same_rows(*whole->ensembles[0], to);
  EXPECT_EQ(reports(*whole->simulation), reports(*second->simulation));
}

TEST(RezoneScenario, OneTableIsEnoughAndMeansAllEnsembles) {
  auto const at = jet.find("[[smooth.rezone]]"), end = jet.find("[[ensembles]]");
  auto const text = jet.substr(0, at) + "rezone = { every = 5, split_above = 1.1, smallest_mass = 0.001 }\n";
  auto const one = jet.substr(end, jet.find("[[diagnoses]]") - end);
  auto const scenario =
      read(text + replaced(one, "load = {", "load = { low = [0, 0], high = [1, 0.5],") +
           replaced(replaced(one, "\"gas\"", "\"air\""), "load = {", "load = { low = [0, 0.5], high = [1, 1],"));
  scenario->simulation->run(5);
  ASSERT_EQ(scenario->simulation->adaptations().size(), 2U);
  for (auto const& ensemble : scenario->ensembles) EXPECT_GT(ensemble->size(), 210U) << ensemble->name();
}

// ---- Mistakes ----

struct Mistake {
  std::string old, now, line;
};

TEST(RezoneScenario, MistakesAreNamed) {
  for (auto const& [old, now, line] : std::vector<Mistake>{
           {"every = 10\n", "", "jet.toml:11:1: rezone has no 'every'; add e.g. every = 20"},
           {"every = 10", "every = 0", "jet.toml:12:9: every: 0 is out of range"},
           {"on = \"gas\"", "on = \"gaz\"",
            "jet.toml:13:6: on: there is no ensemble 'gaz'; there is gas; did you mean 'gas'?"},
           {"by = \"volume\"", "by = \"volumes\"", "unknown by 'volumes'"},
           {"\"1.1 kg/m^2\"", "\"1.1 kg/m^3\"", "jet.toml:14:15: split_above: "},
           {"\"20 cm^2\"", "\"20 cm^3\"", "jet.toml:22:15: split_above: "},
           {"split_above = \"20 cm^2\"\n", "", "jet.toml:19:1: rezone needs 'split_above' or 'merge_below', or both"},
           {"smallest_mass = \"1 g\"\n", "", "jet.toml:11:1: rezoning: to split by density needs a smallest_mass"},
           {"merge_within = 0.7", "merge_within = 1.5", "merge_within: 1.5 is out of range"},
           {"merge_within = 0.7", "merge_width = 0.7", "did you mean 'merge_within'?"},
           {"low = [\"20 cm\", 0]\n", "", "high: a region needs both 'low' and 'high'"},
           {"high = [0.6, 1]\n[", "high = [0.1, 1]\n[", "high: on axis x it is 0.1, not above low = 0.2"},
           {"[[smooth.rezone]]\nevery = 10", "[[smooth.rezones]]\nevery = 10", "did you mean 'rezone'?"},
           {"[[diagnoses]]", "[[ensembles.set]]\nwhere = \"x < 0.1\"\nfreeze = true\n[[diagnoses]]",
            "rezone: some particles of 'gas' are frozen, by their numbers"}}) {
    std::string const found = message([&, &before = old, &after = now] { read(replaced(jet, before, after)); });
    EXPECT_NE(found.find(line), std::string::npos) << "for '" << now << "' instead of '" << old << "':\n" << found;
  }
  auto const end = jet.find("[[smooth.rezone]]");
  EXPECT_NE(
      message([&] { read(jet.substr(0, end) + "rezone = 20\n" + jet.substr(jet.find("[[ensembles]]"))); })
          .find("jet.toml:11:10: rezone: a table is needed, rezone = { every = 20, split_above = 2, smallest_mass "
                "= 0.5 }, not the number 20"),
      std::string::npos);
}

TEST(RezoneScenario, FrozenParticlesKeepTheirNumbers) {
  auto const at = jet.find("[[smooth.rezone]]"), end = jet.find("[[ensembles]]");
  auto const scenario = read(replaced(jet.substr(0, at) + jet.substr(end), "[[diagnoses]]",
                                      "[[ensembles.set]]\nwhere = \"x < 0.1\"\nfreeze = true\n[[diagnoses]]"));
  auto& gas = *scenario->ensembles[0];
  scenario->simulation->adapt(2, [&] { gas.resize(gas.size() - 1); });
  EXPECT_EQ(message([&] { scenario->simulation->run(5); }),
            "step 2: ensemble 'gas' had 400 particles and has 399 now, but some of them are frozen, by number");
}

}  // namespace
}  // namespace boltzmann::rezone_scenario_test
