// The page: what is embedded is what the repository has, built from its source as it is now; small, and fetching
// nothing.
#include <gtest/gtest.h>
#include <boltzmann/window/page.hpp>

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <string_view>
#include <vector>

namespace boltzmann::page_test {
namespace {

namespace fs = std::filesystem;

fs::path const window = fs::path(BOLTZMANN_SOURCE) / "boltzmann/window";

std::string text_of(fs::path const& path) {
  std::ifstream file(path, std::ios::binary);
  EXPECT_TRUE(file) << path << " can't be read";
  return {std::istreambuf_iterator<char>(file), {}};
}

// FNV-1a with 64 bits.
std::string digest(std::string_view text) {
  std::uint64_t sum = 0xCBF29CE484222325;
  for (char const c : text) sum = (sum ^ static_cast<unsigned char>(c)) * 0x100000001B3;
  char digits[17];
  std::snprintf(digits, sizeof digits, "%016llx", static_cast<unsigned long long>(sum));
  return digits;
}

// As vite.config.ts sums up the page's source: path, 0, content, 0 of each file in the order of the paths.
std::string source_of_page() {
  fs::path const web = window / "web";
  std::vector<std::string> paths{"index.html", "package-lock.json", "package.json", "tsconfig.json", "vite.config.ts"};
  for (fs::recursive_directory_iterator entry(web / "src"), end; entry != end; ++entry) {
    std::string const name = entry->path().filename();
    bool const passed_over = name.front() == '.' || name.back() == '~';
    if (passed_over && entry->is_directory()) entry.disable_recursion_pending();
    if (!passed_over && entry->is_regular_file())
      paths.push_back(entry->path().lexically_relative(web).generic_string());
  }
  std::sort(paths.begin(), paths.end());
  std::string all;
  for (std::string const& path : paths) all += path + '\0' + text_of(web / path) + '\0';
  return all;
}

TEST(Page, TheDigestIsFnv1a) {  // published values
  EXPECT_EQ(digest(""), "cbf29ce484222325");
  EXPECT_EQ(digest("a"), "af63dc4c8601ec8c");
  EXPECT_EQ(digest("foobar"), "85944171f73967e8");
}

TEST(Page, IsBuiltFromItsSource) {
  std::string const page = text_of(window / "page.html");
  EXPECT_NE(page.find("<meta name=\"boltzmann-source\" content=\"" + digest(source_of_page()) + "\">"),
            std::string::npos)
      << "boltzmann/window/page.html was not built from what is in boltzmann/window/web now; build it again (Node 18 "
         "or "
         "later):\n  cd boltzmann/window/web && npm ci && npm run build";
}

TEST(Page, IsEmbeddedAsItStandsInTheRepository) {
  EXPECT_TRUE(page_html() == text_of(window / "page.html")) << "the object file of page.cpp is older than page.html";
}

// The one script that stands in it is what the clients gives a nonce.
TEST(Page, HasOneScript) {
  std::string_view const page = page_html();
  auto const first = page.find("<script");
  ASSERT_NE(first, std::string_view::npos);
  EXPECT_TRUE(page.substr(first).starts_with("<script type=\"module\">"));
  auto const end = page.find("</script>", first);
  EXPECT_EQ(page.find("<script", end), std::string_view::npos);
  EXPECT_EQ(page.find("</script>", end + 1), std::string_view::npos);
}

TEST(Page, IsSmall) {
  std::string const command = "gzip -9 -c '" + (window / "page.html").string() + "' | wc -c";
  FILE* const counting = popen(command.c_str(), "r");
  ASSERT_NE(counting, nullptr);
  long bytes = 0;
  EXPECT_EQ(std::fscanf(counting, "%ld", &bytes), 1) << command;
  EXPECT_EQ(pclose(counting), 0) << command;
  EXPECT_GT(bytes, 5'000);  // of something
  EXPECT_LT(bytes, 100'000);
}

// What follows each `opening` in the page, a few characters of it.
std::vector<std::string> after(std::string_view opening) {
  std::string_view const page = page_html();
  std::vector<std::string> found;
  for (auto at = page.find(opening); at != page.npos; at = page.find(opening, at + 1))
    found.emplace_back(page.substr(at + opening.size(), 80));
  return found;
}

TEST(Page, FetchesNothing) {
  // No address of another machine but the names of namespaces, which nobody fetches; a text that ends behind the
  // slashes is completed by the page's own address.
  for (std::string const& rest : after("://"))
    EXPECT_TRUE(rest.starts_with("www.w3.org/") || std::string_view("\"'`$").find(rest.front()) != std::string::npos)
        << "://" << rest;
  // Nor one without its scheme, nor a script or a style beside the page.
  for (std::string const attribute : {"src=", "href=", "src:", "href:"})
    for (std::string const quote : {"", "\"", "'", "`"})
      EXPECT_EQ(after(attribute + quote + "//"), std::vector<std::string>{});
  for (std::string const call : {"url(", "url(\"", "url('"})
    for (std::string const& rest : after(call)) EXPECT_FALSE(rest.starts_with("//") || rest.starts_with("/")) << rest;
  for (char const* word : {"@import", "importScripts", "<script src", "<script type=\"module\" src", "<iframe"})
    EXPECT_EQ(after(word), std::vector<std::string>{}) << word;
  for (std::string const& rest : after("<link "))
    EXPECT_NE(rest.find("href=\"data:"), std::string::npos) << "<link " << rest;
}

}  // namespace
}  // namespace boltzmann::page_test
