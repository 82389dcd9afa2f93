// Temperatures and pressures that are held, and events, in scenarios: heat baths of all kinds, barostats, what happens at a
// time, in files and after a resume.
#include "mistakes.hpp"

#include <boltzmann/diagnoses/measures.hpp>
#include <boltzmann/dissipation/heat_bath.hpp>
#include <boltzmann/dissipation/rescaling_bath.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <gtest/gtest.h>
#include <tests/message.hpp>
#include <tests/seed.hpp>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <memory>
#include <string>
#include <vector>

namespace boltzmann::ensembles_test {
namespace {

using Scenario = std::unique_ptr<ScenarioSimulation>;

std::string const fluid =
    "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [12, 12]\nboundary = \"periodic\"\n"
    "[run]\nstep = 0.005\nsteps = 400\ncutoff = 2.2\n"
    "[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nmass = 1\ntemperature = 1\n"
    "load = { kind = \"block\", lattice = \"square\", spacing = 1.2, counts = [10, 5], origin = [0.6, 0.6] }\n"
    "[[ensembles]]\nname = \"b\"\nclass = \"Newton\"\nmass = 2\ntemperature = 1\n"
    "load = { kind = \"block\", lattice = \"square\", spacing = 1.2, counts = [10, 5], origin = [0.6, 6.6] }\n"
    "[[influences]]\nlaw = \"lennard-jones\"\namong = [\"a\", \"b\"]\ndepth = 1\nr0 = 1.12\n";

Scenario scenario(std::string const& text) { return parse_scenario(text, "test.toml"); }
double temperature_of(ScenarioSimulation const& run) {
  std::vector<AnyEnsemble*> all;
  for (auto const& ensemble : run.ensembles) all.push_back(ensemble.get());
  return temperature(all, 1, {.subtract_drift = true}).total;
}
std::vector<double> state_of(ScenarioSimulation const& run) {
  std::vector<double> all;
  for (auto const& ensemble : run.ensembles)
    all.insert(all.end(), ensemble->row(0), ensemble->row(0) + ensemble->size() * ensemble->stride());
  auto const edges = run.box().edges();
  all.insert(all.end(), edges.begin(), edges.end());
  return all;
}
bool same(std::vector<double> const& a, std::vector<double> const& b) {
  return a.size() == b.size() && std::memcmp(a.data(), b.data(), a.size() * sizeof(double)) == 0;
}
/// The same scenario, from where another run stands.
Scenario resumed(ScenarioSimulation const& from, std::string const& text) {
  auto other = scenario(text);
  for (std::size_t e = 0; e < from.ensembles.size(); ++e)
    std::copy_n(from.ensembles[e]->row(0), from.ensembles[e]->size() * from.ensembles[e]->stride(),
                other->ensembles[e]->row(0));
  Simulation const& simulation = *from.simulation;
  other->simulation->restore(simulation.step(), simulation.step_size(), simulation.seed(), simulation.state());
  return other;
}
void expect_same_after_a_resume(std::string const& text, std::uint64_t steps, std::vector<std::uint64_t> const& stops) {
  auto const whole = scenario(text);
  whole->simulation->run(steps);
  for (auto const stop : stops) {
    auto const first = scenario(text);
    first->simulation->threads(2);
    first->simulation->run(stop);
    auto const second = resumed(*first, text);
    second->simulation->run(steps - stop);
    EXPECT_TRUE(same(state_of(*second), state_of(*whole))) << stop << "\n" << text;
  }
}

TEST(HeatBaths, OfAllKindsActOnSeveralEnsemblesTogether) {
  for (std::string const kind : {"velocity-rescaling", "nose-hoover", "langevin"}) {
    std::string const text = fluid + "[[dissipation]]\nkind = \"" + kind +
                             "\"\non = [\"a\", \"b\"]\ntemperature = \"0.5 + 0.25*time\"\nrate = 20\n";
    auto const run = scenario(text);
    ASSERT_EQ(run->dissipations.size(), 1U);
    auto const& bath = dynamic_cast<HeatBath const&>(*run->dissipations[0]);
    EXPECT_EQ(bath.ensembles().size(), 2U);
    EXPECT_EQ(bath.kind(), kind);
    EXPECT_NEAR(bath.temperature_at(2), 1, 1e-14);
    if (auto const* rescaling = dynamic_cast<RescalingBath const*>(&bath)) {
      EXPECT_EQ(rescaling->degrees_of_freedom(), 198);
    }
    run->simulation->run(400);
    EXPECT_NEAR(temperature_of(*run), 1, 0.5) << kind;
    expect_same_after_a_resume(text, 60, {25});
  }
}

TEST(HeatBaths, InBlocksConductHeatBetweenThem) {
  // Two baths on one ensemble, in different places.
  std::string const bath = "[[dissipation]]\nkind = \"langevin\"\non = \"a\"\nrate = 10\n";
  auto const run = scenario(fluid + bath + "temperature = 3\nlow = [0, 0]\nhigh = [4, 12]\n" + bath +
                            "temperature = 1\nlow = [6, 0]\nhigh = [10, 12]\n");
  run->simulation->run(300);
  EXPECT_GT(run->dissipations[0]->heat(), 5);
  EXPECT_NE(run->dissipations[1]->heat(), 0);
}

std::string const barostat =
    "[[dissipation]]\nkind = \"velocity-rescaling\"\non = [\"a\", \"b\"]\ntemperature = 1\nrate = 10\n"
    "[barostat]\npressure = 2\ntemperature = 1\ncompressibility = 0.3\nrate = 20\nevery = 5\n";

TEST(Barostats, StretchTheBox) {
  auto const run = scenario(fluid + barostat + "[[diagnoses]]\nkind = \"box\"\n");
  ASSERT_EQ(run->simulation->barostats().size(), 1U);
  ASSERT_EQ(run->diagnoses.size(), 1U);
  EXPECT_EQ(run->diagnoses[0]->columns().size(), 4U);
  run->simulation->run(100);
  EXPECT_NE(run->box().volume(), 144);
  EXPECT_NEAR(run->box().length(0), run->box().length(1), 1e-9);
  expect_same_after_a_resume(fluid + barostat, 60, {20, 31});
  auto const one = scenario(fluid + barostat + "axes = \"y\"\n");
  one->simulation->run(100);
  EXPECT_EQ(one->box().length(0), 12);
  EXPECT_NE(one->box().length(1), 12);
  std::string gentle = barostat + "method = \"mtk\"\n";
  gentle.replace(gentle.rfind("rate = 20"), 9, "rate = 2");
  auto const piston = scenario(fluid + gentle);
  piston->simulation->run(100);
  EXPECT_NE(piston->box().volume(), 144);
  expect_same_after_a_resume(fluid + gentle, 60, {20, 31});
}

TEST(Events, ChangeBathsLawsMethodsAndVelocities) {
  std::string const text =
      fluid +
      "[[influences]]\nlaw = \"uniform-gravity\"\non = \"a\"\nacceleration = [0.1, 0]\n"
      "[[dissipation]]\nkind = \"langevin\"\non = \"b\"\ntemperature = 1\nrate = 5\n"
      "[[events]]\nat = 0.1\nset = { \"dissipation.0.temperature\" = 9, \"influences.1.acceleration\" = [3, 0] }\n"
      "[[events]]\nat = 0.2\nset = { ensembles.a.integrator = \"deactivate\" }\n"
      "[[events]]\nat = 0.05\non = \"a\"\nkick = [0, 10]\nwhere = \"x < 6\"\n";
  auto const run = scenario(text);
  AnyEnsemble const &a = *run->ensembles[0], &b = *run->ensembles[1];
  auto const& bath = dynamic_cast<HeatBath const&>(*run->dissipations[0]);
  run->simulation->run(9);
  EXPECT_LT(momentum(a)[1], 100);
  run->simulation->run(1);
  std::size_t kicked = 0;
  int const v = a.field("velocity").offset;
  for (std::size_t i = 0; i < a.size(); ++i)
    if (a.row(i)[v + 1] > 5) ++kicked;
  EXPECT_GT(kicked, 15U);
  EXPECT_LT(kicked, 35U);
  run->simulation->run(9);
  EXPECT_EQ(bath.temperature_at(0), 1);
  run->simulation->run(1);
  EXPECT_EQ(bath.temperature_at(0), 9);
  EXPECT_EQ(run->simulation->method(a), Method::leap_frog);
  run->simulation->run(20);
  EXPECT_EQ(run->simulation->method(a), Method::deactivate);
  auto const stays = a.row(3)[0];
  auto const moves = b.row(3)[0];
  run->simulation->run(5);
  EXPECT_EQ(a.row(3)[0], stays);
  EXPECT_NE(b.row(3)[0], moves);
  expect_same_after_a_resume(text, 60, {5, 10, 15, 20, 30, 40, 50});
}

TEST(Events, ALawFromOutsideHasItsNewNumber) {
  // A particle under a force that changes once.
  auto const run = scenario(
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0]\nhigh = [100]\n[run]\nstep = 0.01\nsteps = 200\n"
      "[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nmass = 2\nload = { kind = \"positions\", positions = [[5]] }\n"
      "[[influences]]\nlaw = \"uniform-gravity\"\non = \"a\"\nacceleration = [2]\n"
      "[[events]]\nat = 1\nset = { \"influences.0.acceleration\" = [-3] }\n");
  run->simulation->run(200);
  int const v = run->ensembles[0]->field("velocity").offset;
  EXPECT_NEAR(run->ensembles[0]->row(0)[v], 2 - 3, 1e-12);
  EXPECT_NEAR(run->ensembles[0]->row(0)[0], 5 + 1 + 2 - 1.5, 1e-12);
}

TEST(Events, QuenchAndScaleVelocities) {
  auto const run = scenario(fluid + "[[events]]\nat = 0.05\ntemperature = 0.25\n[[events]]\nat = 0.1\nscale = 0\n");
  double quenched = 0, stopped = 1;
  run->simulation->observe(10, [&](Simulation const& now) {
    if (now.step() == 10) quenched = temperature_of(*run);
    if (now.step() == 20) stopped = temperature_of(*run);
  });
  auto const before = momentum(*run->ensembles[0])[0] + momentum(*run->ensembles[1])[0];
  run->simulation->run(10);
  EXPECT_NEAR(momentum(*run->ensembles[0])[0] + momentum(*run->ensembles[1])[0], before, 1e-11);
  run->simulation->run(10);
  EXPECT_NEAR(quenched, 0.25, 1e-12);
  EXPECT_EQ(stopped, 0);
  EXPECT_EQ(message([&] { run->simulation->rewind(1); }), "a run with events can't go backwards");
}

TEST(Ensembles, MistakesAreToldInOneLine) {
  std::string const bath = "[[dissipation]]\nkind = \"langevin\"\non = \"a\"\ntemperature = 1\nrate = 5\n";
  auto const line_of = [&](std::string const& more) {
    auto const lines = test::mistakes_of(fluid + more);
    EXPECT_EQ(lines.size(), 1U) << more << testing::PrintToString(lines);
    return lines.empty() ? std::string() : lines[0];
  };
  auto const expect = [&](std::string const& more, std::vector<std::string> const& words) {
    auto const line = line_of(more);
    for (auto const& word : words) EXPECT_NE(line.find(word), std::string::npos) << line;
  };
  std::string const rescaling = "[[dissipation]]\nkind = \"velocity-rescaling\"\non = \"a\"\nrate = 5\n";
  expect(rescaling + "temperature = \"1 + tme\"\n", {"temperature"});
  expect(rescaling + "temperature = \"[time, 1]\"\n", {"temperature", "a vector"});
  expect(rescaling + "temperature = 1\nlow = [1, 1]\n", {"low: a block needs both 'low' and 'high'"});
  expect(rescaling + "temperature = 1\nlow = [1, 1]\nhigh = [0, 2]\n", {"low edge 1", "high edge 0"});
  expect("[[dissipation]]\nkind = \"nose-hoover\"\non = \"a\"\nrate = 5\ntemperature = 1\nchain = 0\n",
         {"chain", "between 1 and 100"});
  expect("[[dissipation]]\nkind = \"nose-hoover\"\non = \"a\"\nrate = 5\ntemperature = 0\n", {"above zero"});
  expect(bath + bath, {"there is a langevin dissipation of 'a' already"});
  expect("[barostat]\npressure = 1\ntemperature = 1\nrate = 1\n", {"has no 'compressibility'"});
  expect("[barostat]\npressure = 1\ntemperature = 1\nrate = 1\ncompressibility = 1\naxes = [\"x\", \"x\"]\n",
         {"axes: x is named twice"});
  expect("[barostat]\npressure = 1\ntemperature = 1\nrate = 1\ncompressibility = 1\naxes = \"z\"\n", {"axes"});
  expect("[barostat]\npressure = 1\ntemperature = 1\nrate = 1\ncompressibility = 1\nmethod = \"mkt\"\n",
         {"method", "mkt", "mtk"});
  std::string cut = fluid;
  cut.insert(cut.find("cutoff"), "shifted = false\n");
  auto const jumps =
      test::mistakes_of(cut + "[barostat]\npressure = 1\ntemperature = 1\nrate = 1\ncompressibility = 1\n");
  ASSERT_EQ(jumps.size(), 1U);
  EXPECT_NE(jumps[0].find("the energy of this law jumps at its cut-off"), std::string::npos) << jumps[0];
  expect("[[events]]\nat = 1\n", {"nothing happens", "'scale'"});
  expect("[[events]]\nat = -1\nscale = 2\n", {"at", "positive"});
  expect("[[events]]\nscale = 2\n", {"has no 'at'"});
  expect(bath + "[[events]]\nat = 1\nset = { \"dissipation.0.temperatur\" = 2 }\n",
         {"can't set 'dissipation.0.temperatur'", "did you mean 'dissipation.0.temperature'"});
  expect(bath + "[[events]]\nat = 1\nset = { \"dissipation.0.temperature\" = -2 }\n", {"zero or more"});
  expect(bath + "[[events]]\nat = 1\nset = { ensembles.a.integrator = \"rk4\" }\n", {"friction and noise"});
  expect("[[events]]\nat = 1\nset = { ensembles.a.integrator = \"rk5\" }\n", {"rk5", "rk4"});
  expect("[[events]]\nat = 1\nset = 3\n", {"set: a table"});
  expect("[[events]]\nat = 1\non = \"c\"\nscale = 2\n", {"there is no ensemble 'c'"});
  expect("[[events]]\nat = 1\non = \"a\"\nscale = 2\nwhere = \"x + 1\"\n", {"where: a condition is needed"});
  expect(bath + "[[events]]\nat = 1\non = \"a\"\nset = { \"dissipation.0.temperature\" = 2 }\n", {"on: it belongs"});
}

}  // namespace
}  // namespace boltzmann::ensembles_test
