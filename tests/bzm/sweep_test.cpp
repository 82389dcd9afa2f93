// Sweeps: the tables are those of separate runs, whether the sweep was stopped or not; what fails and what is wrong.
#include "tests/bzm/command.hpp"

#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/csv.hpp>

#include <cmath>

namespace boltzmann::sweep_test {
namespace {

using namespace boltzmann::test;
using Words = std::vector<std::string>;

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
steps = 60
cutoff = 8.5
seed = 5
[[ensembles]]
name = "atoms"
class = "Newton"
load = { kind = "block", lattice = "square", spacing = 5, counts = [10, 10], origin = "centred" }
mass = 40
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
diagnoses = 10
trajectory = 20
checkpoint = 20
)toml";

std::string const sweep = R"toml([sweep]
seeds = 3
table = ["temperature", "potential energy"]
[sweep.vary]
ensembles.atoms.temperature = ["100 K", "200 K", "400 K"]
[[sweep.pictures]]
y = "kinetic energy"
fit = "line"
[[sweep.pictures]]
drawing = "time-series"
y = "temperature"
)toml";

struct Sweep : testing::Test {
  Folder folder;
  Outcome run(Words const& words) const { return bzm(words, folder.string()); }
  void write(std::string const& text) const { write_text(folder / "gas.toml", text); }
  std::string path(std::string const& name) const { return (folder / name).string(); }
};

/// The mean and its standard error, as textbooks have them.
std::pair<double, double> mean_of(std::vector<double> const& x) {
  double sum = 0, squares = 0;
  for (double const v : x) sum += v, squares += v * v;
  auto const n = static_cast<double>(x.size());
  return {sum / n, std::sqrt((squares - sum * sum / n) / (n - 1) / n)};
}

TEST_F(Sweep, HasTheMeansAndErrorsOfSeparateRuns) {
  write(gas + sweep);
  auto const done = run({"run", "gas.toml", "--out", "all"});
  ASSERT_EQ(done.status, 0) << done.err;
  write_text(folder / "one.toml", gas);
  auto const table = read_csv(path("all/sweep.csv"));
  auto const series = read_csv(path("all/series.csv"));
  ASSERT_EQ(table.columns[0], (std::vector<double>{100, 200, 400}));
  EXPECT_EQ(table.column("runs"), (std::vector<double>{3, 3, 3}));
  Words const temperatures{"100 K", "200 K", "400 K"};
  std::size_t number = 0;
  for (std::size_t v = 0; v < 3; ++v) {
    std::vector<double> last_temperature, last_energy, third_temperature;
    for (int seed = 5; seed < 8; ++seed) {
      std::string const out = "alone" + std::to_string(++number);
      auto const alone = run({"run", "one.toml", "--set", "ensembles.atoms.temperature=" + temperatures[v], "--seed",
                              std::to_string(seed), "--out", out, "--quiet"});
      ASSERT_EQ(alone.status, 0) << alone.err;
      std::string const same = "all/0" + std::to_string(number) + "-temperature-" + temperatures[v].substr(0, 3) +
                               "-K-seed-" + std::to_string(seed);
      EXPECT_EQ(text_of(folder / (same + "/diagnoses.csv")), text_of(folder / (out + "/diagnoses.csv")));
      EXPECT_EQ(text_of(folder / (same + "/scenario.toml")), text_of(folder / (out + "/scenario.toml")));
      auto const rows = read_csv(path(out + "/diagnoses.csv"));
      last_temperature.push_back(rows.column("temperature (K)").back());
      third_temperature.push_back(rows.column("temperature (K)")[2]);
      last_energy.push_back(rows.column("potential energy (amu angstrom^2/ps^2)").back());
    }
    auto const [mean, error] = mean_of(last_temperature);
    EXPECT_NEAR(table.column("temperature (K)")[v], mean, 1e-9 * mean);
    EXPECT_NEAR(table.column("temperature error (K)")[v], error, 1e-6 * error);
    EXPECT_GT(error, 0);
    auto const [energy, scatter] = mean_of(last_energy);
    EXPECT_NEAR(table.column("potential energy (amu angstrom^2/ps^2)")[v], energy, 1e-9 * std::abs(energy));
    EXPECT_NEAR(table.column("potential energy error (amu angstrom^2/ps^2)")[v], scatter, 1e-6 * scatter);
    auto const [third, spread] = mean_of(third_temperature);
    std::size_t const row = 7 * v + 2;  // seven looks each
    EXPECT_NEAR(series.column("time (ps)")[row], 0.2, 1e-12);
    EXPECT_NEAR(series.column("temperature (K)")[row], third, 1e-9 * third);
    EXPECT_NEAR(series.column("temperature error (K)")[row], spread, 1e-6 * spread);
  }
  EXPECT_EQ(series.columns[0].size(), 21U);
  for (char const* file : {"sweep.png", "series.png", "fits.csv", "runs.csv", "sweep.toml"})
    EXPECT_TRUE(fs::exists(folder / (std::string("all/") + file))) << file;
  EXPECT_NE(done.out.find("temperature 400 K"), std::string::npos) << done.out;
  EXPECT_NE(done.out.find(" ± "), std::string::npos) << done.out;
  EXPECT_NE(done.err.find("run 9 of 9"), std::string::npos) << done.err;
}

