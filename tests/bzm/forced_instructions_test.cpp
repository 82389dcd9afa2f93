// BOLTZMANN_INSTRUCTIONS as a user meets it: the sets compute the same physics, each with the same bits for any number
// of threads.
#include "tests/bzm/command.hpp"

#include <boltzmann/core/instruction_set.hpp>
#include <boltzmann/files/trajectory.hpp>

#include <algorithm>
#include <cmath>

namespace boltzmann::forced_instructions_test {
namespace {

using namespace boltzmann::test;

bool has(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

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

}  // namespace
}  // namespace boltzmann::forced_instructions_test
