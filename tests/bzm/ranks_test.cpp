// Runs on several ranks, by mpirun: the same files as on one, and ends that all ranks have together.
#include "tests/bzm/command.hpp"
#include "tests/bzm/environment.hpp"
#include "tests/bzm/same_run.hpp"

#include <chrono>
#include <optional>
#include <sstream>

namespace boltzmann::ranks_test {
namespace {

using namespace boltzmann::test;

double seconds_since(std::chrono::steady_clock::time_point since) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
}

/// Where Open MPI starts something for anybody.
struct Ranks : testing::Test {
  Folder folder;
  Environment environment;

  Ranks() {
    environment.set("OMPI_ALLOW_RUN_AS_ROOT", "1");
    environment.set("OMPI_ALLOW_RUN_AS_ROOT_CONFIRM", "1");
    environment.set("OMP_NUM_THREADS", "1");
  }

  /// What `bzm run` of a scenario that goes on for long is doing, once it has a checkpoint behind the first.
  std::vector<std::string> endless(std::string const& out) const {
    return {"run",   "three-body", "--steps", "1000000000", "--set", "output.checkpoint=200",
            "--out", out,          "--quiet", "--ranks",    "3"};
  }
  bool begun(Process& process, std::string const& out) const {
    return process.wait_until([&] { return checkpoint_step(folder / out) >= 200; });
  }
  /// The processes that write into this folder, by their command lines.
  std::vector<pid_t> ranks(std::string const& out) const {
    std::vector<pid_t> all;
    for (auto const& entry : fs::directory_iterator("/proc")) {
      pid_t const process = std::atoi(entry.path().filename().c_str());
      std::error_code gone;
      if (process <= 0 || fs::read_symlink(entry.path() / "cwd", gone) != fs::canonical(folder.string())) continue;
      std::string const words = text_of(entry.path() / "cmdline");
      if (words.rfind(bzm_words({})[0] + std::string(1, '\0') + "run", 0) == 0 && !has(words, "--ranks") &&
          has(words, out))
        all.push_back(process);
    }
    std::sort(all.begin(), all.end());
    return all;
  }
  void expect_same_files(std::string const& one, std::string const& other) const {
    for (auto const* file : {"checkpoint.h5", "trajectory.h5", "diagnoses.csv"}) {
      if (std::string(file) != "checkpoint.h5" && !fs::exists(folder / (one + "/" + file))) continue;
      EXPECT_TRUE(text_of(folder / (one + "/" + file)) == text_of(folder / (other + "/" + file)))
          << other << ": " << file;
    }
  }
  Outcome program(std::string const& what, std::string const& ranks = "3") {
    environment.set("RANKS_PROGRAM", what.c_str());
    std::string const build = BOLTZMANN_BUILD;
    environment.set("BOLTZMANN_MPI", (build + "/libboltzmann_mpi.so").c_str());
    return Process({"/bin/sh", "-c",
                    "exec mpirun --quiet --oversubscribe -n " + ranks + " " + build + "/tests/ranks_program --quiet"},
                   folder.string())
        .wait();
  }
};

struct SameFiles : Ranks, testing::WithParamInterface<char const*> {};

TEST_P(SameFiles, OnOneTwoAndThreeRanks) {
  std::vector<std::string> const plan{
      "run", GetParam(), "--steps", "12", "--set", "output.diagnoses=2", "--set", "output.trajectory=5", "--quiet"};
  auto const run = [&](std::string const& ranks, std::string const& threads) {
    environment.set("OMP_NUM_THREADS", threads.c_str());
    auto words = plan;
    words.insert(words.end(), {"--out", ranks + "x" + threads, "--ranks", ranks});
    auto const outcome = bzm(words, folder.string());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    expect_same_files("1x1", ranks + "x" + threads);
  };
  for (auto const* ranks : {"1", "2", "3"})
    for (auto const* threads : {"1", "2"}) run(ranks, threads);
  EXPECT_EQ(checkpoint_step(folder / "3x2"), 12);
}

INSTANTIATE_TEST_SUITE_P(Shipped, SameFiles,
                         testing::Values("copper", "two-stream", "sod", "active-matter", "polymer-melt"),
                         [](auto const& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST_F(Ranks, OfOneMachineTellEachOtherThroughItsMemoryUnlessToldOtherwise) {
  for (auto const* way : {"memory", "mpi"}) {
    environment.set("BOLTZMANN_MESSAGES", way);
    auto const outcome =
        bzm({"run", "sod", "--steps", "12", "--set", "output.diagnoses=2", "--quiet", "--out", way, "--ranks", "3"},
            folder.string());
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  expect_same_files("memory", "mpi");
  environment.set("BOLTZMANN_MESSAGES", "post");
  auto const refused = bzm({"run", "sod", "--ranks", "2", "--out", "post"}, folder.string());
  EXPECT_EQ(refused.status, 2);
  EXPECT_EQ(refused.err, "BOLTZMANN_MESSAGES is 'memory' or 'mpi', not 'post'\n");
}

TEST_F(Ranks, PrintOnceAndEndTogether) {
  auto const outcome = program("");
  EXPECT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_EQ(lines_in(outcome.out), 2U) << outcome.out;
  EXPECT_EQ(outcome.err, "");
  Outcome const one = program("", "1");
  EXPECT_EQ(outcome.out, one.out) << "to the last digit";
}

TEST_F(Ranks, AFailureOfOneRankIsOneLineAndTheStatusOfAll) {
  struct Case {
    char const *what, *line;
    int status;
  };
  for (auto const& [what, line, status] :
       {Case{"observer", "a file of rank 2 can't be read\n", 2},
        Case{"file", "'masses.csv' is not on this machine\n", 2}, Case{"memory", "std::bad_alloc\n", 1},
        Case{"exit", "rank 1 has ended with exit status 7\n", 7}}) {
    auto const since = std::chrono::steady_clock::now();
    auto const outcome = program(what);
    EXPECT_EQ(outcome.err, line);
    EXPECT_EQ(outcome.status, status) << what;
    EXPECT_EQ(outcome.out, "begins\n");
    EXPECT_LT(seconds_since(since), 20) << "of some 2";
  }
}

TEST_F(Ranks, ProgramsThatDifferBetweenRanksAreRefused) {
  auto outcome = program("other particles");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err.rfind("rank 1 has other particles, or other steps to do, than rank 0", 0), 0U) << outcome.err;
  EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
  outcome = program("first only");
  EXPECT_EQ(outcome.status, 2);
  EXPECT_EQ(outcome.err.rfind("rank 1 is between two runs where rank 0 prepares a run; every rank must do the same", 0),
            0U)
      << outcome.err;
  EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
}

TEST_F(Ranks, ARankThatDoesNotComeEndsTheRun) {
  environment.set("BOLTZMANN_PATIENCE", "1");
  auto const since = std::chrono::steady_clock::now();
  auto const outcome = program("late", "2");
  EXPECT_NE(outcome.status, 0);
  EXPECT_TRUE(has(outcome.err, "has waited 1 s for others")) << outcome.err;
  EXPECT_LT(seconds_since(since), 30) << "of some 3";
}

/// A launcher in the folder "launcher" that starts the real one and forwards no signal.
struct DeafLauncher {
  explicit DeafLauncher(Folder const& folder) {
    std::string const path = std::getenv("PATH");
    std::string real;
    for (std::size_t at = 0; at < path.size() && real.empty(); at = std::min(path.find(':', at), path.size()) + 1)
      if (auto const one = path.substr(at, path.find(':', at) - at) + "/mpirun"; fs::exists(one)) real = one;
    fs::create_directory(folder / "launcher");
    write_text(folder / "launcher/mpirun", "#!/bin/sh\ncase $1 in --version) exec " + real +
                                               " --version;; esac\ntrap '' INT TERM HUP USR1 USR2\n" + real +
                                               " \"$@\" &\nwait $!\n");
    fs::permissions(folder / "launcher/mpirun", fs::perms::owner_all);
    environment.set("PATH", (folder / "launcher").string() + ":" + path);
  }
  Environment environment;
};

// Kind: a stop that depends on what another program hands on. Siblings: each signal that stops a run, a launcher that
// forwards all, some or none of them, one rank that is signalled, ranks that a user has started with mpirun.
TEST_F(Ranks, EverySignalStopsARunUnderAnyLauncher) {
  for (bool const deaf : {false, true}) {
    std::optional<DeafLauncher> launcher;
    if (deaf) launcher.emplace(folder);
    for (int const signal : {SIGINT, SIGTERM, SIGHUP}) {
      std::string const out = "run-" + std::to_string(signal) + (deaf ? "-deaf" : "");
      SCOPED_TRACE(out);
      Process going(bzm_words(endless(out)), folder.string());
      ASSERT_TRUE(begun(going, out)) << going.wait().err;
      auto const since = std::chrono::steady_clock::now();
      going.signal(signal);
      auto const outcome = going.wait();
      EXPECT_LT(seconds_since(since), 10);
      EXPECT_EQ(outcome.status, 130) << outcome.err;
      EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
      EXPECT_TRUE(has(outcome.err, "stopped by a signal after step " + std::to_string(checkpoint_step(folder / out))))
          << outcome.err;
      EXPECT_TRUE(ranks(out).empty());
    }
  }
}

TEST_F(Ranks, ASecondSignalEndsAllAtOnceAlsoBehindALauncherThatForwardsNone) {
  DeafLauncher const launcher(folder);
  // A step of some seconds.
  std::vector<std::string> const plan{"run",     "plummer",   "--set", "ensembles.stars.number=60000",
                                      "--set",   "output={}", "--out", "run",
                                      "--quiet", "--ranks",   "2"};
  Process going(bzm_words(plan), folder.string());
  ASSERT_TRUE(going.wait_until([&] { return ranks("run").size() == 2; })) << going.wait().err;
  auto const since = std::chrono::steady_clock::now();
  going.signal(SIGINT);
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  going.signal(SIGINT);
  EXPECT_EQ(going.wait().status, 130);
  EXPECT_LT(seconds_since(since), 5);
  EXPECT_TRUE(ranks("run").empty());
}

// Kind: a stop right after a start. The launcher's deafness is inherited, so ranks ignore signals until they watch them.
TEST_F(Ranks, SignalsAtAnyMomentOfTheStartStopARun) {
  DeafLauncher const launcher(folder);
  for (int const wait : {0, 60, 120, 200, 300, 500}) {
    std::string const out = "run" + std::to_string(wait);
    SCOPED_TRACE(out);
    auto words = endless(out);
    Process going(bzm_words(words), folder.string());
    std::this_thread::sleep_for(std::chrono::milliseconds(wait));
    auto const since = std::chrono::steady_clock::now();
    going.signal(SIGINT);
    auto const status = going.wait().status;
    EXPECT_TRUE(status == 130 || (wait < 200 && status == 128 + SIGINT)) << status;
    EXPECT_LT(seconds_since(since), 10);
    EXPECT_TRUE(ranks(out).empty());
  }
}

TEST_F(Ranks, StartedByMpirunStopWhenOneOfThemOrTheLauncherIsSignalled) {
  auto words = endless("one");
  words.resize(words.size() - 2);
  std::string line = "exec mpirun --oversubscribe -n 3";
  for (auto const& word : bzm_words(words)) line += " " + word;
  {
    Process going({"/bin/sh", "-c", line}, folder.string());
    ASSERT_TRUE(begun(going, "one")) << going.wait().err;
    auto const all = ranks("one");
    ASSERT_EQ(all.size(), 3U);
    kill(all[1], SIGTERM);
    auto const outcome = going.wait();
    EXPECT_EQ(outcome.status, 130) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "stopped by a signal after step " + std::to_string(checkpoint_step(folder / "one"))))
        << outcome.err;
  }
  // mpirun sends SIGTERM to its ranks, and SIGKILL two seconds later; the status is its own.
  line.replace(line.find("--out one"), 9, "--out all");
  line.replace(line.find("output.checkpoint=200"), 21, "output.checkpoint=100000000");
  Process going({"/bin/sh", "-c", line}, folder.string());
  ASSERT_TRUE(going.wait_until([&] { return lines_in(text_of(folder / "all/diagnoses.csv")) > 2; }))
      << going.wait().err;
  going.signal(SIGINT);
  EXPECT_NE(going.wait().status, 0);
  EXPECT_GT(checkpoint_step(folder / "all"), 0) << "not the checkpoint of the start";
}

// Kind: ranks that do different things. Siblings: another folder, scenario, option or command on one of them, another
// program that is no rank of ours.
TEST_F(Ranks, StartedWithDifferentCommandsAreRefused) {
  std::string const bzm = bzm_words({})[0], run = bzm + " run three-body --steps 10 --quiet --out ";
  for (auto const& [one, other] : {std::pair{run + "a", run + "b"},
                                   {run + "a", run + "a --seed 2"},
                                   {run + "a", bzm + " check three-body"},
                                   {bzm + " check three-body", run + "a"},
                                   {run + "a", bzm + " run two-stream --quiet --out a"}}) {
    auto const since = std::chrono::steady_clock::now();
    auto const outcome =
        Process({"/bin/sh", "-c", "exec mpirun --quiet --oversubscribe -n 1 " + one + " : -n 1 " + other},
                folder.string())
            .wait();
    EXPECT_EQ(outcome.status, 2) << other;
    for (auto const& command : {one, other})
      EXPECT_TRUE(has(outcome.err, "'bzm " + command.substr(bzm.size() + 1) + "'")) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "; all ranks need the same command\n")) << outcome.err;
    EXPECT_LT(seconds_since(since), 20);
    EXPECT_FALSE(fs::exists(folder / "a"));
  }
  environment.set("BOLTZMANN_PATIENCE", "1");
  auto const foreign =
      Process({"/bin/sh", "-c", "exec mpirun --quiet --oversubscribe -n 1 " + run + "c : -n 1 sleep 60"},
              folder.string())
          .wait();
  EXPECT_NE(foreign.status, 0);
  EXPECT_TRUE(has(foreign.err, "rank 0 has waited 1 s for the other processes of this launch to join")) << foreign.err;
}