// The kinetic energy of an ideal gas in two dimensions is N kB T.
TEST_F(Sweep, FitsTheHeatCapacityOfAnIdealGas) {
  std::string ideal = gas;
  ideal.erase(ideal.find("[[influences]]"), ideal.find("[[diagnoses]]") - ideal.find("[[influences]]"));
  write(ideal + sweep);
  auto const done = run({"run", "gas.toml", "--seeds", "12", "--steps", "10", "--quiet", "--out", "all"});
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(done.out, "");
  auto text = text_of(folder / "all/fits.csv");
  text.erase(0, text.find('\n') + 1);
  auto const numbers = text.substr(text.find("(K),") + 4);
  double runs = 0, intercept = 0, intercept_error = 0, slope = 0, slope_error = 0;
  ASSERT_EQ(
      std::sscanf(numbers.c_str(), "%lf,%lf,%lf,%lf,%lf", &runs, &intercept, &intercept_error, &slope, &slope_error), 5)
      << text;
  EXPECT_EQ(runs, 36);
  EXPECT_NEAR(slope, 100 * 0.831446, 4 * slope_error);
  EXPECT_LT(slope_error, 5);
  EXPECT_NEAR(intercept, 0, 4 * intercept_error);
}

TEST_F(Sweep, MeansSinceATime) {
  std::string text = gas + sweep;
  text.replace(text.find("seeds = 3"), 9, "seeds = 1\nfrom = \"0.3 ps\"");
  write(text);
  auto const done = run({"run", "gas.toml", "--out", "all"});
  ASSERT_EQ(done.status, 0) << done.err;
  auto const rows = read_csv(path("all/02-temperature-200-K/diagnoses.csv")).column("temperature (K)");
  ASSERT_EQ(rows.size(), 7U);
  auto const table = read_csv(path("all/sweep.csv"));
  EXPECT_NEAR(table.column("temperature (K)")[1], (rows[3] + rows[4] + rows[5] + rows[6]) / 4, 1e-9);
  EXPECT_TRUE(std::isnan(table.column("temperature error (K)")[1]));  // of one seed
}

class Stopped : public Sweep, public testing::WithParamInterface<int> {};

