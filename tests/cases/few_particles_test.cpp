// Runs of no particle, one and two. Kind: a mean over nothing is written as a number. Siblings: every shipped scenario
// whose ensembles have a `number`: gases and plasmas, meshes, multipoles, P3M, vortices, friction and noise, sheared boxes,
// user classes; their diagnoses, gathered tables and pictures.
#include "tests/cases/case.hpp"

#include <gtest/gtest.h>

#include <regex>

namespace boltzmann::few_particles_test {
namespace {

using test::Case;

/// A shipped scenario with so many particles in each ensemble, a row of diagnoses each step; "" if none has a number.
std::string with_number(std::filesystem::path const& scenario, int number) {
  std::string const text = test::text_of(scenario);
  static std::regex const numbers("(^|\\n)number = [0-9]+"), rows("(^|\\n)diagnoses = [0-9]+"), sweep("\\n\\[sweep\\]");
  if (!std::regex_search(text, numbers) || std::regex_search(text, sweep)) return "";
  auto const fewer = std::regex_replace(text, numbers, "$1number = " + std::to_string(number));
  return std::regex_replace(fewer, rows, "$1diagnoses = 1");
}

TEST(FewParticles, GiveNumbersEmptyCellsOrOneLine) {
  std::size_t ran = 0;
  for (auto const& scenario : std::filesystem::directory_iterator(BOLTZMANN_SOURCE "/scenarios"))
    for (int const number : {0, 1, 2}) {
      if (scenario.path().extension() != ".toml") continue;
      std::string const name = scenario.path().stem().string() + " with " + std::to_string(number);
      auto const text = with_number(scenario.path(), number);
      if (text.empty()) continue;
      Case const few("few", text);
      auto const outcome = few.run({"--quiet", "--steps", "3"});
      EXPECT_TRUE(outcome.status == 0 || outcome.status == 2) << name << ": " << outcome.status << outcome.err;
      EXPECT_EQ(outcome.err.empty() && outcome.status == 2, false) << name;
      if (outcome.status != 0) continue;
      ++ran;
      for (auto const& file : std::filesystem::directory_iterator(few / "run")) {
        if (file.path().extension() != ".csv") continue;
        auto const table = test::text_of(file.path());
        EXPECT_FALSE(std::regex_search(table, std::regex(",-?(nan|inf)")))
            << name << ": " << file.path().filename() << "\n"
            << table;
      }
    }
  EXPECT_GT(ran, 30U);
}

}  // namespace
}  // namespace boltzmann::few_particles_test
