// Restarts: a run that was killed and resumed leaves, to the last bit, what a run without a stop leaves.
#include "tests/bzm/command.hpp"
#include "tests/bzm/same_run.hpp"

#include <boltzmann/files/csv.hpp>

namespace boltzmann::resume_test {
namespace {

using namespace boltzmann::test;

/// A folder with a scenario of its own, gas.toml.
struct GasFolder : Folder {
  GasFolder() { EXPECT_EQ(bzm({"new", "gas"}, string()).status, 0); }
};

class KilledAndResumed : public testing::TestWithParam<std::tuple<std::string, std::string>> {};

TEST_P(KilledAndResumed, LeavesWhatARunWithoutAStopLeaves) {
  auto const& [scenario, threads] = GetParam();
  Folder folder;
  std::vector<std::string> plan{"--set",  "output.diagnoses=10",  "--set",     "output.trajectory=20",
                                "--set",  "output.checkpoint=50", "--threads", threads,
                                "--quiet"};
  bool const on_mesh =
      text_of(fs::path(BOLTZMANN_SOURCE) / "scenarios" / (scenario + ".toml")).find("\n[mesh]") != std::string::npos;
  if (on_mesh) plan.insert(plan.end(), {"--set", "output.mesh=25"});
  auto const with = [&](std::vector<std::string> words) {
    words.insert(words.end(), plan.begin(), plan.end());
    return words;
  };
  Process process(bzm_words(with({"run", scenario, "--steps", "1000000000", "--out", "stopped"})), folder.string());
  ASSERT_TRUE(process.wait_until([&] { return checkpoint_step(folder / "stopped") >= 100; })) << process.wait().err;
  process.signal(SIGKILL);
  EXPECT_EQ(process.wait().status, 128 + SIGKILL);
  std::int64_t const stopped_at = checkpoint_step(folder / "stopped");
  ASSERT_GE(stopped_at, 100);

  auto const resumed = bzm({"resume", "stopped", "--steps", "70", "--threads", threads, "--quiet"}, folder.string());
  ASSERT_EQ(resumed.status, 0) << resumed.err;
  auto const whole =
      bzm(with({"run", scenario, "--steps", std::to_string(stopped_at + 70), "--out", "whole"}), folder.string());
  ASSERT_EQ(whole.status, 0) << whole.err;

  expect_same_checkpoint(folder / "whole", folder / "stopped");
  if (fs::exists(folder / "whole/diagnoses.csv")) {
    EXPECT_EQ(text_of(folder / "whole/diagnoses.csv"), text_of(folder / "stopped/diagnoses.csv"));
    EXPECT_EQ(lines_in(text_of(folder / "whole/diagnoses.csv")), 2 + static_cast<std::size_t>(stopped_at + 70) / 10);
  }
  expect_same_trajectory(folder / "whole", folder / "stopped");
  EXPECT_TRUE(text_of(folder / "whole/trajectory.h5") == text_of(folder / "stopped/trajectory.h5"));
  if (on_mesh) expect_same_mesh_frames(folder / "whole", folder / "stopped");
}

INSTANTIATE_TEST_SUITE_P(Shipped, KilledAndResumed,
                         testing::Combine(testing::Values("copper", "rod", "three-body", "pythagorean", "cylinder",
                                                          "atmosphere", "two-stream", "langmuir", "electron-gas-2d",
                                                          "molten-salt", "dam-break", "convection", "penetration",
                                                          "sod", "active-matter"),
                                          testing::Values("1", "2")),
                         [](auto const& info) {
                           std::string name = std::get<0>(info.param) + "_" + std::get<1>(info.param);
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Threads, OneAndTwoGiveTheSameBits) {
  GasFolder folder;
  for (auto const* threads : {"1", "2"})
    ASSERT_EQ(
        bzm({"run", "gas.toml", "--steps", "40", "--threads", threads, "--out", threads, "--quiet"}, folder.string())
            .status,
        0);
  expect_same_checkpoint(folder / "1", folder / "2");
}

TEST(Resume, TypedDiagnosesGoOnWithTheSameBitsOnAnyThreads) {
  GasFolder folder;
  std::string const typed =
      "diagnoses=[{ kind = 'formula', label = 'order', formula = 'norm(mean(velocity))/mean(speed)' }, { kind = "
      "'formula', "
      "label = 'spread', formula = 'sqrt(mean(v2) - dot(mean(velocity), mean(velocity)))', where = { v2 = "
      "'dot(velocity, velocity)' } }, { kind = "
      "'histogram', label = 'speeds', formula = 'speed', from = 0, to = 3, count = 6 }]";
  auto const run = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--quiet"});
    auto const outcome = bzm(words, folder.string());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  };
  std::vector<std::string> const plan{"--set", typed, "--set", "output.diagnoses=5", "--set", "output.pictures=[]"};
  auto const with = [&](std::vector<std::string> words) {
    words.insert(words.end(), plan.begin(), plan.end());
    return words;
  };
  run(with({"run", "gas.toml", "--steps", "40", "--threads", "1", "--out", "whole"}));
  run(with({"run", "gas.toml", "--steps", "25", "--threads", "2", "--out", "stopped"}));
  run({"resume", "stopped", "--steps", "15", "--threads", "2"});
  std::string const whole = text_of(folder / "whole/diagnoses.csv");
  EXPECT_EQ(whole, text_of(folder / "stopped/diagnoses.csv"));
  EXPECT_NE(whole.find("spread"), std::string::npos);
  EXPECT_NE(whole.find("speeds"), std::string::npos);
}

TEST(Interrupt, FinishesTheStepWritesTheCheckpointAndCanBeResumed) {
  for (int const signal : {SIGINT, SIGTERM}) {
    GasFolder folder;
    Process process(
        bzm_words({"run", "gas.toml", "--steps", "1000000000", "--out", "out", "--set", "output.checkpoint=1000000"}),
        folder.string());
    ASSERT_TRUE(process.wait_until([&] { return lines_in(text_of(folder / "out/diagnoses.csv")) > 3; }));
    process.signal(signal);
    auto const outcome = process.wait();
    EXPECT_EQ(outcome.status, 130);
    std::int64_t const step = checkpoint_step(folder / "out");
    EXPECT_GT(step, 0) << "the last step, not the checkpoint from the start";
    EXPECT_NE(outcome.err.find("stopped by a signal after step " + std::to_string(step)), std::string::npos)
        << outcome.err;
    EXPECT_TRUE(fs::exists(folder / "out/picture.png"));
    auto const resumed = bzm({"resume", "out", "--steps", "5"}, folder.string());
    EXPECT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_EQ(checkpoint_step(folder / "out"), step + 5);
  }
}

TEST(Resume, GoesToThePlannedStepAndSaysWhenItIsThere) {
  GasFolder folder;
  ASSERT_EQ(bzm({"run", "gas.toml", "--steps", "30", "--out", "out", "--quiet"}, folder.string()).status, 0);
  auto const there = bzm({"resume", "out"}, folder.string());
  EXPECT_EQ(there.status, 0);
  EXPECT_NE(there.out.find("already at its last step, 30"), std::string::npos) << there.out;
  EXPECT_EQ(checkpoint_step(folder / "out"), 30);
  EXPECT_EQ(bzm({"resume", "out", "--steps", "12", "--quiet"}, folder.string()).status, 0);
  EXPECT_EQ(checkpoint_step(folder / "out"), 42);
}

TEST(Resume, RefusesWhatIsNoWholeCheckpointOfOurs) {
  GasFolder folder;
  ASSERT_EQ(bzm({"run", "gas.toml", "--steps", "10", "--out", "out", "--quiet"}, folder.string()).status, 0);
  auto const path = folder / "out/checkpoint.h5";
  std::string const good = text_of(path);
  auto const expect_refused = [&](std::string const& bytes) {
    write_text(path, bytes);
    auto const outcome = bzm({"resume", "out", "--steps", "5"}, folder.string());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find("checkpoint.h5"), std::string::npos) << outcome.err;
    EXPECT_EQ(text_of(path), bytes) << "a refused checkpoint stays as it is";
  };
  expect_refused(good.substr(0, good.size() / 2));
  expect_refused(good.substr(0, 100));
  expect_refused("");
  expect_refused("no checkpoint at all\n");
  std::string damaged = good;
  damaged[damaged.size() - 100] ^= 1;
  expect_refused(damaged);
  std::string foreign = good;  // the same file, as another version of the format would begin
  auto const digit = foreign.find_first_of("0123456789");
  ASSERT_LT(digit, 200U);
  foreign[digit] = '9';
  expect_refused(foreign);
  write_text(path, good);
  EXPECT_EQ(bzm({"resume", "out", "--steps", "5", "--quiet"}, folder.string()).status, 0);
}

TEST(Resume, RefusesFilesThatAreNotThoseOfTheCheckpoint) {
  GasFolder folder;
  auto const run = [&](std::string const& out, std::string const& seed) {
    ASSERT_EQ(bzm({"run", "gas.toml", "--steps", "40", "--seed", seed, "--out", out, "--quiet", "--set",
                   "output.trajectory=10", "--set", "output.diagnoses=10"},
                  folder.string())
                  .status,
              0);
  };
  run("out", "1");
  run("other", "2");
  auto const expect_refused = [&](std::string const& file, std::string const& told) {
    std::string const before = text_of(folder / "out" / file);
    auto const outcome = bzm({"resume", "out", "--steps", "5"}, folder.string());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find(file + ": " + told), std::string::npos) << outcome.err;
    EXPECT_EQ(text_of(folder / "out" / file), before) << "nothing is cut off";
  };
  for (std::string const file : {"diagnoses.csv", "trajectory.h5"}) {
    std::string const own = text_of(folder / "out" / file);
    std::string const told =
        file == "diagnoses.csv" ? "its rows up to step 40 are not" : "its frames up to step 40 are not";
    fs::copy_file(folder / "other" / file, folder / "out" / file, fs::copy_options::overwrite_existing);
    expect_refused(file, told);
    write_text(folder / "out" / file, own);
  }
  std::string const rows = text_of(folder / "out/diagnoses.csv");
  std::string edited = rows;
  char& digit = edited[edited.find_last_of("123456789")];
  digit = digit == '9' ? '1' : '9';
  for (std::string const& text : {edited, rows.substr(0, rows.rfind('\n', rows.size() - 2) + 1)}) {
    write_text(folder / "out/diagnoses.csv", text);
    expect_refused("diagnoses.csv", "its rows up to step 40 are not");
  }
  write_text(folder / "out/diagnoses.csv", rows);
  EXPECT_EQ(bzm({"resume", "out", "--steps", "5", "--quiet"}, folder.string()).status, 0);
  // And the other way round: a checkpoint of another run, of the same names.
  fs::copy_file(folder / "other/checkpoint.h5", folder / "out/checkpoint.h5", fs::copy_options::overwrite_existing);
  EXPECT_EQ(bzm({"resume", "out", "--steps", "5"}, folder.string()).status, 2);
}

