// Runs without a terminal: closed descriptors, a lost connection, nohup; and the last state of a run that stops
// anywhere.
#include "tests/bzm/command.hpp"

#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/trajectory.hpp>

namespace boltzmann::lost_terminal_test {
namespace {

using namespace boltzmann::test;

std::vector<std::int64_t> steps_of(fs::path const& folder) {
  return TrajectoryReader((folder / "trajectory.h5").string()).steps();
}

TEST(LostTerminal, ClosedDescriptorsDestroyNothing) {
  Folder folder;
  ASSERT_EQ(bzm({"run", "three-body", "--steps", "1000", "--out", "whole"}, folder.string()).status, 0);
  int number = 0;
  for (std::string const closed : {">&- 2>&-", "2>&-", ">&-", "<&-", "<&- >&- 2>&-"}) {
    std::string const out = "run-" + std::to_string(number++);
    std::string const line = bzm_words({""})[0] + " run three-body --steps 1000 --out " + out + " " + closed;
    EXPECT_EQ(Process({"/bin/sh", "-c", line}, folder.string()).wait().status, 0) << closed;
    for (auto const* file : {"diagnoses.csv", "trajectory.h5", "checkpoint.h5", "scenario.toml", "picture.png"})
      EXPECT_EQ(text_of(folder / ("whole/" + std::string(file))), text_of(folder / (out + "/" + file)))
          << file << " " << closed;
  }
}

TEST(LostTerminal, AHangUpWritesTheCheckpoint) {
  Folder folder;
  Process going(bzm_words({"run", "three-body", "--steps", "4000000", "--out", "three"}), folder.string());
  // The checkpoint of the start is there before the first step is done.
  ASSERT_TRUE(going.wait_until([&] {
    return fs::exists(folder / "three/checkpoint.h5") && lines_in(text_of(folder / "three/diagnoses.csv")) > 2;
  }));
  going.signal(SIGHUP);
  auto const stopped = going.wait();
  EXPECT_EQ(stopped.status, 130) << stopped.err;
  EXPECT_NE(stopped.err.find("its checkpoint is written"), std::string::npos) << stopped.err;
  std::int64_t const step = read_checkpoint((folder / "three/checkpoint.h5").string()).step;
  EXPECT_GT(step, 0);
  EXPECT_EQ(steps_of(folder / "three").back(), step) << "the last state is in the trajectory";
}

TEST(LostTerminal, NohupGoesOn) {
  Folder folder;
  std::string const line = "trap '' HUP; exec " + bzm_words({""})[0] + " run three-body --steps 30000 --out three";
  Process going({"/bin/sh", "-c", line}, folder.string());
  ASSERT_TRUE(going.wait_until([&] { return fs::exists(folder / "three/checkpoint.h5"); }));
  going.signal(SIGHUP);
  EXPECT_EQ(going.wait().status, 0);
}

TEST(LastState, IsInTheTrajectoryAndGoesWhenTheRunGoesOn) {
  Folder folder;
  auto const run = [&](std::vector<std::string> const& words) {
    auto const outcome = bzm(words, folder.string());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
  };
  run({"run", "three-body", "--out", "whole", "--steps", "450", "--set", "output.trajectory=100"});
  EXPECT_EQ(steps_of(folder / "whole"), (std::vector<std::int64_t>{0, 100, 200, 300, 400, 450}));
  run({"run", "three-body", "--out", "parts", "--steps", "250", "--set", "output.trajectory=100"});
  EXPECT_EQ(steps_of(folder / "parts"), (std::vector<std::int64_t>{0, 100, 200, 250}));
  run({"resume", "parts", "--steps", "150"});
  EXPECT_EQ(steps_of(folder / "parts"), (std::vector<std::int64_t>{0, 100, 200, 300, 400}));
  run({"resume", "parts", "--steps", "50"});
  EXPECT_EQ(steps_of(folder / "parts"), steps_of(folder / "whole"));
}

}  // namespace
}  // namespace boltzmann::lost_terminal_test
