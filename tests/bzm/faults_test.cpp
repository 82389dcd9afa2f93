// Faults without end: a run that is killed, stopped, hung up, started twice, without a place for its words or its files
// leaves, when it has come to its end, what a run without any of that leaves; and on the way all that it has is whole.
#include "tests/bzm/command.hpp"
#include "tests/bzm/same_run.hpp"

#include <boltzmann/files/csv.hpp>
#include <tests/seed.hpp>

#include <random>

namespace boltzmann::faults_test {
namespace {

using namespace boltzmann::test;

constexpr char const* scenario = R"toml(
title = "Warm discs"
[units]
base = "reduced"
[box]
low = [0, 0]
high = [20, 20]
boundary = "periodic"
[run]
step = 0.002
steps = 60_000
cutoff = 2.5
seed = 3
[[ensembles]]
name = "discs"
class = "Newton"
integrator = "leap-frog"
mass = 1
load = { kind = "block", lattice = "square", spacing = 1.4, counts = [12, 12] }
temperature = 1
[[influences]]
law = "lennard-jones"
on = "discs"
depth = 1
r0 = 1.12246
[[diagnoses]]
kind = "energies"
[[diagnoses]]
kind = "diffusion"
[output]
diagnoses = 50
trajectory = 500
checkpoint = 1000
[[output.pictures]]
colour = "speed"
)toml";

class Faults : public testing::Test {
 protected:
  Folder folder;
  std::mt19937_64 random{test_seed(1)};

