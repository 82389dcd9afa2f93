// bzm bench, run as a user would: its table, its file, and figures that belong together.
#include "command.hpp"

#include <regex>
#include <set>

namespace boltzmann::bench_test {
namespace {

using namespace boltzmann::test;

TEST(Bench, PrintsATableAndWritesTheFigures) {
  Folder const folder;
  auto const since = std::chrono::steady_clock::now();
  auto const done = bzm({"bench", "--seconds", "0.6", "--threads", "2", "--json", "figures.json"}, folder.string());
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  ASSERT_EQ(done.status, 0) << done.err;
  EXPECT_EQ(done.err, "");
  EXPECT_LT(seconds, 60);
  for (char const* word :
       {"particle-steps/s", "pairs/s", "Lennard-Jones melt", "gravity, all pairs", "chain of springs"})
    EXPECT_NE(done.out.find(word), std::string::npos) << word << " is not in\n" << done.out;

  std::string const text = text_of(folder / "figures.json");
  std::regex const row(
      R"re("problem": "([^"]+)", "particles": (\d+), "threads": (\d+), "particle_steps_per_second": ([^,]+), "pairs_per_second": ([^}]+)\})re");
  std::set<std::string> threads;
  int rows = 0;
  for (std::sregex_iterator it(text.begin(), text.end(), row), end; it != end; ++it, ++rows) {
    std::string const problem = (*it)[1];
    double const particles = std::stod((*it)[2]), steps = std::stod((*it)[4]), pairs = std::stod((*it)[5]);
    threads.insert((*it)[3]);
    EXPECT_GT(steps, 0);
    // Influences on one particle: 4/3 pi 2.5^3 0.8442 = 55 and a few per cent that the liquid's structure makes; all
    // others; two.
    double const expected = problem == "Lennard-Jones melt"   ? 55.25
                            : problem == "gravity, all pairs" ? particles - 1
                                                              : 2 * (particles - 1) / particles;
    EXPECT_NEAR(pairs / steps, expected, problem == "Lennard-Jones melt" ? 2 : 1e-4 * expected) << problem;
  }
  EXPECT_EQ(rows, 6) << text;
  EXPECT_EQ(threads, (std::set<std::string>{"1", "2"}));
}

TEST(Bench, RefusesWhatItCantDo) {
  Folder const folder;
  EXPECT_EQ(bzm({"bench", "--seconds", "0"}, folder.string()).status, 2);
  EXPECT_EQ(bzm({"bench", "--second", "1"}, folder.string()).status, 2);
  auto const done =
      bzm({"bench", "--seconds", "0.1", "--threads", "1", "--json", "nowhere/figures.json"}, folder.string());
  EXPECT_EQ(done.status, 2);
  EXPECT_NE(done.err.find("nowhere/figures.json"), std::string::npos) << done.err;
}

}  // namespace
}  // namespace boltzmann::bench_test