TEST_F(Ranks, ASignalFinishesTheStepAndAnyNumberOfRanksGoesOn) {
  Process going(bzm_words(endless("run")), folder.string());
  ASSERT_TRUE(begun(going, "run")) << going.wait().err;
  going.signal(SIGINT);
  auto const outcome = going.wait();
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
  auto const step = checkpoint_step(folder / "run");
  EXPECT_TRUE(has(outcome.err, "stopped by a signal after step " + std::to_string(step))) << outcome.err;

  auto const on = bzm({"resume", "run", "--steps", "50", "--ranks", "2", "--quiet"}, folder.string());
  ASSERT_EQ(on.status, 0) << on.err;
  auto const again = bzm({"resume", "run", "--steps", "50", "--quiet"}, folder.string());
  ASSERT_EQ(again.status, 0) << again.err;
  auto const whole = bzm({"run", "three-body", "--steps", std::to_string(step + 100), "--set", "output.checkpoint=200",
                          "--out", "whole", "--quiet"},
                         folder.string());
  ASSERT_EQ(whole.status, 0) << whole.err;
  expect_same_checkpoint(folder / "whole", folder / "run");
  for (auto const* file : {"diagnoses.csv", "trajectory.h5"})
    EXPECT_TRUE(text_of(folder / ("whole/" + std::string(file))) == text_of(folder / ("run/" + std::string(file))))
        << file;
}