TEST_P(Stopped, AndResumedLeavesTheSame) {
  write(gas + sweep);
  Words const words{"run", "gas.toml", "--steps", "3000", "--threads", "1", "--set", "output.checkpoint=500"};
  auto const with = [&](Words more) {
    more.insert(more.begin(), words.begin(), words.end());
    return more;
  };
  Process process(bzm_words(with({"--out", "stopped"})), folder.string());
  ASSERT_TRUE(process.wait_until([&] {
    return lines_in(text_of(folder / "stopped/03-temperature-100-K-seed-7/diagnoses.csv")) > 20;
  })) << process.wait().err;
  process.signal(GetParam());
  auto const stopped = process.wait();
  EXPECT_EQ(stopped.status, GetParam() == SIGKILL ? 128 + SIGKILL : 130);
  if (stopped.err.find("stopped by a signal") != std::string::npos) {  // in the middle of a run
    EXPECT_NE(stopped.err.find("bzm resume stopped"), std::string::npos) << stopped.err;
  }
  EXPECT_FALSE(fs::exists(folder / "stopped/sweep.csv"));
  auto const first = fs::last_write_time(folder / "stopped/01-temperature-100-K-seed-5/diagnoses.csv");

  auto const resumed = run({"resume", "stopped", "--threads", "1"});
  ASSERT_EQ(resumed.status, 0) << resumed.err;
  EXPECT_EQ(fs::last_write_time(folder / "stopped/01-temperature-100-K-seed-5/diagnoses.csv"), first);
  EXPECT_NE(resumed.out.find(" done before"), std::string::npos) << resumed.out;
  auto const whole = run(with({"--out", "whole"}));
  ASSERT_EQ(whole.status, 0) << whole.err;
  for (std::string const file : {"/sweep.csv", "/series.csv", "/fits.csv", "/runs.csv", "/sweep.toml"})
    EXPECT_EQ(text_of(folder / ("stopped" + file)), text_of(folder / ("whole" + file))) << file;

  // A sweep that is done is only tabulated again; and its runs are runs.
  auto const again = run({"resume", "whole", "--quiet"});
  EXPECT_EQ(again.status, 0) << again.err;
  EXPECT_EQ(text_of(folder / "stopped/sweep.csv"), text_of(folder / "whole/sweep.csv"));
  EXPECT_EQ(run({"render", "whole/02-temperature-100-K-seed-6", "-o", "run.png"}).status, 0);
  EXPECT_EQ(run({"resume", "whole/02-temperature-100-K-seed-6", "--steps", "10"}).status, 0);
}

INSTANTIATE_TEST_SUITE_P(Signals, Stopped, testing::Values(SIGINT, SIGKILL),
                         [](auto const& info) { return info.param == SIGINT ? "CtrlC" : "Kill"; });

TEST_F(Sweep, GoesOnWhereOneRunFails) {
  std::string text = gas + sweep;
  auto const from = text.find("ensembles.atoms.temperature = "), to = text.find('\n', from);
  text.replace(from, to - from, "ensembles.atoms.temperature = [\"100 K\", \"1e12 K\", \"200 K\"]");
  write(text);
  auto const done = run({"run", "gas.toml", "--out", "all"});
  EXPECT_EQ(done.status, 3) << done.err;
  EXPECT_NE(done.err.find("run 4 of 9 (temperature 1e12 K, seed 5) failed: "), std::string::npos) << done.err;
  EXPECT_NE(done.err.find("3 of 9 runs failed"), std::string::npos) << done.err;
  auto const table = read_csv(path("all/sweep.csv"));
  EXPECT_EQ(table.column("runs"), (std::vector<double>{3, 0, 3}));
  EXPECT_GT(table.column("temperature (K)")[2], 50);
  EXPECT_TRUE(std::isnan(table.column("temperature (K)")[1]));
  auto const again = run({"resume", "all"});
  EXPECT_EQ(again.status, 3);
  EXPECT_NE(again.err.find("run 4 of 9 (temperature 1e12 K, seed 5) failed: "), std::string::npos) << again.err;
  EXPECT_NE(again.out.find("9 done before"), std::string::npos) << again.out;
  // DissipatingPair away, it is tried again.
  fs::remove_all(folder / "all/04-temperature-1e12-K-seed-5");
  auto const third = run({"resume", "all"});
  EXPECT_EQ(third.status, 3);
  EXPECT_NE(third.out.find("8 done before"), std::string::npos) << third.out;
}

