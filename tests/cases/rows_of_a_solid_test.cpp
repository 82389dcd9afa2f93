// The kind of fault: motion that alternates from one particle to the next met no strength. The file is the report; its
// siblings are other ranges, weights, densities, lattices, dimensions and wavelengths (tests/physics/solids_test.cpp),
// and here several ensembles that make one body, and a run on rk4.
#include "case.hpp"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <string>
#include <vector>

namespace boltzmann::rows_of_a_solid_test {
namespace {

using test::Case;

/// The angular frequency of a motion whose kinetic energy goes as cos^2: minima are half a period apart.
double frequency(Case const& report) {
  auto const time = report.column("time"), kinetic = report.column("kinetic energy");
  std::vector<double> minima;
  for (std::size_t k = 1; k + 1 < time.size(); ++k) {
    double const before = kinetic[k - 1], now = kinetic[k], after = kinetic[k + 1];
    if (now < before && now <= after)
      minima.push_back(time[k] + 0.5 * (time[k + 1] - time[k]) * (before - after) / (before - 2 * now + after));
  }
  if (minima.size() < 3) return 0;
  return std::numbers::pi * static_cast<double>(minima.size() - 1) / (minima.back() - minima.front());
}

std::vector<std::string> const often{"--set", "run.step=1e-4", "--set", "output.diagnoses=1"};
double const expected = std::sqrt(50.0) * std::numbers::pi / 0.02;  // sqrt(G / rho) k

TEST(RowsOfASolid, SwingAsHookeSays) {
  Case const report("rows-of-a-solid");
  auto const outcome = report.run(often);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(frequency(report) / expected, 1, 0.05);
  auto const total = report.column("total energy");
  for (double const energy : total) EXPECT_NEAR(energy / total.front(), 1, 0.01);
}

TEST(RowsOfASolid, SwingUnderOtherMethodsAndAtTheStepOfTheFile) {
  for (std::string const setting : {"ensembles.plate.integrator=rk4", "smooth.density=continuity"}) {
    Case const report("rows-of-a-solid");
    auto words = often;
    words.insert(words.end(), {"--set", setting});
    auto const outcome = report.run(words);
    ASSERT_EQ(outcome.status, 0) << outcome.err;
    EXPECT_NEAR(frequency(report) / expected, 1, 0.05) << setting;
  }
  Case const report("rows-of-a-solid");
  ASSERT_EQ(report.run({"--set", "output.diagnoses=1"}).status, 0);
  EXPECT_NEAR(frequency(report) / expected, 1, 0.05);
}

TEST(RowsOfASolid, SwingInABodyOfTwoEnsembles) {
  std::string text = test::text_of(test::fs::path(BOLTZMANN_SOURCE) / "tests/cases/files/rows-of-a-solid.toml");
  auto const replace = [](std::string& in, std::string const& what, std::string const& by) {
    auto const at = in.find(what);
    ASSERT_NE(at, std::string::npos) << what;
    in.replace(at, what.size(), by);
  };
  auto const first = text.find("[[ensembles]]"), behind = text.find("[[diagnoses]]");
  std::string lower = text.substr(first, behind - first), upper = lower;
  replace(lower, "spacing = 0.02", "spacing = 0.02, low = [0, 0], high = [0.4, 0.2]");
  replace(upper, "spacing = 0.02", "spacing = 0.02, low = [0, 0.2], high = [0.4, 0.4]");
  replace(upper, "\"plate\"", "\"upper\"");
  text.replace(first, behind - first, lower + upper);
  Case const report("two", text);
  auto const outcome = report.run(often);
  ASSERT_EQ(outcome.status, 0) << outcome.err;
  EXPECT_NEAR(frequency(report) / expected, 1, 0.05);
}

}  // namespace
}  // namespace boltzmann::rows_of_a_solid_test