TEST_F(Ranks, AKilledRankEndsAllAndTheCheckpointIsWhole) {
  for (std::size_t const which : {0U, 2U}) {
    std::string const out = "killed-" + std::to_string(which);
    Process going(bzm_words(endless(out)), folder.string());
    ASSERT_TRUE(begun(going, out)) << going.wait().err;
    auto const all = ranks(out);
    ASSERT_EQ(all.size(), 3U);
    auto const since = std::chrono::steady_clock::now();
    kill(all[which], SIGKILL);
    auto const outcome = going.wait();
    EXPECT_LT(seconds_since(since), 10);
    EXPECT_EQ(outcome.status, 128 + SIGKILL);
    EXPECT_EQ(outcome.err.rfind("a rank was ended by signal 9 (Killed)", 0), 0U) << outcome.err;
    EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
    EXPECT_TRUE(ranks(out).empty());
    EXPECT_GE(checkpoint_step(folder / out), 200);
  }
}

/// Runs of a gas, the more steps the colder, of which the hottest fails.
struct RanksOfSweep : Ranks {
  std::vector<std::string> words(std::string const& out, std::vector<std::string> const& more) const {
    std::vector<std::string> all{
        "run",    "gas.toml",           "--vary",  "ensembles.atoms.temperature=[\"60 K\", \"1e12 K\", \"120 K\"]",
        "--vary", "run.steps=" + steps, "--seeds", "2",
        "--set",  "output.pictures=[]", "--out",   out};
    all.insert(all.end(), more.begin(), more.end());
    return all;
  }
  void SetUp() override { ASSERT_EQ(bzm({"new", "gas"}, folder.string()).status, 0); }
  /// All files of the folders, each of which has as many.
  void expect_same_folders(std::string const& one, std::string const& other) const {
    std::size_t files = 0, others = 0;
    for (auto const& entry : fs::recursive_directory_iterator(folder / one)) {
      if (!entry.is_regular_file()) continue;
      auto const name = fs::relative(entry.path(), folder / one);
      EXPECT_TRUE(text_of(entry.path()) == text_of(folder / other / name)) << other << "/" << name;
      ++files;
    }
    for (auto const& entry : fs::recursive_directory_iterator(folder / other))
      others += entry.is_regular_file() ? 1 : 0;
    EXPECT_EQ(files, others);
    EXPECT_GT(files, 20U);
  }
  /// What is told of runs, but for how far all are, in the order of the lines; of a warning, which is told once of all runs,
  /// not which of them has given it first.
  static std::vector<std::string> told(std::string const& text) {
    std::istringstream stream(text);
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) {
      if (auto const warning = line.find("warning: "); warning != std::string::npos)
        line = line.substr(warning, line.find(" up to ") - warning);
      if (!has(line, " % of all, ")) lines.push_back(line);
    }
    std::sort(lines.begin(), lines.end());
    return lines;
  }

  std::string steps = "[80, 20, 40]";
};