TEST_F(Sweep, OfTheCommandLine) {
  write(gas);
  auto const done = run({"run", "gas.toml", "--out", "all", "--steps", "0", "--vary",
                         "ensembles.atoms.temperature=[\"0 K\", \"50 K\"]", "--vary", "run.step=[0.001, 0.002]",
                         "--seeds", "2", "--set", "ensembles.atoms.mass=20"});
  ASSERT_EQ(done.status, 0) << done.err;
  auto const table = read_csv(path("all/sweep.csv"));
  EXPECT_EQ(table.columns[0], (std::vector<double>{0, 50}));
  EXPECT_EQ(table.columns[1], (std::vector<double>{0.001, 0.002}));
  EXPECT_EQ(table.column("temperature (K)")[0], 0);
  EXPECT_NEAR(table.column("temperature (K)")[1], 50, 15);
  EXPECT_NE(text_of(folder / "all/sweep.toml").find("mass = 20"), std::string::npos);
  auto const wrong = run({"run", "gas.toml", "--out", "wrong", "--vary", "run.stpe=[1, 2]"});
  EXPECT_EQ(wrong.status, 2);
  EXPECT_NE(wrong.err.find("--vary run.stpe=[1, 2]: unknown key 'stpe'"), std::string::npos) << wrong.err;
  EXPECT_EQ(lines_in(wrong.err), 1U) << wrong.err;
  EXPECT_FALSE(fs::exists(folder / "wrong"));
}

// A scenario of ours whose run has a time, and which varies its step.
std::string const timed = R"toml([box]
low = [0]
high = [10]
boundary = "periodic"
[run]
step = 0.1
time = 1
[[ensembles]]
name = "gas"
class = "Newton"
number = 10
mass = 1
load = { kind = "random" }
temperature = "1 K"
[[diagnoses]]
kind = "number"
[sweep]
vary = { "run.step" = [0.1, 0.05] }
)toml";

TEST(SweepOptions, StepsGoBeforeTheTimeOfTheScenario) {
  Folder folder;
  write_text(folder / "timed.toml", timed);
  auto const run = bzm({"run", "timed.toml", "--steps", "3", "--out", "out", "--quiet"}, folder.string());
  EXPECT_EQ(run.status, 0) << run.err;
  for (auto const& entry : fs::directory_iterator(folder / "out"))
    if (entry.is_directory()) {
      EXPECT_EQ(read_checkpoint((entry.path() / "checkpoint.h5").string()).step, 3) << entry.path();
    }
}

TEST(SweepOptions, WhatVariesIsNotSetBesides) {
  Folder folder;
  write_text(folder / "timed.toml", timed);
  for (char const* command : {"run", "check"}) {
    auto const set = bzm({command, "timed.toml", "--set", "run.step=0.2"}, folder.string());
    EXPECT_EQ(set.status, 2);
    EXPECT_EQ(set.err,
              "--set run.step=0.2: run.step: the sweep of this scenario varies it; give --vary run.step=[...], or "
              "--no-sweep\n");
  }
  auto const one =
      bzm({"run", "timed.toml", "--set", "run.step=0.2", "--no-sweep", "--out", "one", "--quiet"}, folder.string());
  EXPECT_EQ(one.status, 0) << one.err;
  EXPECT_EQ(read_checkpoint((folder / "one/checkpoint.h5").string()).step, 5);
  // Steps and time say the same.
  auto const steps = bzm({"check", "timed.toml", "--steps", "3", "--vary", "run.time=[0.2,0.4]"}, folder.string());
  EXPECT_EQ(steps.status, 2);
  EXPECT_EQ(steps.err,
            "--steps=3: run.steps: the sweep of this scenario varies run.time, which sets the same; give --vary "
            "run.time=[...], or --no-sweep\n");
  auto const vary = bzm({"check", "timed.toml", "--vary", "run.step=[0.2,0.1,0.05]"}, folder.string());
  EXPECT_NE(vary.out.find("in each of 3 runs"), std::string::npos) << vary.out << vary.err;
}

