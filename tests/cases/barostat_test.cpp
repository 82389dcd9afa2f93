// Kind of fault: a barostat that does not hold its pressure, without a word. Moves that are never accepted, and a mean
// pressure far from the target, for both methods, all axes together and each by itself; no alarm where it works.
#include "tests/cases/case.hpp"

#include <fmt/format.h>

namespace boltzmann::barostat_cases_test {
namespace {

using namespace test;

std::string replaced(std::string text, std::string const& from, std::string const& to) {
  std::size_t const at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}
std::string stuck() { return text_of(fs::path(BOLTZMANN_SOURCE) / "tests/cases/files/barostat-stuck.toml"); }
bool warns(Outcome const& outcome) { return outcome.err.find("warning: the barostat") != std::string::npos; }

}  // namespace

TEST(BarostatThatIsStuck, WarnsOnStandardErrorAlsoWithQuiet) {
  Case const run("barostat-stuck");
  for (auto const& more : {std::vector<std::string>{}, std::vector<std::string>{"--quiet"}}) {
    auto const outcome = run.run(more);
    EXPECT_EQ(outcome.status, 0);
    EXPECT_NE(outcome.err.find("warning: the barostat accepted"), std::string::npos) << outcome.err;
    EXPECT_NE(outcome.err.find("take a smaller rate"), std::string::npos) << outcome.err;
    EXPECT_EQ(outcome.err.find("warning: the barostat does not hold"), std::string::npos) << outcome.err;
  }
}

TEST(BarostatThatIsStuck, EachAxisByItself) {
  Case const run("axes", replaced(stuck(), "rate = 50", "rate = 50\ntogether = false"));
  auto const outcome = run.run({"--quiet"});  // here the box collapses along one axis
  EXPECT_TRUE(outcome.status == 3 || warns(outcome)) << outcome.status << outcome.err;
}

// The rate that the warning names holds the pressure, and nothing is said.
TEST(BarostatThatIsStuck, TheCureHoldsThePressure) {
  Case const run("cured", replaced(stuck(), "rate = 50", "rate = 2.5"));
  auto const outcome = run.run({"--quiet"});
  EXPECT_EQ(outcome.err, "");
  auto const pressure = run.column("pressure");
  double mean = 0;
  for (std::size_t i = pressure.size() / 2; i < pressure.size(); ++i)
    mean += pressure[i] / static_cast<double>(pressure.size() - pressure.size() / 2);
  EXPECT_NEAR(mean, 5, 0.5);
}

// A resumed run says what the whole run would.
TEST(BarostatThatIsStuck, AfterAResume) {
  Case const run("barostat-stuck");
  run.run({"--quiet", "--steps", "2500"});
  auto const outcome = bzm({"resume", "run", "--quiet", "--threads", "1", "--steps", "2500"}, run.string());
  EXPECT_TRUE(warns(outcome)) << outcome.err;
}

}  // namespace boltzmann::barostat_cases_test
