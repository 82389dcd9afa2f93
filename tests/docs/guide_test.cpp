// Programs in the documentation compile and run, its scenarios pass `bzm check`, and its commands run. Programs and
// scenarios that pages no longer show are in tests/docs/programs and are tested, too.
#include "../bzm/command.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cctype>
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

/// A fenced block of a page below docs/: ```cpp program, ```toml scenario or ```sh commands.
struct Block {
  std::string name;  ///< path of the page and number of the block: how_to_write_a_law_2
  std::string text;
};
void PrintTo(Block const& block, std::ostream* out) { *out << block.name; }

std::vector<Block> blocks(std::string const& beginning) {
  std::vector<Block> all;
  std::string const ending = beginning == "```cpp program" ? ".cpp" : beginning == "```toml scenario" ? ".toml" : ".sh";
  for (auto const& file : fs::directory_iterator(std::string(BOLTZMANN_SOURCE) + "/tests/docs/programs"))
    if (file.path().extension() == ending)
      all.push_back({"former_" + file.path().stem().string(), test::text_of(file.path())});
  fs::path const docs = std::string(BOLTZMANN_SOURCE) + "/docs";
  for (auto const& page : fs::recursive_directory_iterator(docs)) {
    if (page.path().extension() != ".md") continue;
    std::string stem = fs::relative(page.path(), docs).replace_extension().string();
    for (char& c : stem)
      if (std::isalnum(static_cast<unsigned char>(c)) == 0) c = '_';
    std::ifstream file(page.path());
    int count = 0;
    for (std::string line; std::getline(file, line);) {
      if (line != beginning) continue;
      Block block{stem + "_" + std::to_string(++count), ""};
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

// The page of scenario files quotes the messages that its first scenario gives with two words changed.
TEST(Guide, MistakesAreThoseOfThePage) {
  auto const all = blocks("```toml scenario");
  auto const first =
      std::find_if(all.begin(), all.end(), [](Block const& one) { return one.name == "reference_scenario_index_1"; });
  ASSERT_NE(first, all.end());
  std::string text = first->text;
  auto const change = [&](std::string const& word, std::string const& mistake) {
    auto const at = text.find(word);
    ASSERT_NE(at, std::string::npos) << word;
    text.replace(at, word.size(), mistake);
  };
  change("step = 0.005", "stpe = 0.005");
  change("mass = 1", "mass = \"3.4 angstrom\"");
  test::Folder const folder;
  test::write_text(folder / "argon.toml", text);
  std::string quoted;
  std::ifstream page(std::string(BOLTZMANN_SOURCE) + "/docs/reference/scenario/index.md");
  for (std::string line; std::getline(page, line);)
    if (line.starts_with("    argon.toml:")) quoted += line.substr(4) + "\n";
  EXPECT_EQ(test::bzm({"check", "argon.toml"}, folder.string()).err, quoted);
}

TEST(Guide, HasProgramsAndScenarios) {
  EXPECT_GE(blocks("```cpp program").size(), 27u);
  EXPECT_GE(blocks("```toml scenario").size(), 33u);
  EXPECT_GE(blocks("```sh commands").size(), 10u);
}

}  // namespace
}  // namespace boltzmann::guide_test
