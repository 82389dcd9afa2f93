// BOLTZMANN_INSTRUCTIONS as a user meets it: the sets compute the same physics, each with the same bits for any number
// of threads.
#include "tests/bzm/command.hpp"

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/files/trajectory.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <fstream>

namespace boltzmann::forced_instructions_test {
namespace {

using namespace boltzmann::test;

/// bzm with kernels of that set.
Outcome bzm_with(std::string const& set, std::vector<std::string> const& words, std::string const& folder) {
  setenv("BOLTZMANN_INSTRUCTIONS", set.c_str(), 1);
  auto const outcome = bzm(words, folder);
  unsetenv("BOLTZMANN_INSTRUCTIONS");
  return outcome;
}

/// All numbers of the last frame: field by field.
std::vector<std::vector<double>> last_frame(fs::path const& run) {
  TrajectoryReader const trajectory((run / "trajectory.h5").string());
  std::vector<std::vector<double>> fields;
  for (auto const& ensemble : trajectory.ensembles())
    for (auto const& field : ensemble.fields)
      fields.push_back(trajectory.read(trajectory.frames() - 1, ensemble.name, field.name));
  return fields;
}

// Lists (with enough pairs for two threads: copper-10000), all pairs, connections, a handful of particles, influences
// from outside.
class EverySet : public testing::TestWithParam<std::string> {};

TEST_P(EverySet, ComputesTheSameWithAnyNumberOfThreads) {
  auto const run = [&](std::string const& set, std::string const& threads, Folder const& folder) {
    std::string const out = set + "-" + threads;
    auto const outcome = bzm_with(set,
                                  {"run", GetParam(), "--steps", "40", "--set", "output.trajectory=40", "--set",
                                   "output.diagnoses=10", "--threads", threads, "--quiet", "--out", out},
                                  folder.string());
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return folder / out;
  };
  Folder folder;
  std::vector<std::vector<double>> plain;
  for (auto const set : instruction_sets()) {
    auto const one = run(to_string(set), "1", folder), two = run(to_string(set), "2", folder);
    EXPECT_EQ(last_frame(one), last_frame(two)) << to_string(set);
    EXPECT_EQ(text_of(one / "diagnoses.csv"), text_of(two / "diagnoses.csv")) << to_string(set);
    auto const fields = last_frame(one);
    if (plain.empty()) {
      plain = fields;
    } else if (GetParam() == "copper-10000") {
      EXPECT_NE(fields, plain) << "not even the roundings differ: " << to_string(set) << " is not in use";
    }
    ASSERT_GT(plain.size(), 1U);
    ASSERT_EQ(fields.size(), plain.size());
    for (std::size_t f = 0; f < fields.size(); ++f) {
      ASSERT_EQ(fields[f].size(), plain[f].size());
      double largest = 0, difference = 0;
      for (std::size_t i = 0; i < fields[f].size(); ++i) {
        largest = std::max(largest, std::abs(plain[f][i]));
        difference = std::max(difference, std::abs(fields[f][i] - plain[f][i]));
      }
      EXPECT_LE(difference, 1e-11 * largest) << to_string(set) << ", field " << f;
    }
  }
}
INSTANTIATE_TEST_SUITE_P(Instructions, EverySet,
                         testing::Values("copper-10000", "three-body", "rod", "pendulums", "cylinder", "atmosphere"),
                         [](auto const& info) {
                           std::string name = info.param;
                           std::replace(name.begin(), name.end(), '-', '_');
                           return name;
                         });

TEST(Instructions, TheDoctorSaysWhichAndComputesRightWithEach) {
  Folder folder;
  std::string words;
  for (auto const set : instruction_sets()) words += (words.empty() ? "" : ", ") + to_string(set);
  for (auto const set : instruction_sets()) {
    auto const outcome = bzm_with(to_string(set), {"doctor"}, folder.string());
    EXPECT_EQ(outcome.status, 0) << outcome.out << outcome.err;
    EXPECT_TRUE(has(outcome.out, "instructions    " + to_string(set))) << outcome.out;
    EXPECT_TRUE(has(outcome.out, words)) << outcome.out;
    EXPECT_TRUE(has(outcome.out, "-6.77336805")) << outcome.out;
  }
}

TEST(Instructions, AWrongWordIsOneLineAndStatus2) {
  Folder folder;
  for (std::vector<std::string> const& command : {std::vector<std::string>{"run", "copper"}, {"list"}, {"doctor"}}) {
    auto const outcome = bzm_with("x86-64-v9", command, folder.string());
    EXPECT_EQ(outcome.status, 2) << outcome.out;
    EXPECT_EQ(lines_in(outcome.err), 1U) << outcome.err;
    EXPECT_TRUE(has(outcome.err, "BOLTZMANN_INSTRUCTIONS is 'x86-64-v9'")) << outcome.err;
    for (auto const set : instruction_sets()) EXPECT_TRUE(has(outcome.err, to_string(set))) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(folder / "results"));
  EXPECT_EQ(bzm_with("x86-64-v9", {"--help"}, folder.string()).status, 0);
}

// Laws that are typed: interpreted, by machine code where there is some, and with any number of threads.
TEST(TypedLaws, HaveTheSameBitsInterpretedAndByMachineCode) {
  Folder folder;
  std::string const text = R"toml([units]
base = "reduced"
[box]
low = [0, 0, 0]
high = [16.8, 16.8, 16.8]
boundary = "periodic"
[run]
step = 0.004
steps = 25
cutoff = 2.5
[[ensembles]]
name = "atoms"
class = "Coulomb"
load = { kind = "block", lattice = "fcc", spacing = 1.1879394, counts = [10, 10, 10] }
temperature = 1
charge = 0.3
[[ensembles]]
name = "beads"
class = "Newton"
load = { kind = "positions", positions = [[1, 1, 1], [1.5, 1, 1], [2, 1.2, 1]] }
[[influences]]
on = "atoms"
energy = "4*(r^-12 - r^-6) + p.charge*q.charge*exp(-r)/r"
[[influences]]
on = "atoms"
influence = "-0.1*(1.5*p.mass - q.mass)*(1 - r/2.5)^2*dot(separation, velocity)*separation/r^2"
[[influences]]
on = "beads"
by = "atoms"
energy = "exp(-2*r)*min(r, 2) + log(1 + r)"
[[influences]]
on = "beads"
connect = [[0, 1, 1]]
energy = "20*(r - 0.5)^2"
[[influences]]
on = "atoms"
from_outside = true
energy = "0.1*floor(x) + 0.01*x^2*abs(y - 8)"
[[diagnoses]]
kind = "temperature"
[output]
trajectory = 25
diagnoses = 5
)toml";
  std::ofstream(folder / "typed.toml") << text;
  auto const run = [&](std::string const& set, char const* formulas, std::string const& threads) {
    std::string const out = set + "-" + formulas + "-" + threads;
    setenv("BOLTZMANN_FORMULAS", formulas, 1);
    auto const outcome =
        bzm_with(set, {"run", "typed.toml", "--threads", threads, "--quiet", "--out", out}, folder.string());
    unsetenv("BOLTZMANN_FORMULAS");
    EXPECT_EQ(outcome.status, 0) << outcome.err;
    return folder / out;
  };
  for (auto const set : instruction_sets()) {
    auto const name = to_string(set);
    auto const interpreted = run(name, "interpreted", "1");
    for (char const* const threads : {"1", "2"}) {
      auto const compiled = run(name, "compiled", threads);
      EXPECT_EQ(last_frame(compiled), last_frame(interpreted)) << name;
      EXPECT_EQ(text_of(compiled / "diagnoses.csv"), text_of(interpreted / "diagnoses.csv")) << name;
    }
  }
  setenv("BOLTZMANN_FORMULAS", "jit", 1);
  auto const wrong = bzm({"check", "typed.toml"}, folder.string());
  unsetenv("BOLTZMANN_FORMULAS");
  EXPECT_TRUE(has(wrong.err, "BOLTZMANN_FORMULAS is 'jit'; it may be interpreted or compiled")) << wrong.err;
}

}  // namespace
}  // namespace boltzmann::forced_instructions_test