TEST(SweepOptions, SeedsOfWhatIsNotRandomAreRefused) {
  Folder folder;
  auto const run = bzm({"run", "three-body", "--seeds", "3", "--out", "out"}, folder.string());
  EXPECT_EQ(run.status, 2);
  EXPECT_EQ(lines_in(run.err), 1U) << run.err;
  EXPECT_NE(run.err.find("nothing in this scenario is random"), std::string::npos) << run.err;
  EXPECT_FALSE(fs::exists(folder / "out/runs.csv"));
}

TEST_F(Sweep, TellsMistakesOfAllValuesBeforeItRuns) {
  std::string text = gas + sweep;
  text.replace(text.find("\"200 K\", \"400 K\""), 16, "\"200 m\", \"-4 K\"");
  text.replace(text.find("y = \"kinetic energy\""), 0, "x = \"temperature\"\n");
  write(text);
  for (Words const& words : {Words{"run", "gas.toml"}, Words{"check", "gas.toml"}}) {
    auto const done = run(words);
    EXPECT_EQ(done.status, 2);
    EXPECT_EQ(lines_in(done.err), 2U) << done.err;
    EXPECT_NE(done.err.find("gas.toml:39:41: temperature: '200 m' is a length"), std::string::npos) << done.err;
    EXPECT_NE(done.err.find("gas.toml:39:50: temperature: '-4 K' is out of range"), std::string::npos) << done.err;
  }
  EXPECT_FALSE(fs::exists(folder / "results"));
  write(gas + sweep);
  auto const checked = run({"check", "gas.toml"});
  EXPECT_EQ(checked.status, 0);
  EXPECT_NE(checked.out.find("in each of 9 runs"), std::string::npos) << checked.out;
}

TEST_F(Sweep, StaysUnlessItIsToBeReplaced) {
  write(gas + sweep);
  ASSERT_EQ(run({"run", "gas.toml", "--steps", "10", "--seeds", "1", "--out", "all"}).status, 0);
  write_text(folder / "all/notes.txt", "mine");
  auto const twice = run({"run", "gas.toml", "--out", "all"});
  EXPECT_EQ(twice.status, 2);
  EXPECT_NE(twice.err.find("already holds a sweep"), std::string::npos) << twice.err;
  auto const render = run({"render", "all", "-o", "a.png"});
  EXPECT_EQ(render.status, 2);
  EXPECT_NE(render.err.find("draw one of its runs"), std::string::npos) << render.err;
  EXPECT_EQ(run({"resume", "all", "--steps", "10"}).status, 2);
  ASSERT_EQ(run({"run", "gas.toml", "--steps", "10", "--out", "all", "--force", "--vary",
                 "ensembles.atoms.temperature=[\"10 K\"]", "--seeds", "1"})
                .status,
            0);
  EXPECT_TRUE(fs::exists(folder / "all/01-temperature-10-K"));
  EXPECT_FALSE(fs::exists(folder / "all/02-temperature-200-K"));
  EXPECT_EQ(text_of(folder / "all/notes.txt"), "mine");
  // A plain run in its place.
  write(gas);
  EXPECT_EQ(run({"run", "gas.toml", "--out", "all"}).status, 2);
  ASSERT_EQ(run({"run", "gas.toml", "--steps", "10", "--out", "all", "--force"}).status, 0);
  EXPECT_FALSE(fs::exists(folder / "all/sweep.csv"));
  EXPECT_EQ(run({"resume", "all", "--steps", "10"}).status, 0);
  // And a sweep in the place of a run.
  write(gas + sweep);
  EXPECT_EQ(run({"run", "gas.toml", "--out", "all"}).status, 2);
  ASSERT_EQ(run({"run", "gas.toml", "--steps", "10", "--out", "all", "--force"}).status, 0);
  EXPECT_FALSE(fs::exists(folder / "all/diagnoses.csv"));
}

}  // namespace
}  // namespace boltzmann::sweep_test
