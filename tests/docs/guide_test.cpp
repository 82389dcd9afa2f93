// The guide's programs compile, run and keep what they promise; its scenarios pass `bzm check`; its commands run.
#include "../bzm/command.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

namespace boltzmann::guide_test {
namespace {

namespace fs = std::filesystem;

/// A block of the guide: ```cpp program or ```toml scenario.
struct Block {
  std::string name;  ///< the page's and which of its blocks it is
  std::string text;
};
void PrintTo(Block const& block, std::ostream* out) { *out << block.name; }

std::vector<Block> blocks(std::string const& beginning) {
  std::vector<Block> all;
  for (auto const& page : fs::directory_iterator(std::string(BOLTZMANN_SOURCE) + "/docs/guide")) {
    if (page.path().extension() != ".md") continue;
    std::ifstream file(page.path());
    int count = 0;
    for (std::string line; std::getline(file, line);) {
      if (line != beginning) continue;
      Block block{page.path().stem().string() + "_" + std::to_string(++count), ""};
      std::replace(block.name.begin(), block.name.end(), '-', '_');
      while (std::getline(file, line) && line != "```") block.text += line + "\n";
      all.push_back(block);
    }
  }
  std::sort(all.begin(), all.end(), [](Block const& a, Block const& b) { return a.name < b.name; });
  return all;
}

auto const name_of = [](testing::TestParamInfo<Block> const& info) { return info.param.name; };

class GuideProgram : public testing::TestWithParam<Block> {};
INSTANTIATE_TEST_SUITE_P(Guide, GuideProgram, testing::ValuesIn(blocks("```cpp program")), name_of);

TEST_P(GuideProgram, CompilesAndRuns) {
  test::Folder const folder;
  test::write_text(folder / "program.cpp", GetParam().text);
  auto const since = std::chrono::steady_clock::now();
  auto const built = test::bzm({"build", "program.cpp", "-o", "program"}, folder.string());
  ASSERT_EQ(built.status, 0) << built.err;
  double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
  std::printf("[ COMPILE  ] %.1f s\n", seconds);
  auto const run = test::Process({(folder / "program").string()}, folder.string()).wait();
  EXPECT_EQ(run.status, 0) << run.err;
}

class GuideScenario : public testing::TestWithParam<Block> {};
INSTANTIATE_TEST_SUITE_P(Guide, GuideScenario, testing::ValuesIn(blocks("```toml scenario")), name_of);

TEST_P(GuideScenario, IsRight) {
  test::Folder const folder;
  test::write_text(folder / "scenario.toml", GetParam().text);
  auto const checked = test::bzm({"check", "scenario.toml"}, folder.string());
  EXPECT_EQ(checked.status, 0) << checked.err;
}

class GuideCommands : public testing::TestWithParam<Block> {};
INSTANTIATE_TEST_SUITE_P(Guide, GuideCommands, testing::ValuesIn(blocks("```sh commands")), name_of);

TEST_P(GuideCommands, Run) {
  test::Folder const folder;
  test::write_text(folder / "commands.sh", "set -e\nPATH=" BOLTZMANN_BUILD ":$PATH\n" + GetParam().text);
  auto const run = test::Process({"/bin/sh", "commands.sh"}, folder.string()).wait();
  EXPECT_EQ(run.status, 0) << run.err;
}

TEST(Guide, HasProgramsAndScenarios) {
  EXPECT_GE(blocks("```cpp program").size(), 3u);
  EXPECT_GE(blocks("```toml scenario").size(), 1u);
  EXPECT_GE(blocks("```sh commands").size(), 2u);
}

}  // namespace
}  // namespace boltzmann::guide_test
