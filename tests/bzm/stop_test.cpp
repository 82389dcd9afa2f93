// Runs that end early: by a condition, by the clock; and scenarios from standard input.
#include "tests/bzm/command.hpp"

#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/csv.hpp>
#include <boltzmann/laws/lennard_jones.hpp>
#include <boltzmann/particles/newton.hpp>
#include <boltzmann/recording/recording.hpp>
#include <boltzmann/scenario/stop_condition.hpp>
#include <boltzmann/schemes/pair/pair_scheme.hpp>

#include <cstring>

namespace boltzmann::stop_test {
namespace {

using namespace boltzmann::test;

Checkpoint checkpoint_of(fs::path const& folder) { return read_checkpoint((folder / "checkpoint.h5").string()); }

void expect_same_state(fs::path const& one, fs::path const& other) {
  auto const a = checkpoint_of(one), b = checkpoint_of(other);
  EXPECT_EQ(a.step, b.step);
  ASSERT_EQ(a.ensembles.size(), b.ensembles.size());
  for (std::size_t e = 0; e < a.ensembles.size(); ++e) {
    ASSERT_EQ(a.ensembles[e].rows.size(), b.ensembles[e].rows.size());
    EXPECT_EQ(std::memcmp(a.ensembles[e].rows.data(), b.ensembles[e].rows.data(),
                          a.ensembles[e].rows.size() * sizeof(double)),
              0);
  }
  for (auto const* file : {"diagnoses.csv", "trajectory.h5"}) EXPECT_TRUE(text_of(one / file) == text_of(other / file));
}

// A row every 20 steps of 10 fs: the first one after 0.5 ps is that of step 60.
TEST(Stop, EndsTheRunAtARowAndChangesNothingBefore) {
  GasFolder folder;
  auto const stopped = folder.run({"--out", "stopped", "--set", "run.stop='time > 0.5 ps && temperature > 1 K'"});
  ASSERT_EQ(stopped.status, 0) << stopped.err;
  EXPECT_TRUE(has(stopped.out, "time > 0.5 ps && temperature > 1 K: true at step 60")) << stopped.out;
  EXPECT_TRUE(fs::exists(folder / "stopped/picture.png"));
  ASSERT_EQ(folder.run({"--out", "whole", "--steps", "60", "--quiet"}).status, 0);
  expect_same_state(folder / "whole", folder / "stopped");

  auto const done = bzm({"resume", "stopped"}, folder.string());
  EXPECT_EQ(done.status, 0) << done.err;
  EXPECT_TRUE(has(done.out, "has ended at step 60 (time > 0.5 ps && temperature > 1 K); --steps N continues"))
      << done.out;
  EXPECT_EQ(checkpoint_of(folder / "stopped").step, 60);
  ASSERT_EQ(bzm({"resume", "stopped", "--steps", "50", "--quiet"}, folder.string()).status, 0);
  ASSERT_EQ(bzm({"resume", "whole", "--steps", "50", "--quiet"}, folder.string()).status, 0);
  expect_same_state(folder / "whole", folder / "stopped");
}

TEST(Stop, LooksAtTheFirstRowToo) {
  GasFolder folder;
  ASSERT_EQ(folder.run({"--out", "out", "--quiet", "--set", "run.stop='step >= 0'"}).status, 0);
  EXPECT_EQ(checkpoint_of(folder / "out").step, 0);
  EXPECT_EQ(lines_in(text_of(folder / "out/diagnoses.csv")), 2U);
}

TEST(Stop, OfAResumedRunIsWhereItWouldHaveBeen) {
  GasFolder folder;
  std::vector<std::string> const plan{"--quiet", "--set", "run.stop='time > 1.1 ps'", "--set", "output.checkpoint=10"};
  auto const with = [&](std::vector<std::string> words) {
    words.insert(words.end(), plan.begin(), plan.end());
    return words;
  };
  ASSERT_EQ(folder.run(with({"--out", "whole"})).status, 0);
  EXPECT_EQ(checkpoint_of(folder / "whole").step, 120);
  ASSERT_EQ(folder.run(with({"--out", "parts", "--steps", "50"})).status, 0);
  ASSERT_EQ(bzm({"resume", "parts", "--steps", "1000", "--quiet"}, folder.string()).status, 0);
  expect_same_state(folder / "whole", folder / "parts");
}

TEST(Stop, EndsEachRunOfASweep) {
  GasFolder folder;
  auto const outcome = folder.run({"--out", "sweep", "--seeds", "2", "--set", "run.stop='time > 0.5 ps'"});
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  for (auto const* run : {"01-seed-1", "02-seed-2"})
    EXPECT_EQ(checkpoint_of(folder / ("sweep/" + std::string(run))).step, 60);
  EXPECT_FALSE(has(text_of(folder / "sweep/runs.csv"), "waiting"));
}

TEST(Hours, EndARunThatBzmResumeGoesOnWith) {
  GasFolder folder;
  auto const since = std::chrono::steady_clock::now();
  // 1.8 s. The run ends where the clock says; what it leaves must be what any run leaves.
  auto const outcome = folder.run({"--out", "out", "--steps", "1000000000", "--hours", "0.0005"});
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  EXPECT_EQ(outcome.status, 4) << outcome.err;
  EXPECT_LT(seconds, 20) << "of 1.8, and what it takes to start a process on a busy machine";
  auto const checkpoint = checkpoint_of(folder / "out");
  EXPECT_GT(checkpoint.step, 0);
  EXPECT_TRUE(has(outcome.err, "out of time after step " + std::to_string(checkpoint.step))) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "bzm resume out continues")) << outcome.err;
  EXPECT_TRUE(fs::exists(folder / "out/picture.png"));
  auto const again = bzm({"resume", "out", "--hours", "0.0001", "--quiet"}, folder.string());
  EXPECT_EQ(again.status, 4) << again.err;
  EXPECT_GT(checkpoint_of(folder / "out").step, checkpoint.step) << "each part does a step at least";
  auto const enough = bzm({"resume", "out", "--steps", "5", "--hours", "1", "--quiet"}, folder.string());
  EXPECT_EQ(enough.status, 0) << enough.err;
  auto const step = checkpoint_of(folder / "out").step;
  ASSERT_EQ(folder.run({"--out", "whole", "--quiet", "--steps", std::to_string(step)}).status, 0);
  expect_same_state(folder / "whole", folder / "out");
}