TEST_F(RanksOfSweep, EachDoesWholeRunsWithTheSameFiles) {
  auto const one = bzm(words("all", {"--quiet"}), folder.string());
  ASSERT_EQ(one.status, 3) << one.err;
  fs::rename(folder / "all", folder / "one");
  auto const several = bzm(words("all", {"--ranks", "3"}), folder.string());
  EXPECT_EQ(several.status, 3) << several.err;
  EXPECT_TRUE(has(several.out,
                  "6 runs: 3 values of ensembles.atoms.temperature with 2 seeds; each of 3 ranks does "
                  "whole runs\n"))
      << several.out;
  EXPECT_TRUE(has(several.err, "run 6 of 6 (temperature 120 K, steps 40, seed 2) done; ")) << several.err;
  EXPECT_EQ(told(several.err), told(one.err));
  expect_same_folders("one", "all");
  // Fewer runs than ranks: all do each together.
  auto const together =
      bzm({"run", "gas.toml", "--steps", "40", "--seeds", "2", "--out", "together", "--ranks", "3"}, folder.string());
  EXPECT_TRUE(has(together.out, "2 runs: 2 seeds\n")) << together.out << together.err;
}

TEST_F(RanksOfSweep, AKilledRankOrASignalEndsAllAndAnyNumberGoesOn) {
  steps = "[12000, 20, 40]";
  std::vector<std::string> const more{"--set", "output.checkpoint=1500", "--quiet"};
  ASSERT_EQ(bzm(words("whole", more), folder.string()).status, 3);
  for (auto const signal : {SIGKILL, SIGINT}) {
    std::string const out = signal == SIGINT ? "stopped" : "killed";
    auto with_ranks = more;
    with_ranks.insert(with_ranks.end(), {"--ranks", "3"});
    Process going(bzm_words(words(out, with_ranks)), folder.string());
    ASSERT_TRUE(going.wait_until([&] {
      return checkpoint_step(folder / out / "01-temperature-60-K-steps-12000-seed-1") >= 1500 &&
             checkpoint_step(folder / out / "02-temperature-60-K-steps-12000-seed-2") >= 1500;
    })) << going.wait().err;
    auto const since = std::chrono::steady_clock::now();
    if (signal == SIGINT)
      going.signal(SIGINT);
    else
      kill(ranks(out)[1], SIGKILL);
    auto const outcome = going.wait();
    EXPECT_LT(seconds_since(since), 10);
    EXPECT_EQ(outcome.status, signal == SIGINT ? 130 : 128 + SIGKILL) << outcome.err;
    if (signal == SIGINT) {
      EXPECT_TRUE(has(outcome.err, "bzm resume stopped continues the sweep\n")) << outcome.err;
      EXPECT_TRUE(has(outcome.err, "stopped by a signal after step ")) << outcome.err;
    }
    EXPECT_TRUE(has(text_of(folder / (out + "/runs.csv")), ",waiting,"));
    EXPECT_FALSE(fs::exists(folder / (out + "/sweep.csv")));
    EXPECT_EQ(bzm({"resume", out, "--ranks", "2", "--quiet"}, folder.string()).status, 3);
    for (std::string const file : {"/sweep.csv", "/series.csv", "/01-temperature-60-K-steps-12000-seed-1/checkpoint.h5",
                                   "/06-temperature-120-K-steps-40-seed-2/trajectory.h5"})
      EXPECT_TRUE(text_of(folder / (out + file)) == text_of(folder / ("whole" + file))) << out << file;
  }
}

