// Sweeps of mesoparticles that are killed, run out of disk space or have been edited: the same bits, or one line.
#include "tests/bzm/command.hpp"

#include <tests/scenario/mistakes.hpp>

#include <boltzmann/scenario/sweep.hpp>

namespace boltzmann::sweep_misuse_test {
namespace {

using namespace boltzmann::test;
using Words = std::vector<std::string>;

// A prepared body of mesoparticles into which a piston runs.
std::string const body = R"toml([units]
base = "custom"
length = "1 angstrom"
mass = "1 amu"
time = "1 ps"
[box]
low = [0, 0]
high = [260, 80]
boundary = ["reflecting", "periodic"]
[[box.walls]]
axis = "x"
end = "low"
velocity = ["2000 m/s", 0]
[[box.walls]]
axis = "x"
end = "high"
open = true
[run]
step = "2 fs"
steps = 60
[[ensembles]]
name = "polymer"
class = "Meso"
integrator = "leap-frog"
mass = "64 amu"
load = { kind = "block", lattice = "square", spacing = 5, counts = [40, 16], origin = [2.5, 2] }
heat_capacity = "16 kB"
internal_energy = { temperature = "300 K" }
[[influences]]
law = "soft"
on = "polymer"
repulsion = 2000
range = 6
cutoff = 6
[[dissipation]]
kind = "dpd"
on = "polymer"
convention = "constant-friction"
friction = "1.5e-14 kg/s"
range = 15
projected = false
[equilibrate]
temperature = "300 K"
rate = "5 1/ps"
time = "0.04 ps"
[[diagnoses]]
kind = "slab"
from = 20
to = 60
[[diagnoses]]
kind = "energy-balance"
[output]
diagnoses = 5
trajectory = 20
checkpoint = 10
)toml";

std::string const sweep = R"toml([sweep]
seeds = 2
labels = ["coupled", "uncoupled"]
table = ["energy", "slab kinetic temperature"]
[sweep.vary]
"dissipation.0.friction" = ["1.5e-14 kg/s", 0]
[[sweep.pictures]]
y = "energy"
fit = "line"
)toml";

struct SweepMisuse : testing::Test {
  Folder folder;
  Outcome run(Words const& words) const { return bzm(words, folder.string()); }
  void write(std::string const& text) const { write_text(folder / "shock.toml", text); }
  /// A sweep that is done, in "all".
  void done() const {
    write(body + sweep);
    auto const outcome = run({"run", "shock.toml", "--out", "all", "--quiet"});
    ASSERT_EQ(outcome.status, 0) << outcome.err;
  }
  void expect_the_same(std::string const& one, std::string const& other) const {
    for (std::string const file : {"/sweep.csv", "/series.csv", "/fits.csv", "/runs.csv"})
      EXPECT_EQ(text_of(folder / (one + file)), text_of(folder / (other + file))) << file;
    for (std::string const name : {"/01-coupled-seed-1", "/02-coupled-seed-2", "/03-uncoupled-seed-1"}) {
      EXPECT_EQ(text_of(folder / (one + name + "/diagnoses.csv")), text_of(folder / (other + name + "/diagnoses.csv")));
      EXPECT_EQ(text_of(folder / (one + name + "/scenario.toml")), text_of(folder / (other + name + "/scenario.toml")));
    }
  }
};

