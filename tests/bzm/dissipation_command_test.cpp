// A small shock wave on the command line: what is warned about, what the last table says, and that a stop leaves no
// trace.
#include "tests/bzm/command.hpp"

#include <boltzmann/files/checkpoint.hpp>

namespace boltzmann::dissipation_command_test {
namespace {

using namespace boltzmann::test;

// PVDF of the DPDE source, 9 x 8 mesoparticles, hit by a piston at 3000 m/s.
char const* const shock = R"(
[units]
base = "custom"
length = "1 angstrom"
mass = "1 amu"
time = "1 ps"

[box]
low = [0, 0]
high = ["51.3 angstrom", "35.54 angstrom"]
boundary = ["reflecting", "periodic"]

[[box.walls]]
axis = "x"
end = "low"
velocity = ["3000 m/s", 0]

[run]
step = "2 fs"
steps = 150

[[ensembles]]
name = "polymer"
class = "Meso"
mass = "64.03 amu"
load = { kind = "block", lattice = "triangular", spacing = "5.13 angstrom", counts = [9, 8] }
heat_capacity = "16 kB"
internal_energy = { temperature = "300 K" }

[[influences]]
law = "rydberg"
on = "polymer"
depth = "1.612e-20 J"
r0 = "5.07 angstrom"
a = 7.90
alpha = 0.185
cutoff = "15 angstrom"

[[dissipation]]
kind = "dpd"
on = "polymer"
convention = "constant-friction"
friction = "1.5e-14 kg/s"
range = "15 angstrom"
exponent = 2
projected = false

[equilibrate]
temperature = "300 K"
rate = "5 1/ps"
time = "0.2 ps"

[[diagnoses]]
kind = "energy-balance"

[output]
diagnoses = 5
checkpoint = 25
)";

class Shock : public testing::TestWithParam<std::string> {};

TEST_P(Shock, StoppedAndResumedLeavesTheSameBits) {
  Folder folder;
  write_text(folder / "shock.toml", shock);
  auto const run = [&](std::vector<std::string> words) {
    words.insert(words.end(), {"--set", "dissipation.0.method=" + GetParam(), "--quiet"});
    auto const outcome = bzm(words, folder.string());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "");  // 2 fs are short enough
  };
  run({"run", "shock.toml", "--out", "whole", "--threads", "2"});
  run({"run", "shock.toml", "--out", "stopped", "--steps", "70", "--threads", "1"});
  auto const resumed = bzm({"resume", "stopped", "--steps", "80", "--threads", "2", "--quiet"}, folder.string());
  ASSERT_EQ(resumed.status, 0) << resumed.err;
  auto const table = text_of(folder / "whole/diagnoses.csv");
  EXPECT_NE(table.find("work of walls (amu angstrom^2/ps^2)"), std::string::npos) << table;
  EXPECT_EQ(table, text_of(folder / "stopped/diagnoses.csv"));
  auto const a = read_checkpoint((folder / "whole/checkpoint.h5").string()),
             b = read_checkpoint((folder / "stopped/checkpoint.h5").string());
  EXPECT_EQ(a.step, 150);
  EXPECT_EQ(a.step, b.step);
  ASSERT_EQ(a.ensembles.size(), 1U);
  EXPECT_EQ(a.ensembles[0].rows, b.ensembles[0].rows);
}

INSTANTIATE_TEST_SUITE_P(Methods, Shock, testing::Values("simultaneous", "shardlow"),
                         [](auto const& info) { return info.param == "simultaneous" ? "orderfree" : "pairsplitting"; });

TEST(ShockCommand, WarnsOfACoarseStepAndCountsTheWorkOfThePiston) {
  Folder folder;
  write_text(folder / "shock.toml", shock);
  auto const fine = bzm({"run", "shock.toml", "--out", "fine"}, folder.string());
  EXPECT_EQ(fine.status, 0) << fine.err;
  EXPECT_NE(fine.out.find("energy less work (amu angstrom^2/ps^2)"), std::string::npos) << fine.out;
  EXPECT_EQ(fine.err.find("warning"), std::string::npos) << fine.err;
  auto const coarse =
      bzm({"run", "shock.toml", "--set", "run.step='10 fs'", "--steps", "1", "--out", "coarse", "--quiet"},
          folder.string());
  EXPECT_NE(coarse.err.find("warning: particles of 'polymer' meet at speeds up to 60 angstrom/ps and come 0.6 angstrom "
                            "closer in a step of "
                            "0.01 ps, but the law between them changes over 0.642 angstrom"),
            std::string::npos)
      << coarse.err;
}

}  // namespace
}  // namespace boltzmann::dissipation_command_test
