// [[remesh]], [[split_cores]] and [[outflow]] of scenarios: who is meant, restarts, and what is refused.
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/simulation/remesher.hpp>
#include <boltzmann/simulation/split_cores.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/same_rows.hpp>
#include <tests/scenario/mistakes.hpp>

#include <cstring>
#include <string>
#include <vector>

namespace boltzmann::vortex_adaptations_test {
namespace {

std::string ensemble(std::string const& name, std::string const& of, std::string const& more = "") {
  return "[[ensembles]]\nname = \"" + name + "\"\nclass = \"" + of +
         "\"\nload = { kind = \"fill\", spacing = 0.2, where = \"r < 0.5\" }\nformulas = { vorticity = \"exp(-r^2)\" "
         "}\n"
         "core = 0.2\n" +
         more;
}
std::string const start =
    "[units]\nbase = \"reduced\"\n[box]\nlow = [-1, -1]\nhigh = [1, 1]\n[run]\nstep = 0.05\nsteps = 12\n";
std::string const flow =
    start +
    "[[remesh]]\nevery = 3\non = \"gas\"\nspacing = 0.1\nkernel = \"m6\"\nthreshold = 1e-3\nmargin = 1\n"
    "[[split_cores]]\nevery = 4\nabove = 0.25\nratio = 0.9\nmerge_within = 0.4\n"
    "[[outflow]]\nevery = 2\non = \"air\"\nfrom = [0.45, 0]\ndirection = [1, 1]\n" +
    ensemble("gas", "Diffusive", "viscosity = 0.01\nvolume = 0.04\n") +
    ensemble("air", "Spreading", "viscosity = 0.1\n") +
    "[[influences]]\nlaw = \"biot-savart-gaussian\"\non = \"gas\"\n"
    "[[influences]]\nlaw = \"vorticity-exchange\"\non = \"gas\"\nwidth = 0.1\ncutoff = 0.5\n"
    "[[influences]]\nlaw = \"biot-savart-gaussian\"\non = \"air\"\n"
    "[[influences]]\nlaw = \"biot-savart-gaussian\"\nbetween = [\"gas\", \"air\"]\n";

using test::replaced;

std::unique_ptr<ScenarioSimulation> read(std::string const& text) { return parse_scenario(text, "flow.toml"); }

std::string reports(Simulation const& simulation) {
  std::string all;
  for (auto const* adaptation : simulation.adaptations()) all += adaptation->report(UnitSystem::reduced()) + '\n';
  return all;
}

TEST(VortexAdaptations, GoOnFromACheckpointToTheBit) {
  auto const whole = read(flow), first = read(flow), second = read(first->resolved);
  ASSERT_EQ(whole->simulation->adaptations().size(), 3U);
  whole->simulation->threads(3);
  whole->simulation->run(12);
  first->simulation->run(7);
  for (std::size_t e = 0; e < 2; ++e) {
    auto &from = *first->ensembles[e], &to = *second->ensembles[e];
    to.resize(from.size());
    std::memcpy(to.row(0), from.row(0), from.size() * from.stride() * sizeof(double));
  }
  second->simulation->restore(7, 0.05, 1, first->simulation->state());
  second->simulation->run(5);
  for (std::size_t e = 0; e < 2; ++e) {
    auto const &a = *whole->ensembles[e], &b = *second->ensembles[e];
    EXPECT_NE(a.size(), 24U);
    expect_same_rows(a, b);
  }
  std::string const told = reports(*whole->simulation);
  EXPECT_EQ(told, reports(*second->simulation));
  EXPECT_NE(told.find("'gas': remeshed 4 times, "), std::string::npos) << told;
  EXPECT_NE(told.find("'air': "), std::string::npos) << told;
  EXPECT_NE(told.find(" splits, "), std::string::npos) << told;
  EXPECT_NE(told.find(" have left with the flow, "), std::string::npos) << told;
}

TEST(VortexAdaptations, MeanAllThatFitAndOneTableIsEnough) {
  auto const remesh =
      read(start + "[remesh]\nevery = 1\nspacing = 0.1\n" + ensemble("gas", "Vortex") + ensemble("air", "Inviscid") +
           replaced(ensemble("dust", "Tracer"),
                    "formulas = { vorticity = "
                    "\"exp(-r^2)\" }\ncore = 0.2\n",
                    ""));
  EXPECT_EQ(remesh->simulation->adaptations().size(), 2U);
  auto const split = read(start + "[split_cores]\nevery = 1\nabove = 1\n" + ensemble("gas", "Vortex") +
                          ensemble("air", "Spreading", "viscosity = 1\n"));
  EXPECT_EQ(split->simulation->adaptations().size(), 1U);
  auto const leave =
      read(start + "[outflow]\nfrom = [0.2, 0]\ndirection = [1, 0]\n" + ensemble("gas", "Vortex") +
           "[[ensembles]]\nname = \"dust\"\nclass = \"Tracer\"\nload = { kind = \"fill\", spacing = 0.2 }\n"
           "[[ensembles]]\nname = \"balls\"\nclass = \"Newton\"\nmass = 1\nload = { kind = \"fill\", spacing = 1 }\n");
  ASSERT_EQ(leave->simulation->adaptations().size(), 2U);
  leave->simulation->run(1);
  EXPECT_LT(leave->ensembles[0]->size(), 24U);
  EXPECT_EQ(leave->ensembles[1]->size(), 60U);
  EXPECT_EQ(leave->ensembles[2]->size(), 4U);
}

struct Mistake {
  std::string old, now, line;
};

TEST(VortexAdaptations, MistakesAreNamed) {
  for (auto const& [old, now, line] : std::vector<Mistake>{
           {"every = 3\n", "", "remesh has no 'every'; add e.g. every = 10"},
           {"spacing = 0.1\n", "", "remesh has no 'spacing'; add e.g. spacing = 0.05"},
           {"every = 3", "every = 0", "every: 0 is out of range"},
           {"on = \"gas\"", "on = \"gaz\"", "on: there is no ensemble 'gaz'; there are gas, air; did you mean 'gas'?"},
           {"\"m6\"", "\"m5\"", "unknown kernel 'm5'"},
           {"threshold = 1e-3", "threshold = 1", "remesh: threshold = 1 must be at least 0 and below 1"},
           {"margin = 1", "margins = 1", "did you mean 'margin'?"},
           {"high = [1, 1]", "high = [1, 1]\nboundary = [\"open\", \"reflecting\"]",
            "split_cores: axis y is reflecting"},
           {"ratio = 0.9", "ratio = 0.99", "ratio: 0.99 is out of range"},
           {"from = [0.45, 0]\n", "", "outflow has no 'from'; add e.g. from = [10, 0]"},
           {"direction = [1, 1]\n", "", "outflow has no 'direction'; add e.g. direction = [1, 0]"},
           {"direction = [1, 1]", "direction = [0, 0]", "outflow: the direction is zero"},
           {"direction = [1, 1]", "direction = [1, 1]\nat = 3", "'at'"},
           {"above = 0.25\n", "", "split_cores has no 'above'; add e.g. above = 0.1"},
           {"class = \"Spreading\"", "class = \"Viscous\"",
            "split_cores: there is no ensemble whose vortices could be meant"},
           {"[[influences]]", "[[ensembles.set]]\nwhere = \"x < 0.1\"\nfreeze = true\n[[influences]]",
            "split_cores: some particles of 'air' are frozen, by their numbers"}}) {
    std::string const found = message([&, &before = old, &after = now] { read(replaced(flow, before, after)); });
    EXPECT_NE(found.find(line), std::string::npos) << "for '" << now << "' instead of '" << old << "':\n" << found;
  }
}

}  // namespace
}  // namespace boltzmann::vortex_adaptations_test
