// [sweep] in a scenario: what is planned, the scenario of each run, and what is said of mistakes.
#include "tests/scenario/mistakes.hpp"

#include <boltzmann/scenario/scenario.hpp>

#include <cmath>

namespace boltzmann::sweep_scenario_test {
namespace {

using test::Mistake;
using test::replaced;

std::string const gas = R"toml(title = "Gas"
[units]
base = "custom"
length = "1 angstrom"
mass = "1 amu"
time = "1 ps"
[box]
low = [0, 0]
high = [60, 60]
boundary = "periodic"
[run]
step = "10 fs"
steps = 100
cutoff = 8.5
seed = 5
[[ensembles]]
name = "atoms"
class = "Newton"
load = { kind = "block", lattice = "square", spacing = 5, counts = [4, 4], origin = "centred" }
mass = 40
drift = [0, 0]
temperature = "120 K"
[[influences]]
law = "lennard-jones"
on = "atoms"
depth = "0.01 eV"
r0 = 3.8
[[diagnoses]]
kind = "energies"
[[diagnoses]]
kind = "temperature"
[output]
diagnoses = 20
)toml";

std::string const sweep = R"toml([sweep]
seeds = 3
table = ["temperature", "total energy"]
from = "0.5 ps"
labels = ["cold", "warm"]
[sweep.vary]
ensembles.atoms.temperature = ["100 K", "0.2 kK"]
"run.step" = ["5 fs", "1e-15 s"]
[[sweep.pictures]]
x = "ensembles.atoms.temperature"
y = "kinetic energy, total energy"
fit = "line"
file = "line.png"
[[sweep.pictures]]
drawing = "time-series"
y = ["temperature"]
logarithmic = true
)toml";

SweepPlan plan_of(std::string const& text, Overrides const& overrides = {}) {
  auto const scenario = parse_scenario(text, "test.toml", overrides);
  return scenario->sweep.value();
}

TEST(Sweep, IsPlanned) {
  auto const plan = plan_of(gas + sweep);
  EXPECT_EQ(plan.values, 2U);
  EXPECT_EQ(plan.seeds, 3U);
  EXPECT_EQ(plan.runs(), 6U);
  EXPECT_EQ(plan.value_of(4), 1U);
  EXPECT_EQ(plan.seed_of(4), 6U);
  ASSERT_EQ(plan.vary.size(), 2U);
  EXPECT_EQ(plan.vary[0].path, "ensembles.atoms.temperature");
  EXPECT_EQ(plan.vary[0].name, "temperature");
  EXPECT_EQ(plan.vary[0].texts, (std::vector<std::string>{"100 K", "0.2 kK"}));
  ASSERT_EQ(plan.vary[0].numbers.size(), 2U);
  EXPECT_NEAR(plan.vary[0].numbers[1], 200, 1e-10);
  EXPECT_EQ(plan.vary[0].unit, "K");
  EXPECT_NEAR(plan.vary[1].numbers[0] / plan.vary[1].numbers[1], 5, 1e-12);
  EXPECT_EQ(plan.labels, (std::vector<std::string>{"cold", "warm"}));
  EXPECT_EQ(plan.table, (std::vector<std::string>{"temperature", "total energy"}));
  EXPECT_NEAR(plan.from, 0.5, 1e-12);
  EXPECT_EQ(plan.columns[0].title(), "time (ps)");
  ASSERT_EQ(plan.pictures.size(), 2U);
  EXPECT_EQ(plan.pictures[0].y, (std::vector<std::string>{"kinetic energy", "total energy"}));
  EXPECT_TRUE(plan.pictures[0].line);
  EXPECT_TRUE(plan.pictures[1].time_series);
  EXPECT_TRUE(plan.pictures[1].logarithmic);
  EXPECT_EQ(plan.pictures[1].file, "series.png");
}

