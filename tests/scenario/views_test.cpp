// [[views]]: diagnoses for the window by field names, read as pictures are, and what is told of mistakes in them.
#include "mistakes.hpp"

#include <boltzmann/pictures/picture_options.hpp>
#include <boltzmann/scenario/picture_words.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::views_test {
namespace {

using test::Mistake;
using test::mistake_name;

std::string const plain =
    "[units]\n"                                                                     // 1
    "base = \"custom\"\n"                                                           // 2
    "length = \"1 angstrom\"\n"                                                     // 3
    "mass = \"1 amu\"\n"                                                            // 4
    "time = \"1 ps\"\n"                                                             // 5
    "[box]\n"                                                                       // 6
    "low = [0, 0]\n"                                                                // 7
    "high = [20, 20]\n"                                                             // 8
    "[run]\n"                                                                       // 9
    "step = 0.01\n"                                                                 // 10
    "steps = 20\n"                                                                  // 11
    "[[ensembles]]\n"                                                               // 12
    "name = \"atoms\"\n"                                                            // 13
    "class = \"Newton\"\n"                                                          // 14
    "mass = \"40 amu\"\n"                                                           // 15
    "load = { kind = \"block\", spacing = 4, counts = [4, 4] }\n"                   // 16
    "[[diagnoses]]\n"                                                               // 17
    "kind = \"energies\"\n";                                                        // 18
std::string view(std::string const& keys) { return plain + "[[views]]\n" + keys; }  // 19, 20 ...

PicturePlan only_view(std::string const& keys) {
  auto const scenario = parse_scenario(view(keys), "test.toml");
  EXPECT_EQ(scenario->views.size(), 1U);
  EXPECT_TRUE(scenario->output.pictures.empty());
  return scenario->views.empty() ? PicturePlan{} : scenario->views.front();
}

TEST(Views, AreDiagnosesByFieldNames) {
  auto const kinetic = only_view(
      "name = \"Kinetic\"\nx = \"position.x\"\ny = \"velocity.x\"\ncolour = \"speed\"\nsize = \"mass\"\n"
      "low = \"100 m/s\"\nhigh = 5\n");
  EXPECT_EQ(kinetic.name, "Kinetic");
  EXPECT_EQ(kinetic.drawing, "phase-space");
  EXPECT_EQ(kinetic.x, "position.x");
  EXPECT_EQ(kinetic.y, "velocity.x");
  EXPECT_EQ(kinetic.colour, "speed");
  EXPECT_EQ(kinetic.size, "mass");
  EXPECT_DOUBLE_EQ(kinetic.low, 1);  // 1 angstrom/ps is 100 m/s
  EXPECT_EQ(kinetic.high, 5);
}

TEST(Views, WithoutAxesShowTheParticlesInSpace) {
  auto const hot = only_view("name = \"Hot\"\ncolour = \"kinetic-energy\"\n");
  EXPECT_EQ(hot.drawing, "cartesian");
  EXPECT_TRUE(std::isnan(hot.low));
  EXPECT_EQ(hot.vectors, "");
  EXPECT_EQ(only_view("name = \"Flow\"\nvectors = \"velocity\"\n").vectors, "velocity");
  EXPECT_EQ(only_view("name = \"y\"\ny = \"velocity.y\"\nx = \"velocity.x\"\n").drawing, "phase-space");
  EXPECT_EQ(only_view("name = \"m\"\ndrawing = \"map\"\ny = \"density\"\ncells = 50\nrange = 6\n").cells, 50);
  auto const energy = only_view("name = \"E\"\ndrawing = \"time-series\"\ny = \"total energy\"\nlogarithmic = true\n");
  EXPECT_EQ(energy.y, "total energy");
  EXPECT_TRUE(energy.logarithmic);
}

TEST(Views, OfOneScenarioAreMany) {
  auto const scenario =
      parse_scenario(view("name = \"a\"\n[[views]]\nname = \"b\"\ndrawing = \"profile\"\ny = \"velocity.x\"\n[output]\n"
                          "[[output.pictures]]\nfile = \"p.png\"\n"),
                     "test.toml");
  ASSERT_EQ(scenario->views.size(), 2U);
  EXPECT_EQ(scenario->views[0].name, "a");
  EXPECT_EQ(scenario->views[1].drawing, "profile");
  ASSERT_EQ(scenario->output.pictures.size(), 1U);
  EXPECT_EQ(scenario->output.pictures[0].name, "");
  // They are stored with the run, and read back.
  auto const again = parse_scenario(scenario->resolved, "again.toml");
  ASSERT_EQ(again->views.size(), 2U);
  EXPECT_EQ(again->views[1].y, "velocity.x");
  EXPECT_TRUE(parse_scenario(plain, "test.toml")->views.empty());
}

// A table says what can be said of a drawing: a scenario can say it.
TEST(Views, SayEverythingOfADrawing) {
  std::map<std::string, std::string> const values{{"x", "\"position.x\""},
                                                  {"y", "\"velocity.x\""},
                                                  {"colour", "\"speed\""},
                                                  {"size", "\"mass\""},
                                                  {"vectors", "\"velocity\""},
                                                  {"low", "1"},
                                                  {"high", "2"},
                                                  {"logarithmic", "true"},
                                                  {"trace", "false"},
                                                  {"streaklines", "false"},
                                                  {"gap", "\"3 nm\""},
                                                  {"slice", "\"x\""},
                                                  {"at", "\"0.5 nm\""},
                                                  {"levels", "[1, \"200 m/s\"]"},
                                                  {"weight", "\"wendland\""},
                                                  {"range", "6"},
                                                  {"cells", "7"},
                                                  {"bins", "7"},
                                                  {"azimuth", "10"},
                                                  {"elevation", "\"0.5 rad\""},
                                                  {"most", "5"},
                                                  {"region", "[[0, 5], [1, 9], [0, 9]]"}};
  std::string cube = plain;
  for (auto const& [two, three] : {std::pair{"low = [0, 0]", "low = [0, 0, 0]"},
                                   {"high = [20, 20]", "high = [20, 20, 20]"},
                                   {"[4, 4]", "[4, 4, 4]"}})
    cube.replace(cube.find(two), std::string(two).size(), three);
  for (auto const& drawing : drawings()) {
    if (drawing.name == "mesh" || drawing.name == "wave-spectrum" || drawing.name == "time-series" ||
        drawing.name == "curves")
      continue;
    if (drawing.name == "flow" || drawing.name == "streamlines") continue;  // of vortices
    std::string text = cube + "[[views]]\nname = \"all\"\ndrawing = \"" + drawing.name + "\"\n";
    for (auto const& option : drawing.options) {
      ASSERT_TRUE(values.contains(option.key)) << option.key;
      text += option.key + " = " + values.at(option.key) + "\n";
    }
    auto const scenario = parse_scenario(text, "test.toml");
    Picture read = scenario->views.at(0), plain_picture;
    for (auto const& option : drawing.options) {
      if (option.key == "trace" || option.key == "streaklines") continue;
      EXPECT_NE(toml_value(option, &read), toml_value(option, &plain_picture)) << drawing.name << ' ' << option.key;
    }
    if (drawing.name == "cartesian") {
      EXPECT_EQ(read.projection.azimuth, 10);
      EXPECT_NEAR(read.projection.elevation, 28.6479, 1e-4);  // pages and C++ count degrees
    }
    if (drawing.name == "contours") {
      ASSERT_EQ(read.levels.size(), 2U);
      EXPECT_DOUBLE_EQ(read.levels[1], 2);
      EXPECT_EQ(read.at, 5);
    }
  }
}

// What a command says replaces what the scenario's picture says, whichever way each has it.
TEST(Pictures, AreSaidOtherwiseByWords) {
  auto const run =
      parse_scenario(plain + "[output]\n[[output.pictures]]\ndrawing = \"contours\"\nlevels = [1, 2]\n", "test.toml");
  auto const count = picture_by_words(*run, {{"drawing", "contours"}, {"levels", "8"}});
  EXPECT_EQ(count.level_count, 8);
  EXPECT_TRUE(count.levels.empty());
  EXPECT_EQ(picture_by_words(*run, {{"levels", "3, 4, 5"}}).levels, (std::vector<double>{3, 4, 5}));
  EXPECT_EQ(picture_by_words(*run, {}).levels, (std::vector<double>{1, 2}));
  EXPECT_THROW(picture_by_words(*run, {{"drawing", "cartesian"}, {"low", "1"}}), ScenarioErrors);  // of no colour
}

TEST(Pictures, KeepTheEndsOfTheQuantityThatWordsAskFor) {
  auto const run = parse_scenario(plain + "[output]\n[[output.pictures]]\ncolour = \"speed\"\nhigh = 3\n" +
                                      "[[output.pictures]]\nfile = \"masses.png\"\ncolour = \"mass\"\nhigh = 2\n",
                                  "test.toml");
  EXPECT_EQ(picture_by_words(*run, {}).high, 3);
  EXPECT_EQ(picture_by_words(*run, {{"colour", "speed"}}).high, 3);
  EXPECT_EQ(picture_by_words(*run, {{"colour", "mass"}}).high, 2);
  EXPECT_TRUE(std::isnan(picture_by_words(*run, {{"colour", "velocity.x"}}).high));
  EXPECT_EQ(picture_by_words(*run, {{"colour", "velocity.x"}, {"high", "4"}}).high, 4);
}

TEST(Views, AreNamedOnTheCommandLine) {
  Overrides overrides;
  overrides.set = {"views.Hot.colour=speed"};
  auto const scenario = parse_scenario(view("name = \"Hot\"\ncolour = \"mass\"\n"), "test.toml", overrides);
  EXPECT_EQ(scenario->views[0].colour, "speed");
  bool found = false;
  for (auto const& parameter : scenario->parameters) found = found || parameter.path == "views.Hot.colour";
  EXPECT_TRUE(found);
}

TEST(Histograms, AreReadAsViewsAndPictures) {
  auto const of_speed =
      only_view("name = \"Speeds\"\ndrawing = \"histogram\"\nx = \"speed\"\nbins = 20\nlogarithmic = true\n");
  EXPECT_EQ(of_speed.drawing, "histogram");
  EXPECT_EQ(of_speed.x, "speed");
  EXPECT_EQ(of_speed.bins, 20);
  EXPECT_TRUE(of_speed.logarithmic);
  auto const picture = parse_scenario(
      plain + "[output]\n[[output.pictures]]\ndrawing = \"histogram\"\nx = \"velocity.x\"\n", "test.toml");
  EXPECT_EQ(picture->output.pictures.at(0).x, "velocity.x");
}

class ViewMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(ViewMistakes, AreToldInOneLine) { test::expect_one_line(GetParam()); }

INSTANTIATE_TEST_SUITE_P(
    All, ViewMistakes,
    testing::Values(
        Mistake{"no name", view("colour = \"speed\"\n"), "19:1", {"[[views]]", "no 'name'", "name = \"Kinetic\""}},
        Mistake{"empty name", view("name = \"\"\n"), "20:8", {"needs a name"}},
        Mistake{"name no text", view("name = 3\n"), "20:8", {"name", "a text is needed"}},
        Mistake{"same name", view("name = \"a\"\n[[views]]\nname = \"a\"\n"), "22:8", {"view 'a' already"}},
        Mistake{
            "drawing", view("name = \"a\"\ndrawing = \"histogramm\"\n"), "21:11", {"unknown drawing", "'histogram'?"}},
        Mistake{"a file", view("name = \"a\"\nfile = \"a.png\"\n"), "21:1", {"unknown key 'file'", "[[views]] 'a'"}},
        Mistake{"key",
                view("name = \"a\"\ncolor = \"speed\"\n"),
                "21:1",
                {"unknown key 'color'", "did you mean 'colour'?"}},
        Mistake{"field",
                view("name = \"a\"\nx = \"position.x\"\ny = \"velocty.x\"\n"),
                "22:5",
                {"velocty.x", "did you mean"}},
        Mistake{
            "x", view("name = \"a\"\nx = \"positon.x\"\ny = \"velocity.x\"\n"), "21:5", {"positon.x", "did you mean"}},
        Mistake{"colour", view("name = \"a\"\ncolour = \"sped\"\nlow = \"1 m/s\"\n"), "21:10", {"'speed'?"}},
        Mistake{"size",
                view("name = \"a\"\nx = \"position.x\"\ny = \"velocity.x\"\nsize = \"mas\"\n"),
                "23:8",
                {"'mass'?"}},
        Mistake{"low", view("name = \"a\"\nlow = 1\n"), "21:7", {"no 'colour'"}},
        Mistake{"unit",
                view("name = \"a\"\ncolour = \"speed\"\nhigh = \"1 K\"\n"),
                "22:8",
                {"high", "a velocity is needed"}},
        Mistake{"trace", view("name = \"a\"\ntrace = true\n"), "21:9", {"trajectory"}},
        Mistake{"column",
                view("name = \"a\"\ndrawing = \"time-series\"\ny = \"total enrgy\"\n"),
                "22:5",
                {"'total energy'?"}},
        Mistake{"histogram of nothing known",
                view("name = \"a\"\ndrawing = \"histogram\"\nx = \"sped\"\n"),
                "22:5",
                {"'speed'?"}},
        Mistake{"histogram with y",
                view("name = \"a\"\ndrawing = \"histogram\"\nx = \"speed\"\ny = \"mass\"\n"),
                "23:1",
                {"unknown key 'y'"}},
        Mistake{"histogram without bins",
                view("name = \"a\"\ndrawing = \"histogram\"\nx = \"speed\"\nbins = 0\n"),
                "23:8",
                {"out of range"}},
        Mistake{"vectors", view("name = \"a\"\nvectors = \"velocty\"\n"), "21:11", {"'velocity'?"}},
        Mistake{"vectors in phase space",
                view("name = \"a\"\nx = \"position.x\"\ny = \"velocity.x\"\nvectors = \"velocity\"\n"),
                "23:1",
                {"unknown key 'vectors'"}},
        Mistake{"no mesh", view("name = \"a\"\ndrawing = \"mesh\"\n"), "21:11", {"needs a mesh"}},
        Mistake{"one table", plain + "[views]\nname = \"a\"\n", "19:1", {"[[views]] (two brackets)"}}),
    mistake_name);

TEST(ViewMistakes, WithoutParticlesNobodyKnowsWhatColoursMean) {
  std::string const text =
      test::replaced(view("name = \"a\"\ncolour = \"speed\"\nlow = \"1 m/s\"\n"), "spacing = 4", "spacing = 0");
  auto const lines = test::mistakes_of(text);
  ASSERT_EQ(lines.size(), 1U) << testing::PrintToString(lines);
  EXPECT_NE(lines[0].find("spacing"), std::string::npos);
}

TEST(ViewMistakes, OfWhatIsMissing) {
  test::expect_mistakes_of_what_is_missing(
      view("name = \"Kinetic\"\nx = \"position.x\"\ny = \"velocity.x\"\ncolour = \"speed\"\nlow = \"1 m/s\"\n"), 300,
      10);
}

}  // namespace
}  // namespace boltzmann::views_test
