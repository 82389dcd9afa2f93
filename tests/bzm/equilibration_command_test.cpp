// Preparations and the command line: stopped in one, or run for no steps, a run goes on from a prepared state.
#include "tests/bzm/command.hpp"

#include <boltzmann/files/csv.hpp>

#include <chrono>
#include <cmath>
#include <string>

namespace boltzmann::equilibration_command_test {
namespace {

using namespace boltzmann::test;

std::string const gas = R"toml([units]
base = "reduced"
[box]
low = [0, 0]
high = [40, 40]
boundary = "periodic"
[run]
step = 0.01
steps = 40
[[ensembles]]
name = "lumps"
class = "Meso"
integrator = "leap-frog"
number = 3000
load = { kind = "random" }
heat_capacity = 20
internal_energy = { temperature = 1 }
[[dissipation]]
kind = "dpd"
on = "lumps"
convention = "constant-friction"
friction = 4.5
range = 1
[equilibrate]
temperature = 2
rate = 5
time = 20
[[diagnoses]]
kind = "temperature"
[output]
diagnoses = 10
)toml";

struct PreparationCommand : testing::Test {
  Folder folder;
  Outcome run(std::vector<std::string> const& words) const { return bzm(words, folder.string()); }
  /// A run without a stop, in "whole".
  void whole() const {
    write_text(folder / "gas.toml", gas);
    auto const begun = std::chrono::steady_clock::now();
    auto const outcome = run({"run", "gas.toml", "--out", "whole"});
    std::chrono::duration<double> const seconds = std::chrono::steady_clock::now() - begun;
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    expect_steps_timed_alone(outcome.err, seconds.count());
    double const first = read_csv((folder / "whole/diagnoses.csv").string()).column("temperature")[0];
    EXPECT_NEAR(first, 2, 6 * 2 / std::sqrt(3000.0));  // the energy of 6000 degrees of freedom
  }
  /// 2000 steps come before the 40 that are counted: these go by as fast as they are, not as if they took all the time.
  static void expect_steps_timed_alone(std::string const& told, double seconds) {
    EXPECT_NE(told.find("equilibrating\n"), std::string::npos) << told;
    auto const at = told.find("step 4 of 40, ");
    ASSERT_NE(at, std::string::npos) << told;
    EXPECT_GT(std::stod(told.substr(at + 14)) * seconds, 200) << told;
  }
  void expect_resumed() const {
    auto const resumed = run({"resume", "stopped", "--steps", "40"});
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    EXPECT_EQ(text_of(folder / "stopped/diagnoses.csv"), text_of(folder / "whole/diagnoses.csv"));
  }
};

TEST_F(PreparationCommand, CtrlCInAPreparationLeavesAPreparedState) {
  ASSERT_NO_FATAL_FAILURE(whole());
  bool in_preparation = false;
  for (int wait = 60; wait < 4000 && !in_preparation; wait *= 2) {
    Process process(bzm_words({"run", "gas.toml", "--out", "stopped", "--force"}), folder.string());
    std::this_thread::sleep_for(std::chrono::milliseconds(wait));
    process.signal(SIGINT);
    auto const stopped = process.wait();
    in_preparation = stopped.status == 130 && stopped.err.find("after step 0;") != std::string::npos;
  }
  ASSERT_TRUE(in_preparation);
  expect_resumed();
}

TEST_F(PreparationCommand, ARunOfNoStepsIsPrepared) {
  ASSERT_NO_FATAL_FAILURE(whole());
  EXPECT_EQ(run({"run", "gas.toml", "--out", "stopped", "--steps", "0"}).status, 0);
  expect_resumed();
}

TEST_F(PreparationCommand, KilledInAPreparationThereIsNothingToResume) {
  ASSERT_NO_FATAL_FAILURE(whole());
  bool ended = true;
  for (int wait = 100; ended && wait > 0; wait /= 2) {
    Process process(bzm_words({"run", "gas.toml", "--out", "stopped", "--force"}), folder.string());
    std::this_thread::sleep_for(std::chrono::milliseconds(wait));
    process.signal(SIGKILL);
    process.wait();
    ended = fs::exists(folder / "stopped/checkpoint.h5");
  }
  ASSERT_FALSE(ended) << "the equilibration had ended";
  auto const resumed = run({"resume", "stopped"});
  EXPECT_EQ(resumed.status, 2);
  EXPECT_EQ(lines_in(resumed.err), 1U) << resumed.err;
  EXPECT_EQ(run({"run", "gas.toml", "--out", "stopped", "--force"}).status, 0);
  EXPECT_EQ(text_of(folder / "stopped/diagnoses.csv"), text_of(folder / "whole/diagnoses.csv"));
}

}  // namespace
}  // namespace boltzmann::equilibration_command_test
