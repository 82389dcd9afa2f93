// Kind: what a run leaves in its folder when it ends in another way than usual. Siblings: a kill before the first
// checkpoint, a kill while a window is open, a resume that has nothing to do, files that are views of others.
#include "tests/cases/case.hpp"

#include "tests/bzm/same_run.hpp"

#include <map>

namespace boltzmann::left_behind_test {
namespace {

using namespace boltzmann::test;

/// Every file of a folder.
std::map<std::string, std::string> files_of(fs::path const& folder) {
  std::map<std::string, std::string> all;
  for (auto const& entry : fs::directory_iterator(folder))
    all[entry.path().filename().string()] = text_of(entry.path());
  return all;
}

void expect_same_files(fs::path const& one, fs::path const& other, std::vector<std::string> const& names) {
  for (auto const& name : names) EXPECT_TRUE(text_of(one / name) == text_of(other / name)) << name;
}

TEST(LeftBehind, AResumeWithNothingToDoChangesNothingWithAWindowToo) {
  GasFolder folder;
  ASSERT_EQ(folder.run({"--steps", "30", "--quiet", "--out", "out", "--set", "output.trajectory=7"}).status, 0);
  auto const before = files_of(folder / "out");
  for (auto const& more : {std::vector<std::string>{}, {"--window", "--play"}}) {
    auto words = std::vector<std::string>{"resume", "out", "--quiet"};
    words.insert(words.end(), more.begin(), more.end());
    auto const outcome = bzm(words, folder.string());
    if (has(outcome.err, "was built without the window")) continue;
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(files_of(folder / "out") == before) << more.size();
  }
}

TEST(LeftBehind, TheViewOfATrajectoryHasTheSameBytesAfterAnyResume) {
  GasFolder folder;
  std::vector<std::string> const plan{"--quiet", "--set", "output.trajectory=3", "--set", "run.step='1.7 fs'"};
  auto const run = [&](std::vector<std::string> words) {
    words.insert(words.end(), plan.begin(), plan.end());
    ASSERT_EQ(folder.run(words).status, 0);
  };
  run({"--steps", "40", "--out", "whole"});
  for (auto const* first : {"3", "16", "24", "31", "40"}) {
    run({"--steps", first, "--out", "out", "--force"});
    ASSERT_EQ(
        bzm({"resume", "out", "--steps", std::to_string(40 - std::stoi(first)), "--quiet"}, folder.string()).status, 0);
    expect_same_files(folder / "whole", folder / "out", {"trajectory.h5", "trajectory.h5md", "diagnoses.csv"});
  }
}

TEST(LeftBehind, ARunThatWasKilledBeforeItsFirstCheckpointIsResumedFromTheStart) {
  GasFolder folder;
  ASSERT_EQ(folder.run({"--steps", "30", "--quiet", "--out", "whole"}).status, 0);
  // What is there after a kill at each moment before the checkpoint.
  for (int moment = 0; moment < 3; ++moment) {
    fs::remove_all(folder / "out");
    fs::create_directory(folder / "out");
    fs::copy(folder / "whole/scenario.toml", folder / "out/scenario.toml");
    if (moment > 0) write_text(folder / "out/diagnoses.csv", "step,time (");
    if (moment > 1) write_text(folder / "out/trajectory.h5", "");
    auto const outcome = bzm({"resume", "out"}, folder.string());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_TRUE(has(outcome.out, "it was stopped before its first checkpoint; it starts again at step 0\n"))
        << outcome.out;
    expect_same_checkpoint(folder / "whole", folder / "out");
    expect_same_files(folder / "whole", folder / "out", {"trajectory.h5", "diagnoses.csv", "scenario.toml"});
  }
  // Results of later steps are not given up for that.
  fs::remove(folder / "out/checkpoint.h5");
  fs::remove(folder / "out/checkpoint.h5.previous");
  auto const before = files_of(folder / "out");
  auto const refused = bzm({"resume", "out"}, folder.string());
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(lines_in(refused.err), 1U) << refused.err;
  EXPECT_TRUE(has(refused.err, "'out' has results but no checkpoint.h5 to continue from")) << refused.err;
  EXPECT_TRUE(files_of(folder / "out") == before);
}

TEST(LeftBehind, TheAddressOfAWindowThatWasKilledIsGone) {
  GasFolder folder;
  for (bool const resumed : {true, false}) {
    Process going(bzm_words({"run", "gas.toml", "--steps", "1000000000", "--out", "out", "--quiet", "--force",
                             "--window", "--play"}),
                  folder.string());
    if (!going.wait_until(
            [&] { return fs::exists(folder / "out/window.txt") && checkpoint_step(folder / "out") >= 0; })) {
      ASSERT_TRUE(has(going.wait().err, "was built without the window"));
      GTEST_SKIP();
    }
    going.signal(SIGKILL);
    going.wait();
    ASSERT_TRUE(fs::exists(folder / "out/window.txt"));
    auto const after = resumed ? bzm({"resume", "out", "--steps", "5", "--quiet"}, folder.string())
                               : folder.run({"--steps", "5", "--out", "out", "--force", "--quiet"});
    EXPECT_EQ(after.status, 0) << after.err;
    EXPECT_FALSE(fs::exists(folder / "out/window.txt"));
  }
}

}  // namespace
}  // namespace boltzmann::left_behind_test