TEST(Sweep, OfAnArrayHasTheNumbersOfWhatDiffers) {
  auto const plan =
      plan_of(gas + "[sweep]\nvary = { \"ensembles.atoms.drift\" = [[\"100 m/s\", 3], [\"200 m/s\", 3]] }\n");
  ASSERT_EQ(plan.vary[0].numbers.size(), 2U);
  EXPECT_NEAR(plan.vary[0].numbers[1] / plan.vary[0].numbers[0], 2, 1e-12);
  EXPECT_EQ(plan.labels[1], "drift 200 m/s");
  auto const both = plan_of(gas + "[sweep]\nvary = { \"ensembles.atoms.drift\" = [[1, 3], [2, 4]] }\n");
  EXPECT_TRUE(both.vary[0].numbers.empty());
  EXPECT_EQ(both.labels[1], "drift [2, 4]");
  auto const words = plan_of(gas + "[sweep]\nvary = { \"ensembles.0.integrator\" = [\"leap-frog\", \"rk4\"] }\n");
  EXPECT_TRUE(words.vary[0].numbers.empty());
  EXPECT_EQ(words.labels[1], "integrator rk4");
}

TEST(Sweep, GivesTheScenarioOfEachRun) {
  Overrides chosen;
  chosen.sweep_run = 4;  // the second value, the second seed
  auto const run = parse_scenario(gas + sweep, "test.toml", chosen);
  EXPECT_FALSE(run->sweep.has_value());
  EXPECT_EQ(run->resolved.find("sweep"), std::string::npos);
  Overrides plain;
  plain.set = {"ensembles.atoms.temperature=0.2 kK", "run.step=1e-15 s"};
  plain.seed = 6;
  auto const same = parse_scenario(gas, "test.toml", plain);
  EXPECT_EQ(run->resolved, same->resolved);
  EXPECT_EQ(run->simulation->seed(), 6U);
  EXPECT_NEAR(run->simulation->step_size(), 1e-3, 1e-15);
}

TEST(Sweep, TextHasAllOverridesAndReadsBack) {
  Overrides overrides;
  overrides.set = {"ensembles.atoms.mass=20"};
  overrides.steps = 7;
  overrides.seed = 11;
  auto const plan = plan_of(gas + sweep, overrides);
  auto const again = parse_scenario(plan.text, "elsewhere/sweep.toml");
  ASSERT_TRUE(again->sweep.has_value());
  EXPECT_EQ(again->sweep->text, plan.text);
  EXPECT_EQ(again->sweep->first_seed, 11U);
  EXPECT_EQ(again->steps, 7);
  EXPECT_EQ(again->sweep->labels, plan.labels);
}

TEST(Sweep, OfTheCommandLine) {
  Overrides overrides;
  overrides.vary = {"ensembles.atoms.temperature=[\"50 K\", \"60 K\", \"70 K\"]"};
  EXPECT_EQ(plan_of(gas, overrides).runs(), 3U);
  EXPECT_EQ(plan_of(gas, overrides).table.size(), plan_of(gas, overrides).columns.size() - 1);
  overrides.seeds = 2;
  auto const instead = plan_of(gas + sweep, overrides);  // labels and what varied are gone
  EXPECT_EQ(instead.runs(), 6U);
  EXPECT_EQ(instead.vary.size(), 1U);
  EXPECT_EQ(instead.labels[2], "temperature 70 K");
  Overrides seeds;
  seeds.seeds = 4;
  EXPECT_EQ(plan_of(gas, seeds).runs(), 4U);
  EXPECT_EQ(plan_of(gas + sweep, seeds).runs(), 8U);
}

TEST(Sweep, MistakesComeInOneGo) { test::expect_mistakes_of_what_is_missing(gas + sweep, 500, 30); }

class Mistaken : public testing::TestWithParam<Mistake> {};

TEST_P(Mistaken, IsToldInOneLine) { test::expect_one_line(GetParam()); }

Mistake changed(std::string name, std::string const& old, std::string const& now, std::string place,
                std::vector<std::string> parts) {
  return {std::move(name), replaced(gas + sweep, old, now), std::move(place), std::move(parts), {}};
}

Mistake of_run(std::size_t run, Mistake mistake) {
  mistake.overrides.sweep_run = run;
  return mistake;
}

Overrides varied(std::vector<std::string> vary, std::optional<std::size_t> run = {}) {
  Overrides overrides;
  overrides.vary = std::move(vary);
  overrides.sweep_run = run;
  return overrides;
}