TEST(Resume, ADamagedTrajectoryIsOneLine) {
  GasFolder folder;
  ASSERT_EQ(bzm({"run", "gas.toml", "--steps", "20", "--out", "out", "--quiet", "--set", "output.trajectory=10"},
                folder.string())
                .status,
            0);
  auto const path = folder / "out/trajectory.h5";
  std::string const good = text_of(path);
  int told = 0;
  for (std::size_t at = 40; at + 3000 < good.size(); at += good.size() / 16) {
    std::string damaged = good;
    for (std::size_t k = at; k < at + 3000; ++k) damaged[k] = static_cast<char>(damaged[k] ^ 0x55);
    write_text(path, damaged);
    fs::remove(folder / "a.xyz");
    auto const outcome = bzm({"export", "out", "-o", "a.xyz"}, folder.string());
    if (outcome.status == 0) continue;  // nothing that counts stood there
    ++told;
    EXPECT_EQ(outcome.status, 2) << at;
    EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
    EXPECT_NE(outcome.err.find("trajectory.h5"), std::string::npos) << outcome.err;
  }
  EXPECT_GT(told, 3);
}

TEST(Resume, NeedsAFolderWithARun) {
  Folder folder;
  auto const missing = bzm({"resume", "nowhere"}, folder.string());
  EXPECT_EQ(missing.status, 2);
  EXPECT_NE(missing.err.find("nowhere"), std::string::npos);
  fs::create_directory(folder / "empty");
  auto const empty = bzm({"resume", "empty"}, folder.string());
  EXPECT_EQ(empty.status, 2);
  EXPECT_NE(empty.err.find("empty/checkpoint.h5"), std::string::npos) << empty.err;
}

}  // namespace
}  // namespace boltzmann::resume_test
