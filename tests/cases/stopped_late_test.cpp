// Kind: a run that was stopped and resumed differs from one without a stop, but only after something that happens late:
// vortices that have reached another ensemble, an accuracy that is looked at again every 64 calculations, an event.
// Siblings: every shipped scenario, stopped twice, with as many steps as there is time for in a test.
#include "tests/cases/case.hpp"

#include "tests/bzm/same_run.hpp"

#include <fstream>
#include <sstream>

namespace boltzmann::stopped_late_test {
namespace {

using namespace boltzmann::test;

/// Scenario, steps and further settings, of tests/cases/files/stopped_late.txt.
struct Plan {
  std::string scenario;
  int steps = 0;
  std::vector<std::string> more = {};
};

std::vector<Plan> const& plans() {
  static std::vector<Plan> const all = [] {
    std::vector<Plan> read;
    std::ifstream file(std::string(BOLTZMANN_SOURCE) + "/tests/cases/files/stopped_late.txt");
    for (std::string line; std::getline(file, line);) {
      if (line.empty() || line[0] == '#') continue;
      std::istringstream words(line);
      Plan plan;
      words >> plan.scenario >> plan.steps;
      for (std::string word; words >> word;) plan.more.insert(plan.more.end(), {"--set", word});
      read.push_back(plan);
    }
    return read;
  }();
  return all;
}

struct StoppedLate : testing::TestWithParam<Plan> {};

TEST_P(StoppedLate, IsTheRunWithoutAStop) {
  auto const& plan = GetParam();
  Folder folder;
  std::vector<std::string> words{"run",     plan.scenario,         "--threads", "1",
                                 "--quiet", "--no-sweep",          "--set",     "output.diagnoses=1",
                                 "--set",   "output.trajectory=9", "--set",     "output.pictures=[]"};
  words.insert(words.end(), plan.more.begin(), plan.more.end());
  auto const run = [&](std::vector<std::string> all, std::vector<std::string> const& more) {
    all.insert(all.end(), more.begin(), more.end());
    auto const outcome = bzm(all, folder.string());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  };
  int const first = plan.steps * 4 / 10, second = plan.steps * 3 / 10 + 1;
  run(words, {"--steps", std::to_string(plan.steps), "--out", "whole"});
  run(words, {"--steps", std::to_string(first), "--out", "parts"});
  std::vector<std::string> const resume{"resume", "parts", "--threads", "1", "--quiet", "--steps"};
  run(resume, {std::to_string(second)});
  run(resume, {std::to_string(plan.steps - first - second)});
  EXPECT_EQ(checkpoint_step(folder / "whole"), plan.steps);
  expect_same_checkpoint(folder / "whole", folder / "parts");
  for (auto const& entry : fs::directory_iterator(folder / "whole")) {
    auto const name = entry.path().filename().string();
    if (!name.ends_with(".csv") && !name.starts_with("trajectory.h5")) continue;
    EXPECT_TRUE(text_of(entry.path()) == text_of(folder / ("parts/" + name))) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, StoppedLate, testing::ValuesIn(plans()), [](auto const& info) {
  std::string name = info.param.scenario;
  std::replace(name.begin(), name.end(), '-', '_');
  return name;
});

// A step from (n - 1) dt on ends at n dt, also where (n - 1) dt + dt is rounded to another number. Siblings: forces that
// are calculated for friction and for a second stage, in a box whose images move.
TEST(StoppedLate, AfterAnyStepForcesOfTheTimeAreTheSame) {
  constexpr double step = 0.02;
  std::vector<int> stops;
  for (int n = 30; stops.size() < 4; ++n)
    if ((n - 1) * step + step != n * step) stops.push_back(n);
  std::string const gas =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [7, 7]\nboundary = \"periodic\"\nshear = { rate = 0.3, "
      "flow = "
      "\"x\", gradient = \"y\" }\n[run]\nstep = 0.02\nsteps = 200\ncutoff = 1\nskin = 0.3\nthreads = "
      "1\n[[ensembles]]\nname "
      "= \"fluid\"\nclass = \"Newton\"\nmass = 1\nnumber = 150\nload = { kind = \"random\" }\ntemperature = "
      "1\nintegrator = "
      "\"INTEGRATOR\"\n[[influences]]\nlaw = \"soft\"\non = \"fluid\"\nrepulsion = 25\nrange = 1\n[[diagnoses]]\nkind "
      "= "
      "\"pressure\"\n[output]\ndiagnoses = 1\ntrajectory = 9\n";
  std::string const friction =
      "[[dissipation]]\nkind = \"dpd\"\non = \"fluid\"\nconvention = \"fixed-temperature\"\ntemperature = 1\nfriction "
      "= "
      "4.5\nrange = 1\n";
  for (auto const& [integrator, more] : {std::pair<std::string, std::string>{"leap-frog", friction}, {"rk2", ""}}) {
    Case const folder("gas", std::string(gas).replace(gas.find("INTEGRATOR"), 10, integrator) + more);
    int const last = stops.back() + 20;
    ASSERT_EQ(
        bzm({"run", "gas.toml", "--quiet", "--steps", std::to_string(last), "--out", "whole"}, folder.string()).status,
        0);
    for (int const stop : stops) {
      ASSERT_EQ(bzm({"run", "gas.toml", "--quiet", "--steps", std::to_string(stop), "--out", "parts", "--force"},
                    folder.string())
                    .status,
                0);
      ASSERT_EQ(bzm({"resume", "parts", "--quiet", "--steps", std::to_string(last - stop)}, folder.string()).status, 0);
      for (auto const* file : {"diagnoses.csv", "trajectory.h5", "trajectory.h5md"})
        EXPECT_TRUE(text_of(folder / ("whole/" + std::string(file))) ==
                    text_of(folder / ("parts/" + std::string(file))))
            << integrator << ", " << file << ", stopped at step " << stop;
    }
  }
}

TEST(StoppedLate, EveryShippedScenarioIsInTheTable) {
  for (auto const& entry : fs::directory_iterator(std::string(BOLTZMANN_SOURCE) + "/scenarios")) {
    if (entry.path().extension() != ".toml") continue;
    std::string const name = entry.path().stem().string();
    EXPECT_TRUE(std::any_of(plans().begin(), plans().end(), [&](Plan const& plan) { return plan.scenario == name; }))
        << name << ": add a line to tests/cases/files/stopped_late.txt";
  }
}

}  // namespace
}  // namespace boltzmann::stopped_late_test