TEST(Hours, StopASweepToo) {
  GasFolder folder;
  auto const outcome = folder.run({"--out", "sweep", "--seeds", "3", "--steps", "1000000000", "--hours", "0.0003"});
  EXPECT_EQ(outcome.status, 4) << outcome.err;
  EXPECT_TRUE(has(outcome.err, "bzm resume sweep continues the sweep")) << outcome.err;
  EXPECT_EQ(bzm({"resume", "sweep", "--hours", "0.0001", "--quiet"}, folder.string()).status, 4);
}

TEST(Hours, ArePositiveAndNotForWindows) {
  GasFolder folder;
  for (auto const* hours : {"0", "-1", "soon"}) {
    auto const outcome = folder.run({"--hours", hours});
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "--hours")) << outcome.err;
  }
  EXPECT_TRUE(has(folder.run({"--hours", "1", "--window"}).err, "--hours is for runs without --window"));
  EXPECT_FALSE(fs::exists(folder / "results"));
}

struct Pair {
  Ensemble<Newton<2>> atoms{"atoms", 2};
  PairScheme scheme{Box(Vector{-5., -5.}, Vector{5., 5.}, Boundary::open), 3.0};
  Simulation simulation{scheme, 0.001};
  Pair() {
    atoms[1].position = {0., 1.5};
    scheme.internal(atoms, LennardJones{0.7, 1.4});
    simulation.integrate(atoms, Method::leap_frog);
  }
};