TEST_F(Ranks, AWindowIsServedByRankZeroAndChangesNoFile) {
  std::vector<std::string> const plan{"run", "copper", "--steps", "12", "--set", "output.trajectory=5", "--quiet"};
  auto const with = [&](std::vector<std::string> more) {
    more.insert(more.begin(), plan.begin(), plan.end());
    return bzm(more, folder.string());
  };
  ASSERT_EQ(with({"--out", "alone"}).status, 0);
  auto const shown = with({"--out", "shown", "--window", "--play", "--ranks", "2"});
  if (has(shown.err, "was built without the window")) GTEST_SKIP();
  EXPECT_EQ(shown.status, 0) << shown.err;
  EXPECT_EQ(lines_in(shown.out), 1U) << shown.out;
  EXPECT_EQ(shown.out.rfind("window: its address is in ", 0), 0U) << "who reads this may be anybody: " << shown.out;
  expect_same_files("alone", "shown");
}

TEST_F(Ranks, MistakesAndWhatIsNotThereAreToldOnce) {
  struct Case {
    std::vector<std::string> words;
    char const* line;
  };
  for (auto const& [words, line] : {Case{{"run", "three-body", "--set", "run.stp=1"}, "unknown key 'stp' in [run]"},
                                    Case{{"run", "no-such"}, "no-such"}}) {
    auto all = words;
    all.insert(all.end(), {"--ranks", "2"});
    auto const outcome = bzm(all, folder.string());
    EXPECT_EQ(outcome.status, 2);
    EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
    EXPECT_TRUE(has(outcome.err, line)) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(folder / "results"));
}

TEST_F(Ranks, ReadAScenarioFromStandardInput) {
  ASSERT_EQ(bzm({"new", "gas"}, folder.string()).status, 0);
  std::string const line = bzm_words({})[0] + " run - --steps 20 --quiet --out ";
  ASSERT_EQ(Process({"/bin/sh", "-c", line + "two --ranks 2 < gas.toml"}, folder.string()).wait().status, 0);
  ASSERT_EQ(Process({"/bin/sh", "-c", line + "one < gas.toml"}, folder.string()).wait().status, 0);
  expect_same_files("one", "two");
}

}  // namespace
}  // namespace boltzmann::ranks_test
