// The list of rooms in docs/architecture.md: every folder stands in it, and a room includes only from itself and from
// rooms above it.
#include <boltzmann/files/text_file.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <vector>

namespace boltzmann::architecture_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> rooms() {
  std::istringstream page(read_text(std::string(BOLTZMANN_SOURCE) + "/docs/architecture.md"));
  std::vector<std::string> all;
  std::string line;
  while (std::getline(page, line) && !line.starts_with("| room |")) {
  }
  std::getline(page, line);  // below the head
  while (std::getline(page, line) && line.starts_with("| ")) all.push_back(line.substr(2, line.find(" |") - 2));
  return all;
}

TEST(Architecture, RoomsIncludeOnlyFromThoseAbove) {
  auto const all = rooms();
  auto const place = [&](std::string const& room) { return std::find(all.begin(), all.end(), room) - all.begin(); };
  std::regex const include("#include <boltzmann/(\\w+)/");
  std::size_t seen = 0;
  for (auto const& folder : fs::directory_iterator(std::string(BOLTZMANN_SOURCE) + "/boltzmann")) {
    if (!folder.is_directory() || fs::is_empty(folder)) continue;
    std::string const room = folder.path().filename();
    ASSERT_LT(place(room), std::ssize(all)) << "docs/architecture.md does not tell of the room " << room;
    for (auto const& file : fs::recursive_directory_iterator(folder)) {
      auto const ending = file.path().extension();
      if (file.path().string().find("/web/") != std::string::npos || (ending != ".cpp" && ending != ".hpp")) continue;
      std::string const text = read_text(file.path().string());
      for (std::sregex_iterator found(text.begin(), text.end(), include), end; found != end; ++found, ++seen)
        EXPECT_LE(place((*found)[1]), place(room)) << file.path() << " includes from " << (*found)[1];
    }
  }
  EXPECT_GT(seen, 1000U);
}

}  // namespace
}  // namespace boltzmann::architecture_test