// Steps of 30 ms: the last one ends before the time is over, with room for another.
TEST(Hours, LeaveRoomForTheLongestStep) {
  Pair pair;
  pair.simulation.observe(1, [](Simulation const&) { std::this_thread::sleep_for(std::chrono::milliseconds(30)); });
  auto const report = run_with_progress(pair.simulation, 1000, {.quiet = true, .seconds = 0.6});
  EXPECT_TRUE(report.out_of_time);
  EXPECT_FALSE(report.interrupted);
  EXPECT_LT(report.seconds, 0.6);
  EXPECT_GE(report.steps, 1);
  auto const whole = run_with_progress(pair.simulation, 3, {.quiet = true, .seconds = 60});
  EXPECT_FALSE(whole.out_of_time);
  EXPECT_EQ(whole.steps, 3);
}

TEST(Stop, IsForPrograms) {
  Folder folder;
  Pair pair;
  Recording recording(pair.simulation, UnitSystem::reduced(), (folder / "out").string());
  recording.diagnoses(10, {"energies"});
  recording.stop_when("time > 0.05", stop_condition("time > 0.05", recording.columns(), UnitSystem::reduced()));
  auto const report = run_with_progress(recording, 1000, {.quiet = true});
  EXPECT_EQ(report.condition, "time > 0.05");
  EXPECT_EQ(report.steps, 60);
  EXPECT_EQ(recording.ended_step(), 60);
  EXPECT_EQ(read_csv((folder / "out/diagnoses.csv").string()).column("step").back(), 60);

  Pair other;
  Recording none(other.simulation, UnitSystem::reduced(), (folder / "none").string());
  none.stop_when("never", [](std::int64_t, std::span<double const>) { return false; });
  EXPECT_THROW(run_with_progress(none, 10, {.quiet = true}), Error);
}

TEST(StandardInput, IsAScenario) {
  GasFolder folder;
  auto const outcome = folder.shell("bzm run - --steps 20 < gas.toml");
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  ASSERT_EQ(folder.run({"--out", "file", "--steps", "20", "--quiet"}).status, 0);
  expect_same_state(folder / "results/stdin", folder / "file");
  EXPECT_EQ(folder.shell("sed s/2000/10/ gas.toml | bzm run - --out piped --quiet").status, 0);
  EXPECT_EQ(checkpoint_of(folder / "piped").step, 10);
  EXPECT_TRUE(has(folder.shell("bzm check - < gas.toml").out, "ok: 256 particles"));
  auto const sweep = folder.shell("bzm run - --seeds 2 --steps 10 --out sweep --quiet < gas.toml");
  EXPECT_EQ(sweep.status, 0) << sweep.err;
  EXPECT_TRUE(fs::exists(folder / "sweep/02-seed-2/diagnoses.csv"));
}

TEST(StandardInput, IsNamedInMistakes) {
  GasFolder folder;
  auto const wrong = folder.shell("sed 's/lennard-jones/lenard-jones/' gas.toml | bzm check -");
  EXPECT_EQ(wrong.status, 2);
  EXPECT_EQ(lines_in(wrong.err), 1U) << wrong.err;
  EXPECT_EQ(wrong.err.rfind("standard input:", 0), 0U) << wrong.err;
  EXPECT_TRUE(has(wrong.err, "did you mean 'lennard-jones'?")) << wrong.err;
  auto const empty = folder.shell("bzm run - < /dev/null");
  EXPECT_EQ(empty.status, 2);
  EXPECT_EQ(empty.err, "there is no scenario on standard input\n");
}

// Files that a scenario names are found from where bzm is called.
TEST(StandardInput, FindsFilesFromHere) {
  Folder folder;
  write_text(folder / "places.xyz", "2\n\nA 1 1 0\nA 3 2 0\n");
  write_text(
      folder / "in.toml",
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [5, 5]\n[run]\nstep = 0.1\nsteps = 1\n"
      "[[ensembles]]\nname = \"points\"\nclass = \"Newton\"\nload = { kind = \"file\", path = \"places.xyz\" }\n");
  auto const outcome = Process({"/bin/sh", "-c", BOLTZMANN_BUILD "/bzm check - < in.toml"}, folder.string()).wait();
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_TRUE(has(outcome.out, "ok: 2 particles")) << outcome.out;
}

}  // namespace
}  // namespace boltzmann::stop_test