TEST_F(SweepMisuse, KilledAgainAndAgainItEndsWithTheSameBits) {
  ASSERT_NO_FATAL_FAILURE(done());
  for (int const wait : {20, 70, 150, 310}) {
    Words words{"run", "shock.toml", "--out", "killed", "--quiet", "--force"};
    Outcome outcome{};
    for (int attempt = 0; attempt < 8; ++attempt) {
      Process process(bzm_words(words), folder.string());
      std::this_thread::sleep_for(std::chrono::milliseconds(wait * (1 + attempt)));
      process.signal(SIGKILL);
      outcome = process.wait();
      if (outcome.status == 0) break;
      if (fs::exists(folder / "killed/sweep.toml")) words = {"resume", "killed", "--quiet"};
    }
    if (outcome.status != 0) outcome = run(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    expect_the_same("all", "killed");
    fs::remove_all(folder / "killed");
  }
}

TEST_F(SweepMisuse, AFullDiskIsToldAndResumedItEndsWithTheSameBits) {
  ASSERT_NO_FATAL_FAILURE(done());
  for (std::string const blocks : {"60", "300"}) {  // of 512 bytes: too few for a frame, or for all frames
    write(body + sweep);
    Process process(
        {"/bin/sh", "-c", "ulimit -f " + blocks + "; exec " + bzm_words({})[0] + " run shock.toml --out full --quiet"},
        folder.string());
    auto const full = process.wait();
    EXPECT_TRUE(full.status == 1 || full.status == 2) << full.status << full.err;
    EXPECT_NE(full.err.find("can't be written"), std::string::npos) << full.err;
    EXPECT_EQ(lines_in(full.err), 1U) << full.err;
    auto const resumed = run({"resume", "full", "--quiet"});
    ASSERT_EQ(resumed.status, 0) << resumed.err;
    expect_the_same("all", "full");
    fs::remove_all(folder / "full");
  }
}

TEST_F(SweepMisuse, CheckpointsOfOtherRunsAreRefused) {
  ASSERT_NO_FATAL_FAILURE(done());
  fs::remove(folder / "all/runs.csv");
  fs::copy_file(folder / "all/03-uncoupled-seed-1/checkpoint.h5", folder / "all/02-coupled-seed-2/checkpoint.h5",
                fs::copy_options::overwrite_existing);
  auto const other = run({"resume", "all"});
  EXPECT_EQ(other.status, 2);
  EXPECT_NE(other.err.find("'all/02-coupled-seed-2/checkpoint.h5' is of another scenario than run 2"),
            std::string::npos)
      << other.err;
  EXPECT_EQ(lines_in(other.err.substr(other.err.find("'all/"))), 1U) << other.err;
  write_text(folder / "all/02-coupled-seed-2/checkpoint.h5", "");
  EXPECT_EQ(run({"resume", "all"}).status, 2);
  // As the line says: taken away, the run is done anew.
  fs::remove_all(folder / "all/02-coupled-seed-2");
  auto const again = run({"resume", "all", "--quiet", "--threads", "2"});
  EXPECT_EQ(again.status, 0) << again.err;
}

TEST_F(SweepMisuse, RunsAreNotTakenForThoseOfAnEditedSweep) {
  ASSERT_NO_FATAL_FAILURE(done());
  std::string const text = text_of(folder / "all/sweep.toml");
  auto const write_sweep = [&](std::string const& now) {
    write_text(folder / "all/sweep.toml", now);
    fs::last_write_time(folder / "all/sweep.toml", fs::file_time_type::clock::now() + std::chrono::hours(1));
  };
  write_sweep(text);
  EXPECT_EQ(run({"resume", "all", "--threads", "2"}).status, 0);  // only the time of the file is another
  write_sweep(replaced(text, "1.5e-14 kg/s\", 0]", "1.5e-14 kg/s\", \"5 amu/ps\"]"));
  auto const edited = run({"resume", "all", "--quiet"});
  EXPECT_EQ(edited.status, 2);
  EXPECT_EQ(edited.err,
            "'all/03-uncoupled-seed-1/scenario.toml' is of another scenario than run 3 of 'all/sweep.toml'; take the "
            "folder 03-uncoupled-seed-1 away, and the run is done anew\n");
  for (char const* name : {"all/03-uncoupled-seed-1", "all/04-uncoupled-seed-2"}) fs::remove_all(folder / name);
  EXPECT_EQ(run({"resume", "all", "--quiet"}).status, 0);
  EXPECT_NE(text_of(folder / "all/03-uncoupled-seed-1/scenario.toml").find("friction = \"5 amu/ps\""),
            std::string::npos);
}

TEST_F(SweepMisuse, TablesOfOtherRunsAreNamed) {
  ASSERT_NO_FATAL_FAILURE(done());
  write_text(folder / "all/02-coupled-seed-2/diagnoses.csv", "step,time (ps),energy\n0,0,1\n");
  auto const other = run({"resume", "all", "--quiet"});
  EXPECT_EQ(other.status, 2);
  EXPECT_EQ(other.err.find("all/02-coupled-seed-2/diagnoses.csv: there is no column 'slab kinetic temperature (K)'"),
            0U)
      << other.err;
  EXPECT_EQ(lines_in(other.err), 1U);
}

std::string with_sweep(std::string const& rest) { return body + "[sweep]\n" + rest; }

TEST(SweepMistakes, KeysVaryOnce) {
  auto const lines = mistakes_of(with_sweep(
      "[sweep.vary]\n\"dissipation.0.friction\" = [1, 2]\nrun.step = [1, 2]\ndissipation.0.friction = [3, 4]\n"));
  ASSERT_EQ(lines.size(), 1U) << testing::PrintToString(lines);
  EXPECT_NE(lines[0].find("dissipation.0.friction: it varies twice (the first time in line "), std::string::npos)
      << lines[0];
}

TEST(SweepMistakes, PicturesHaveANameBeforeItsEnding) {
  auto const lines =
      mistakes_of(with_sweep("seeds = 2\n[[sweep.pictures]]\nx = \"energy\"\ny = \"energy\"\nfile = \".png\"\n"));
  ASSERT_EQ(lines.size(), 1U) << testing::PrintToString(lines);
  EXPECT_NE(lines[0].find("file: '.png' has no name before its ending"), std::string::npos) << lines[0];
}

TEST(SweepMistakes, ZeroHasTheUnitOfTheOthers) {
  auto const numbers = [](std::string const& values) {
    auto const scenario =
        parse_scenario(with_sweep("vary = { \"dissipation.0.friction\" = " + values + " }\n"), "test.toml");
    return scenario->sweep->vary[0].numbers;
  };
  auto const two = numbers("[0, \"1 amu/ps\", \"3 amu/ps\"]");
  ASSERT_EQ(two.size(), 3U);
  EXPECT_EQ(two[0], 0);
  EXPECT_NEAR(two[2] / two[1], 3, 1e-12);
  EXPECT_EQ(numbers("[0, 0]").size(), 2U);
  EXPECT_EQ(numbers("[1, \"3 amu/ps\"]").size(), 0U);  // a number beside a quantity is in the units of the scenario
}

}  // namespace
}  // namespace boltzmann::sweep_misuse_test
