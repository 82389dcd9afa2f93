// The list of modules in docs/develop/architecture.md is complete, and a module includes only itself and modules above
// it. Functions have at most 60 lines, or a comment that gives the reason.
#include <boltzmann/files/text_file.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <regex>
#include <sstream>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann::architecture_test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> modules() {
  std::istringstream page(read_text(std::string(BOLTZMANN_SOURCE) + "/docs/develop/architecture.md"));
  std::vector<std::string> all;
  std::string line;
  while (std::getline(page, line) && !line.starts_with("| module |")) {
  }
  std::getline(page, line);  // below the head
  while (std::getline(page, line) && line.starts_with("| ")) all.push_back(line.substr(2, line.find(" |") - 2));
  return all;
}

TEST(Architecture, ModulesIncludeOnlyThoseAbove) {
  auto const all = modules();
  auto const place = [&](std::string const& name) { return std::find(all.begin(), all.end(), name) - all.begin(); };
  std::regex const include("#include <boltzmann/(\\w+)/");
  std::size_t seen = 0;
  for (auto const& folder : fs::directory_iterator(std::string(BOLTZMANN_SOURCE) + "/boltzmann")) {
    if (!folder.is_directory() || fs::is_empty(folder)) continue;
    std::string const name = folder.path().filename();
    ASSERT_LT(place(name), std::ssize(all)) << "docs/develop/architecture.md does not list the module " << name;
    for (auto const& file : fs::recursive_directory_iterator(folder)) {
      auto const ending = file.path().extension();
      if (file.path().string().find("/web/") != std::string::npos || (ending != ".cpp" && ending != ".hpp")) continue;
      std::string const text = read_text(file.path().string());
      for (std::sregex_iterator found(text.begin(), text.end(), include), end; found != end; ++found, ++seen)
        EXPECT_LE(place((*found)[1]), place(name)) << file.path() << " includes the module " << (*found)[1];
    }
  }
  EXPECT_GT(seen, 1000U);
}

/// The end of the comment or literal that starts at `from`, or `from` if none starts there.
std::size_t end_of_text(std::string const& code, std::size_t from) {
  if (std::string_view("/R\"'").find(code[from]) == std::string_view::npos) return from;
  auto const behind = [&](std::string const& what, std::size_t at) {
    std::size_t const end = code.find(what, at);
    return end == std::string::npos ? code.size() : end + what.size();
  };
  bool const in_word = from > 0 && std::isalnum(static_cast<unsigned char>(code[from - 1])) != 0;
  if (code.compare(from, 2, "//") == 0) return behind("\n", from) - 1;
  if (code.compare(from, 2, "/*") == 0) return behind("*/", from);
  if (code.compare(from, 2, "R\"") == 0 && !in_word)
    return behind(")" + code.substr(from + 2, code.find('(', from) - from - 2) + "\"", from);
  char const quote = code[from];
  if (quote != '"' && (quote != '\'' || in_word)) return from;  // 10'000
  std::size_t at = from + 1;
  while (at < code.size() && code[at] != quote) at += code[at] == '\\' ? 2 : 1;
  return at + 1;
}

struct Function {
  std::size_t at, lines;
  bool has_reason;
};

/// All functions of a source, from the first line of the declaration to the closing brace.
std::vector<Function> functions_of(std::string const& code) {
  std::vector<Function> all;
  std::size_t head = 0, inside = 0, body = 0;  // inside: open braces since the start of a function
  std::string words;                           // since the last statement
  auto const lines_between = [&](std::size_t from, std::size_t to) {
    return static_cast<std::size_t>(std::count(code.data() + from, code.data() + to, '\n'));
  };
  auto const is_function = [&] {
    auto const last = words.find_last_not_of(' ');
    auto const parameters = words.rfind(')');
    if (parameters == std::string::npos || words[last] == '=') return false;
    static std::regex const type("\\b(class|struct|union|enum)\\b"), behind(" *((const|noexcept|override|->.*) *)*");
    return !std::regex_search(words, type) || std::regex_match(words.substr(parameters + 1, last - parameters), behind);
  };
  for (std::size_t at = 0; at < code.size();) {
    if (std::size_t const end = end_of_text(code, at); end != at) {
      at = end;
      continue;
    }
    char const c = code[at++];
    if (c == '#' && (at < 2 || code[at - 2] == '\n')) {
      at = code.find('\n', at);
    } else if (c == '{') {
      if (inside > 0 || is_function()) ++inside;
      if (inside == 1) body = at;
      if (inside == 0) words.clear();
    } else if (c == '}') {
      if (inside == 1) all.push_back({head, lines_between(head, at) + 1, code.compare(body, 11, "  // long: ") == 0});
      if (inside > 0) --inside;
      if (inside == 0) words.clear();
    } else if (inside == 0) {
      if (words.empty() && std::isspace(static_cast<unsigned char>(c)) == 0) head = at - 1;
      if (c == ';')
        words.clear();
      else if (!words.empty() || std::isspace(static_cast<unsigned char>(c)) == 0)
        words += c == '\n' ? ' ' : c;
    }
  }
  return all;
}

TEST(Architecture, FunctionsAreShortOrGiveTheReason) {
  constexpr std::size_t most = 60;
  std::size_t seen = 0;
  for (std::string const folder : {"/boltzmann", "/python/module"})
    for (auto const& file : fs::recursive_directory_iterator(std::string(BOLTZMANN_SOURCE) + folder)) {
      auto const ending = file.path().extension();
      if (ending != ".cpp" && ending != ".hpp") continue;
      std::string const code = read_text(file.path().string());
      for (auto const& [at, lines, has_reason] : functions_of(code)) {
        ++seen;
        EXPECT_TRUE(lines <= most || has_reason)
            << file.path() << ":" << std::count(code.data(), code.data() + at, '\n') + 1 << ": a function of " << lines
            << " lines; split it, or give the reason in its first line: {  // long: a table";
      }
    }
  EXPECT_GT(seen, 6000U);
}

}  // namespace
}  // namespace boltzmann::architecture_test
