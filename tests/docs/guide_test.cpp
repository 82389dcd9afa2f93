// The guide's programs compile, run and keep what they promise; its scenarios pass `bzm check`.
#include <gtest/gtest.h>

#include <unistd.h>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <string>
#include <vector>

namespace boltzmann::guide_test {
namespace {

namespace fs = std::filesystem;

struct Block {
  std::string page, kind, text;
};

std::vector<Block> blocks() {
  std::vector<Block> all;
  for (auto const& page : fs::directory_iterator(std::string(BOLTZMANN_SOURCE) + "/docs/guide")) {
    if (page.path().extension() != ".md") continue;
    std::ifstream file(page.path());
    std::string line, text, kind;
    while (std::getline(file, line)) {
      if (kind.empty()) {
        if (line == "```cpp program") kind = "program";
        if (line == "```toml scenario") kind = "scenario";
      } else if (line == "```") {
        all.push_back({page.path().stem().string(), kind, text});
        kind.clear();
        text.clear();
      } else {
        text += line + "\n";
      }
    }
  }
  return all;
}

fs::path folder() {
  fs::path const path = fs::temp_directory_path() / ("boltzmann-guide-" + std::to_string(getpid()));
  fs::create_directories(path);
  return path;
}

std::string const bzm = std::string(BOLTZMANN_BUILD) + "/bzm";

TEST(Guide, ProgramsCompileAndRun) {
  int programs = 0;
  for (auto const& block : blocks()) {
    if (block.kind != "program") continue;
    auto const source = folder() / (block.page + std::to_string(++programs) + ".cpp");
    std::ofstream(source) << block.text;
    auto const program = source.parent_path() / source.stem();
    auto const since = std::chrono::steady_clock::now();
    ASSERT_EQ(std::system((bzm + " build " + source.string() + " -o " + program.string() + " > /dev/null").c_str()), 0)
        << block.page;
    double const seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - since).count();
    std::printf("[ COMPILE  ] %s: %.1f s\n", source.filename().c_str(), seconds);
    EXPECT_EQ(std::system(("cd " + folder().string() + " && " + program.string()).c_str()), 0) << block.page;
  }
  EXPECT_GE(programs, 3);
}

TEST(Guide, ScenariosAreRight) {
  int scenarios = 0;
  for (auto const& block : blocks()) {
    if (block.kind != "scenario") continue;
    auto const file = folder() / (block.page + std::to_string(++scenarios) + ".toml");
    std::ofstream(file) << block.text;
    EXPECT_EQ(std::system((bzm + " check " + file.string()).c_str()), 0) << block.page;
  }
  EXPECT_GE(scenarios, 1);
  fs::remove_all(folder());
}

}  // namespace
}  // namespace boltzmann::guide_test