Mistake with(Overrides overrides, std::string name, std::string place, std::vector<std::string> parts) {
  return {std::move(name), gas, std::move(place), std::move(parts), std::move(overrides)};
}

INSTANTIATE_TEST_SUITE_P(
    All, Mistaken,
    testing::Values(
        Mistake{"no table", replaced(gas, "[units]", "sweep = 3\n[units]"), "2:9", {"[sweep]", "the number 3"}},
        changed("seeds", "seeds = 3", "seeds = 0", "35:9", {"seeds", "0", "between 1 and"}),
        changed("no seeds", "seeds = 3", "seeds = \"three\"", "35:9", {"whole number"}),
        changed("no array", "[\"100 K\", \"0.2 kK\"]", "\"100 K\"", "40:31", {"array of values", "the text"}),
        changed("none", "[\"100 K\", \"0.2 kK\"]", "[]", "40:31", {"array of values"}),
        changed("lengths", "[\"5 fs\", \"1e-15 s\"]", "[\"5 fs\"]", "41:14", {"run.step", "1 value", "has 2"}),
        changed("vary",
                "[sweep.vary]\nensembles.atoms.temperature = [\"100 K\", \"0.2 kK\"]\n\"run.step\" = [\"5 fs\", "
                "\"1e-15 s\"]",
                "vary = [1]", "39:8", {"vary", "a table"}),
        changed("column", "\"total energy\"]", "\"totl energy\"]", "36:25",
                {"totl energy", "did you mean 'total energy'"}),
        changed("from unit", "from = \"0.5 ps\"", "from = \"0.5 K\"", "37:8", {"time"}),
        changed("labels", "[\"cold\", \"warm\"]", "[\"cold\"]", "38:10", {"labels", "2 values"}),
        changed("key", "labels = ", "names = ", "38:1", {"unknown key 'names' in [sweep]"}),
        changed("x", "x = \"ensembles.atoms.temperature\"", "x = \"ensembles.atoms.temperatur\"", "43:5",
                {"neither", "did you mean 'ensembles.atoms.temperature'"}),
        changed("no x", "x = \"ensembles.atoms.temperature\"\n", "", "42:1", {"no 'x'"}),
        changed("y", "y = [\"temperature\"]", "y = [\"temperature\", \"pressure\"]", "49:21", {"pressure"}),
        changed("no y", "y = [\"temperature\"]\n", "", "47:1", {"no 'y'"}),
        changed("fit", "fit = \"line\"", "fit = \"linear\"", "45:7", {"linear", "line"}),
        changed("series has no fit", "logarithmic = true", "fit = \"line\"", "50:7", {"fit", "time series"}),
        changed("drawing", "time-series", "time-serie", "48:11", {"did you mean 'time-series'"}),
        changed("file", "line.png", "line.jpg", "46:8", {".png, .svg, .pdf"}),
        changed("folder", "line.png", "a/line.png", "46:8", {"without '/'"}),
        changed("same file", "line.png", "series.png", "47:1", {"already"}),
        changed("seed twice", "\"run.step\" = [\"5 fs\", \"1e-15 s\"]", "run.seed = [1, 2]", "41:5", {"run.seed"}),
        changed("itself", "\"run.step\"", "\"sweep.seeds\"", "41:1", {"can't vary"}),
        changed("no diagnoses", "diagnoses = 20", "diagnoses = 0", "34:1", {"diagnoses = 0"}),
        // What only the scenario of a run shows, at the place of its value.
        of_run(3, changed("value", "0.2 kK", "0.2 km", "40:41", {"temperature", "length"})),
        of_run(0, changed("path", "\"run.step\"", "\"run.stpe\"", "41:1", {"unknown key 'stpe'", "step"})),
        of_run(0, changed("ensemble", "ensembles.atoms", "ensembles.atom", "40:16",
                          {"no 'atom'", "did you mean 'atoms'"})),
        with(varied({"run.step"}), "vary without values", "--vary run.step", {"key=[values]"}),
        with(varied({"run.step=3"}), "vary no array", "--vary run.step=3", {"array of values"}),
        with(varied({"run.steps=[3]"}, 1), "no such run", "1:1", {"1 runs"})),
    test::mistake_name);

}  // namespace
}  // namespace boltzmann::sweep_scenario_test
