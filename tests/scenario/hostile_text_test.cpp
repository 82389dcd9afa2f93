// Texts and files that nobody writes by hand: endless, nested without end, with letters that a terminal obeys.
#include "tests/bzm/command.hpp"
#include "tests/message.hpp"

#include <boltzmann/core/error.hpp>
#include <boltzmann/core/nesting.hpp>
#include <boltzmann/files/checkpoint.hpp>
#include <boltzmann/files/text_file.hpp>
#include <boltzmann/files/trajectory.hpp>
#include <boltzmann/laws/two_columns.hpp>
#include <boltzmann/loaders/particle_file.hpp>
#include <boltzmann/scenario/scenario.hpp>

#include <sys/stat.h>

#include <array>

namespace boltzmann::hostile_text_test {
namespace {

std::string repeated(std::string const& part, std::size_t times) {
  std::string text;
  for (std::size_t i = 0; i < times; ++i) text += part;
  return text;
}

TEST(Nesting, CountsBracketsAndDotsOutsideOfQuotes) {
  EXPECT_FALSE(nested_too_deep(""));
  EXPECT_FALSE(nested_too_deep(repeated("[", 64) + repeated("]", 64)));
  EXPECT_TRUE(nested_too_deep(repeated("[", 65)));
  EXPECT_TRUE(nested_too_deep("x = " + repeated("{ a = ", 65)));
  EXPECT_TRUE(nested_too_deep(repeated("a.", 65) + "b = 1"));
  EXPECT_TRUE(nested_too_deep(repeated("\"a\" . ", 65) + "b = 1"));
  EXPECT_TRUE(nested_too_deep("[" + repeated("a.", 65) + "b]"));
  // Side by side is not one in the other.
  EXPECT_FALSE(nested_too_deep(repeated("[1.5, 2.5],\n", 1000)));
  EXPECT_FALSE(nested_too_deep("x = [" + repeated("1.5, ", 1000) + "]"));
  EXPECT_FALSE(nested_too_deep("x = \"" + repeated("[.{", 100) + "\\\"" + repeated("[", 100) + "\""));
  EXPECT_FALSE(nested_too_deep("x = '" + repeated("[.{\\", 100) + "'"));
  EXPECT_FALSE(nested_too_deep("x = \"\"\"\n" + repeated("[.{\"\n", 100) + "\"\"\""));
  EXPECT_FALSE(nested_too_deep("# " + repeated("[", 100) + "\nx = 1"));
  for (std::string const ends : {"", "\"", "\"\""}) {  // of the text itself, before its end
    EXPECT_TRUE(nested_too_deep("x = [\"\"\"a" + ends + "\"\"\", " + repeated("[", 64))) << ends;
    EXPECT_FALSE(nested_too_deep("x = [\"\"\"a" + ends + "\"\"\", \"" + repeated("[", 100) + "\"]")) << ends;
  }
  EXPECT_TRUE(nested_too_deep("x = ''\n" + repeated("[", 65)));
  EXPECT_TRUE(nested_too_deep("x = \"no end\n" + repeated("[", 65)));
}

std::string mistakes(std::string const& text, Overrides const& overrides = {}) {
  return message([&] { parse_scenario(text, "x.toml", overrides); });
}

TEST(HostileText, NestedWithoutEndIsOneMistake) {
  std::string const told = "x.toml:1:1: tables and arrays are nested more than 64 deep";
  EXPECT_EQ(mistakes("x = " + repeated("[", 100000)), told);
  EXPECT_EQ(mistakes("x = " + repeated("[", 100000) + repeated("]", 100000)), told);
  EXPECT_EQ(mistakes(repeated("a.", 50000) + "b = 1"), told);
  EXPECT_EQ(mistakes("[" + repeated("a.", 50000) + "b]"), told);
  EXPECT_EQ(mistakes(repeated("x = { a = ", 50000)), told);
  std::string const good = read_scenario(find_scenario("three-body")).text;
  for (auto const& set : {"run.step=" + repeated("[", 50000), "run.step=" + repeated("{a=", 50000)})
    EXPECT_NE(mistakes(good, {{set}, {}, {}, {}}), "no error");
  auto const path = mistakes(good, {{repeated("a.", 50000) + "b=1"}, {}, {}, {}});
  EXPECT_NE(path.find("a path has at most 64 parts, not 50001"), std::string::npos);
}

TEST(HostileText, ControlCharactersAreMistakes) {
  std::string const good = read_scenario(find_scenario("three-body")).text;
  EXPECT_EQ(mistakes(good), "no error");
  for (std::string const letter : {"\\u0000", "\\u001b[2J", "\\u007f", "\\u009b", "\\b"}) {
    auto const told = mistakes(good, {{"title=\"a" + letter + "b\""}, {}, {}, {}});
    EXPECT_NE(told.find("a text has a control character"), std::string::npos) << letter << ": " << told;
    EXPECT_NE(mistakes(good, {{"output.pictures.0.file=\"checkpoint.h5" + letter + ".png\""}, {}, {}, {}}), "no error")
        << letter;
  }
  EXPECT_EQ(mistakes(good, {{"description=\"two\\nlines\\tand ä\""}, {}, {}, {}}), "no error");
}

// Every reader, and what is no file to be read.
TEST(HostileText, OnlyRegularFilesAreRead) {
  test::Folder folder;
  std::string const pipe = (folder / "pipe").string();
  ASSERT_EQ(mkfifo(pipe.c_str(), 0600), 0);
  std::vector<std::pair<char const*, std::function<void(std::string const&)>>> const readers = {
      {"scenario", [](auto const& path) { load_scenario(path); }},
      {"XYZ", [](auto const& path) { from_xyz_file(path); }},
      {"table", [](auto const& path) { read_two_columns(path, "the distance", "the energy", true); }},
      {"text", [](auto const& path) { read_text(path); }},
      {"checkpoint", [](auto const& path) { read_checkpoint(path); }},
      {"trajectory", [](auto const& path) { TrajectoryReader const reader(path); }}};
  for (auto const& [name, one] : readers) {
    auto const& read = one;
    for (std::string const& path : {std::string("/dev/zero"), std::string("/dev/null"), pipe})
      EXPECT_EQ(message([&] { read(path); }), "'" + path + "' is a device or a pipe, not a file") << name;
    EXPECT_EQ(message([&] { read(folder.string()); }), "'" + folder.string() + "' is a directory, not a file") << name;
  }
}

TEST(HostileText, LinesEnd) {
  test::Folder folder;
  std::string const path = (folder / "long.xyz").string();
  test::write_text(path, "1\n" + std::string(3000000, 'x') + "\nA 0 0 0\n");
  std::string const told = "'" + path + "' has a line of more than 1 MB: it is no file of text";
  EXPECT_EQ(message([&] { from_xyz_file(path); }), told);
  test::write_text(path, "0.5 " + std::string(10000, ' ') + "1\n" + std::string(4091, '0') + "1 2\n\n# end\n2 " +
                             std::string(4093, '0'));
  EXPECT_EQ(read_two_columns(path, "the distance", "the energy", true),
            (std::vector<std::array<double, 2>>{{0.5, 1}, {1, 2}, {2, 0}}));
  test::write_text(path, std::string(3000000, '1'));
  EXPECT_EQ(message([&] { read_two_columns(path, "the distance", "the energy", true); }), told);
}

}  // namespace
}  // namespace boltzmann::hostile_text_test