  double uniform(double low, double high) { return std::uniform_real_distribution(low, high)(random); }
  static std::string command(std::vector<std::string> const& words) {
    std::string line;
    for (auto const& word : bzm_words(words)) line += (line.empty() ? "" : " ") + word;
    return line;
  }
  /// Whether there is a checkpoint to go on from.
  bool begun() const { return checkpoint_step(folder / "run") >= 0; }
  std::vector<std::string> next() const {
    if (begun()) return {"resume", "run", "--quiet"};
    return {"run", "discs.toml", "--out", "run", "--force", "--quiet"};
  }
  /// All that stands in the folder can be read.
  void expect_whole() const {
    if (!begun()) return;
    auto const step = checkpoint_step(folder / "run");
    TrajectoryReader const reader((folder / "run/trajectory.h5").string());
    ASSERT_GE(reader.frames(), static_cast<std::size_t>(step / 500 + 1));
    for (std::size_t frame = 0; frame < reader.frames(); ++frame) try {
        for (double const x : reader.read(frame, "discs", "position")) ASSERT_TRUE(std::isfinite(x));
      } catch (Error const& error) {
        // One that was being written when the run was killed or failed, which says so.
        ASSERT_GT(frame, static_cast<std::size_t>(step / 500)) << error.what();
      }
    auto const rows = read_csv((folder / "run/diagnoses.csv").string()).column("step");
    ASSERT_GE(rows.size(), static_cast<std::size_t>(step / 50 + 1));
    for (std::size_t r = 0; r < rows.size(); ++r) ASSERT_EQ(rows[r], 50.0 * static_cast<double>(r));
  }
  static void wait(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }
};

TEST_F(Faults, LeaveWhatARunWithoutThemLeaves) {
  write_text(folder / "discs.toml", scenario);
  auto const start = std::chrono::steady_clock::now();
  ASSERT_EQ(bzm({"run", "discs.toml", "--out", "whole", "--quiet"}, folder.string()).status, 0);
  double const whole = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  std::array<int, 6> seen{};
  bool done = false;
  int turns = 0;
  for (; !done && turns < 60; ++turns) {
    // Most turns do a part of the run, so that there are many; the last ones do all.
    double const seconds = turns < 40 ? uniform(0, 0.08 * whole) : 4 * whole;
    int const fault = turns < 40 ? std::uniform_int_distribution(0, 5)(random) : 0;
    ++seen[static_cast<std::size_t>(fault)];
    SCOPED_TRACE("turn " + std::to_string(turns) + ", fault " + std::to_string(fault));
    if (fault <= 1) {  // killed
      Process process(bzm_words(next()), folder.string());
      process.wait_until([end = std::chrono::steady_clock::now() + std::chrono::duration<double>(seconds)] {
        return std::chrono::steady_clock::now() > end;
      });
      process.signal(SIGKILL);
      int const status = process.wait().status;
      ASSERT_TRUE(status == 0 || status == 128 + SIGKILL) << status;
    } else if (fault == 2) {  // stopped
      int const signal = std::array{SIGINT, SIGTERM, SIGHUP}[random() % 3];
      Process process(bzm_words(next()), folder.string());
      wait(seconds + 0.1);
      process.signal(signal);
      auto const outcome = process.wait();
      // Before it listens, a signal ends it at once.
      ASSERT_TRUE(outcome.status == 0 || outcome.status == 130 || outcome.status == 128 + signal)
          << outcome.status << outcome.err;
    } else if (fault == 3) {  // started twice
      auto const words = next();
      Process one(bzm_words(words), folder.string()), other(bzm_words(words), folder.string());
      wait(seconds);
      one.signal(SIGKILL);
      wait(0.02);
      other.signal(SIGKILL);
      for (auto const& outcome : {one.wait(), other.wait()})
        if (outcome.status == 2) {
          EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
          EXPECT_NE(outcome.err.find("another process is writing"), std::string::npos) << outcome.err;
        } else
          ASSERT_TRUE(outcome.status == 0 || outcome.status == 128 + SIGKILL) << outcome.status << outcome.err;
    } else if (fault == 4) {  // nowhere to say anything
      Process process({"/bin/sh", "-c", "exec " + command(next()) + " >&- 2>&- <&-"}, folder.string());
      wait(seconds);
      process.signal(SIGKILL);
      process.wait();
    } else {  // a disk that takes no more: files end at so many blocks, or hardly grow
      std::error_code none;
      auto const there = fs::exists(folder / "run/trajectory.h5", none) && seen[5] % 2 == 0
                             ? static_cast<double>(fs::file_size(folder / "run/trajectory.h5")) / 512
                             : 0;
      auto const blocks = std::to_string(static_cast<int>(there + uniform(1, 300)));
      Process process({"/bin/sh", "-c", "trap '' XFSZ; ulimit -f " + blocks + "; exec " + command(next())},
                      folder.string());
      wait(seconds + 0.1);
      process.signal(SIGTERM);
      auto const outcome = process.wait();
      ASSERT_TRUE(outcome.status == 0 || outcome.status == 1 || outcome.status == 2 || outcome.status == 130 ||
                  outcome.status == 128 + SIGTERM)
          << outcome.status << outcome.err;
    }
    try {
      expect_whole();
    } catch (std::exception const& error) {
      FAIL() << error.what();
    }
    if (HasFatalFailure()) return;
    done = checkpoint_step(folder / "run") == 60'000;
  }
  ASSERT_TRUE(done) << "not at its end after " << turns << " turns";
  // Once more in peace: the last kill may have met it after its checkpoint and before its pictures.
  auto const last = bzm(next(), folder.string());
  ASSERT_EQ(last.status, 0) << last.err;
  expect_same_checkpoint(folder / "whole", folder / "run");
  expect_same_trajectory(folder / "whole", folder / "run");
  for (char const* file : {"diagnoses.csv", "picture.png", "scenario.toml"})
    EXPECT_EQ(text_of(folder / "whole" / file), text_of(folder / "run" / file)) << file;
  std::printf("%d turns: %d killed, %d stopped, %d twice, %d without a place for words, %d for files\n", turns,
              seen[0] + seen[1], seen[2], seen[3], seen[4], seen[5]);
}

}  // namespace
}  // namespace boltzmann::faults_test
