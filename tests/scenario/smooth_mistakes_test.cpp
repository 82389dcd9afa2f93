// Mistakes in scenarios of smooth particles: what users get wrong, and what they are told.
#include "mistakes.hpp"

#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <string>
#include <utility>
#include <vector>

namespace boltzmann::smooth_mistakes_test {
namespace {

using test::Mistake;
using test::mistake_name;
using test::mistakes_of;

// A scenario without mistakes; the numbers on the right are those of the lines.
std::string const good =
    "[units]\n"                                                                                // 1
    "base = \"reduced\"\n"                                                                     // 2
    "[box]\n"                                                                                  // 3
    "low = [0, 0]\n"                                                                           // 4
    "high = [2, 1]\n"                                                                          // 5
    "boundary = [\"periodic\", \"mirror\"]\n"                                                  // 6
    "[[box.walls]]\n"                                                                          // 7
    "axis = \"y\"\n"                                                                           // 8
    "end = \"low\"\n"                                                                          // 9
    "slips = false\n"                                                                          // 10
    "[run]\n"                                                                                  // 11
    "step = { courant = 0.5 }\n"                                                               // 12
    "time = 0.1\n"                                                                             // 13
    "[smooth]\n"                                                                               // 14
    "weight = \"wendland\"\n"                                                                  // 15
    "artificial_viscosity = { alpha = 1 }\n"                                                   // 16
    "[[ensembles]]\n"                                                                          // 17
    "name = \"gas\"\n"                                                                         // 18
    "class = \"Smooth\"\n"                                                                     // 19
    "range = 0.3\n"                                                                            // 20
    "density = 1\n"                                                                            // 21
    "load = { kind = \"fill\", spacing = 0.1 }\n"                                              // 22
    "material = { kind = \"ideal-gas\", gamma = 1.4 }\n"                                       // 23
    "formulas = { specific_energy = \"1 + 0.1*sin(pi*x)\", velocity = [\"y*(1 - y)\", 0] }\n"  // 24
    "[[ensembles.set]]\n"                                                                      // 25
    "where = \"x < 0.5\"\n"                                                                    // 26
    "velocity = [0, 0]\n"                                                                      // 27
    "[[influences]]\n"                                                                         // 28
    "law = \"uniform-gravity\"\n"                                                              // 29
    "on = \"gas\"\n"                                                                           // 30
    "acceleration = [0, -1]\n"                                                                 // 31
    "[[diagnoses]]\n"                                                                          // 32
    "kind = \"energies\"\n";                                                                   // 33

std::string with(std::string const& old, std::string const& now, std::string text = good) {
  return test::replaced(std::move(text), old, now);
}
std::string material(std::string const& table) {
  return with("material = { kind = \"ideal-gas\", gamma = 1.4 }", "material = " + table);
}
std::string solid(std::string const& table) { return with("\"Smooth\"", "\"Solid\"", material(table)); }
std::string formula(std::string const& text) { return with("1 + 0.1*sin(pi*x)", text); }
std::string load(std::string const& table) {
  std::string line = "load = ";
  line += table;
  return with("load = { kind = \"fill\", spacing = 0.1 }", line);
}

/// With a picture at the end: [[output.pictures]] is line 34, drawing line 35, the keys from line 36 on.
std::string picture(std::string const& drawing, std::string const& keys) {
  return good + "[[output.pictures]]\ndrawing = \"" + drawing + "\"\n" + keys;
}
std::string entropy(std::string const& key) { return good + "[[diagnoses]]\nkind = \"entropy\"\n" + key; }

std::vector<Mistake> const rows{
    // Walls.
    {"wall on a periodic axis",
     with("axis = \"y\"", "axis = \"x\""),
     "8:8",
     {"x is periodic", "boundary is \"mirror\""}},
    {"wall on an axis that is not there", with("axis = \"y\"", "axis = \"z\""), "8:8", {"unknown axis 'z'", "x, y"}},
    {"wall at no end", with("\"low\"", "\"left\""), "9:7", {"unknown end 'left'", "low, high"}},
    {"wall without an end", with("end = \"low\"\n", ""), "7:1", {"[[box.walls]] has no 'end'", "end = \"low\""}},
    {"slips as a number", with("slips = false", "slips = 0"), "10:9", {"true or false", "0"}},
    {"velocity of an open end",
     with("slips = false", "open = true\nvelocity = [0, 1]"),
     "11:12",
     {"velocity", "open = true"}},
    {"cold wall", with("slips = false", "temperature = -1"), "10:15", {"temperature", "zero or more"}},
    {"unknown key of a wall", with("slips", "slip"), "10:1", {"unknown key 'slip'", "did you mean 'slips'?"}},
    {"walls as a table", with("[[box.walls]]", "[box.walls]"), "7:1", {"[[walls]]", "two brackets"}},
    {"unknown boundary", with("\"mirror\"", "\"miror\""), "6:25", {"unknown boundary", "did you mean 'mirror'?"}},
    // The run.
    {"time and steps", with("time = 0.1", "time = 0.1\nsteps = 3"), "13:8", {"'steps'", "leave one out"}},
    {"negative time", with("time = 0.1", "time = -1"), "13:8", {"time", "zero or more"}},
    {"neither time nor steps", with("time = 0.1\n", ""), "11:1", {"no 'steps'"}},
    {"negative part of a Courant step", with("courant = 0.5", "courant = -1"), "12:20", {"courant", "positive"}},
    {"unknown kind of step",
     with("courant = 0.5", "currant = 1"),
     "12:10",
     {"unknown key 'currant'", "did you mean 'courant'?"}},
    {"a word for a step", with("{ courant = 0.5 }", "\"currant\""), "12:8", {"step"}},
    {"a step far above sound", with("{ courant = 0.5 }", "1.0"), "12:8", {"step", "far above"}},
    {"cut-off", with("time = 0.1", "time = 0.1\ncutoff = 0.3"), "14:10", {"'range'", "leave it out"}},
    {"skin of pairs", with("time = 0.1", "time = 0.1\nskin = 0.3"), "14:8", {"[smooth]"}},
    // [smooth].
    {"unknown weight",
     with("\"wendland\"", "\"wendlend\""),
     "15:10",
     {"unknown weight 'wendlend'", "lucy", "quintic-spline", "did you mean 'wendland'?"}},
    {"unknown density",
     with("weight = \"wendland\"", "density = \"sum\""),
     "15:11",
     {"unknown density 'sum'", "summation, continuity"}},
    {"unknown mean", with("weight = \"wendland\"", "mean_density = \"mean\""), "15:16", {"arithmetic, geometric"}},
    {"unknown heating", with("weight = \"wendland\"", "heating = \"all\""), "15:11", {"shared, own"}},
    {"unknown key", with("weight", "wieght"), "15:1", {"unknown key 'wieght' in [smooth]", "did you mean 'weight'?"}},
    {"viscosity as a number",
     with("{ alpha = 1 }", "1"),
     "16:24",
     {"a table is needed", "{ alpha = 1, beta = 2, balsara = false }"}},
    {"negative viscosity", with("alpha = 1", "alpha = -1"), "16:34", {"alpha", "zero or more"}},
    {"unknown part of the viscosity", with("alpha = 1", "alfa = 1"), "16:26", {"'alfa'", "did you mean 'alpha'?"}},
    {"negative spacings",
     with("weight = \"wendland\"", "variable_range = { spacings = 0 }"),
     "15:31",
     {"spacings", "positive"}},
    {"longest below shortest",
     with("weight = \"wendland\"", "variable_range = { shortest = 0.2, longest = 0.1 }"),
     "15:46",
     {"longest", "0.1", "0.2"}},
    {"variable ranges over continuity",
     with("weight = \"wendland\"", "density = \"continuity\"\nvariable_range = { spacings = 3 }"),
     "16:18",
     {"variable_range", "continuity"}},
    {"smooth twice", with("weight = \"wendland\"", "skin = -1"), "15:8", {"skin", "zero or more"}},
    {"a skin from wall to wall", with("weight = \"wendland\"", "skin = 3"), "11:1", {"axis y", "1 apart", "reach 3.3"}},
    {"fewer spacings than one weighs itself",
     with("weight = \"wendland\"", "weight = \"wendland\"\nvariable_range = { spacings = 0.5 }"),
     "16:18",
     {"no ranges of 0.5 spacings", "more than 1.49"}},
    {"spacings that need more than the box",
     with("weight = \"wendland\"", "variable_range = { spacings = 30 }"),
     "15:18",
     {"the range 1.2", "axis y", "at most 1", "'longest'"}},
    {"merging from afar",
     with("weight = \"wendland\"", "rezone = { every = 5, merge_below = 1, largest_mass = 1, merge_within = 10 }"),
     "15:73",
     {"merge_within", "above 0, at most 1"}},
    {"mesh and smooth",
     with("[smooth]", "[mesh]\nlaw = \"gravity\"\nG = 1\ncells = 8\n[smooth]",
          with("\"mirror\"", "\"periodic\"", with("[[box.walls]]\naxis = \"y\"\nend = \"low\"\nslips = false\n", ""))),
     "10:1",
     {"[mesh]: no ensemble makes a field", "with 'on' any other that has a mass"}},
    {"no scheme",
     with("[smooth]\nweight = \"wendland\"\nartificial_viscosity = { alpha = 1 }\n", "",
          with("{ courant = 0.5 }", "0.01",
               with("law = \"uniform-gravity\"\non = \"gas\"\nacceleration = [0, -1]\n[[diagnoses]]\nkind = "
                    "\"energies\"\n",
                    "", with("[[influences]]\n", "")))),
     "16:9",
     {"class Smooth", "[smooth]"}},
    {"heat shared with what keeps none",
     good +
         "[[ensembles]]\nname = \"water\"\nclass = \"Smooth\"\nrange = 0.3\nload = { kind = \"positions\", positions "
         "= [[1, 0.52]] }\nmaterial = { kind = \"tait\", reference_density = 1, sound_speed = 1 }\n",
     "14:1",
     {"heating", "'water' follows from its density", "'gas' does not", "heating = \"own\""}},
    // Ensembles.
    {"no material",
     with("material = { kind = \"ideal-gas\", gamma = 1.4 }\n", ""),
     "17:1",
     {"no 'material'", "ideal-gas"}},
    {"material as a word", material("\"ideal-gas\""), "23:12", {"material: a table is needed", "kind = "}},
    {"unknown material",
     material("{ kind = \"idael-gas\", gamma = 1.4 }"),
     "23:21",
     {"unknown material 'idael-gas'", "tait", "van-der-waals", "table", "did you mean 'ideal-gas'?"}},
    {"material without a kind", material("{ gamma = 1.4 }"), "23:12", {"no 'kind'"}},
    {"material without a parameter",
     material("{ kind = \"tait\", sound_speed = 1 }"),
     "23:12",
     {"'tait' needs 'reference_density'", "where the pressure is the background"}},
    {"unknown parameter of a material",
     material("{ kind = \"ideal-gas\", gama = 1.4, gamma = 1.4 }"),
     "23:34",
     {"unknown key 'gama'", "material 'ideal-gas'", "did you mean 'gamma'?"}},
    {"gamma of one",
     material("{ kind = \"ideal-gas\", gamma = 1 }"),
     "23:42",
     {"gamma", "1 is out of range", "above 1"}},
    {"negative viscosity of a material",
     material("{ kind = \"ideal-gas\", gamma = 1.4, shear_viscosity = -1 }"),
     "23:65",
     {"shear_viscosity", "zero or more"}},
    {"conduction without a temperature",
     material("{ kind = \"quadratic-gas\", conductivity = 1 }"),
     "23:53",
     {"conductivity", "'quadratic-gas' has no temperature"}},
    {"table without points", material("{ kind = \"table\" }"), "23:12", {"'points' or 'file'"}},
    {"table with points and a file",
     material("{ kind = \"table\", points = [[1, 0], [2, 1]], file = \"x\" }"),
     "23:39",
     {"one of them"}},
    {"points that are none",
     material("{ kind = \"table\", points = [1, 2] }"),
     "23:40",
     {"pairs of a density and a pressure", "1"}},
    {"one point", material("{ kind = \"table\", points = [[1, 0]] }"), "23:39", {"at least 2"}},
    {"densities that fall", material("{ kind = \"table\", points = [[2, 0], [1, 1]] }"), "23:39", {"must be above 2"}},
    {"no such table",
     material("{ kind = \"table\", file = \"no-such-file.txt\" }"),
     "23:37",
     {"no-such-file.txt", "can't open"}},
    {"strength of a gas",
     material("{ kind = \"ideal-gas\", gamma = 1.4, elastic = { shear_modulus = 1 } }"),
     "23:57",
     {"class Smooth have no strength", "Solid"}},
    {"solid without strength", solid("{ kind = \"ideal-gas\", gamma = 1.4 }"), "23:12", {"'elastic'", "shear_modulus"}},
    {"solid without a modulus",
     solid("{ kind = \"ideal-gas\", gamma = 1.4, elastic = {} }"),
     "23:57",
     {"elastic needs 'shear_modulus'"}},
    {"unknown part of the strength",
     solid("{ kind = \"ideal-gas\", gamma = 1.4, elastic = { shear_modulus = 1, yeild_stress = 1 } }"),
     "23:78",
     {"unknown key 'yeild_stress'", "did you mean 'yield_stress'?"}},
    {"a given pressure", with("density = 1", "density = 1\npressure = 3"), "22:12", {"pressure", "specific_energy"}},
    {"a temperature", with("density = 1", "density = 1\ntemperature = 3"), "22:15", {"temperature", "specific_energy"}},
    {"a pressure by a formula",
     with("specific_energy =", "pressure ="),
     "24:25",
     {"pressure", "density and specific_energy"}},
    {"mass and density", with("density = 1", "density = 1\nmass = 1"), "21:11", {"'mass'", "leave one out"}},
    {"density without volumes",
     load("{ kind = \"random\" }\nnumber = 20"),
     "21:11",
     {"\"fill\" or \"block\"", "give 'mass'"}},
    {"continuity without a density",
     with("density = 1\n", "mass = 1\n", with("weight = \"wendland\"", "density = \"continuity\"")),
     "17:1",
     {"continuity", "density = 1"}},
    {"negative density", with("density = 1", "density = -1"), "21:11", {"density", "positive"}},
    {"range of zero", with("range = 0.3", "range = 0"), "20:9", {"range", "positive"}},
    {"no range", with("range = 0.3\n", ""), "17:1", {"need a 'range'", "3 times their spacing"}},
    {"range longer than the box", with("range = 0.3", "range = 3"), "20:9", {"range: 3", "axis x", "at most 2"}},
    // Loaders.
    {"fill without a spacing", load("{ kind = \"fill\" }"), "22:8", {"no 'spacing'"}},
    {"fill with another lattice",
     load("{ kind = \"fill\", spacing = 0.1, lattice = \"fcc\" }"),
     "22:50",
     {"lattice fcc exists in 3D only"}},
    {"fill upside down",
     load("{ kind = \"fill\", spacing = 0.1, high = [1, -1] }"),
     "22:47",
     {"high", "-1 must be above 0 along y"}},
    {"fill of nothing", load("{ kind = \"fill\", spacing = 0.1, where = \"x > 9\" }"), "22:48", {"no place is left"}},
    {"fill with everything",
     load("{ kind = \"fill\", spacing = 1e-6 }"),
     "22:35",
     {"2000000000000 cells", "too many sites"}},
    {"fill by fields",
     load("{ kind = \"fill\", spacing = 0.1, where = \"density > 9\" }"),
     "22:49",
     {"unknown name 'density'", "x, y, r, pi"}},
    {"fill outside", load("{ kind = \"fill\", spacing = 0.1, high = [2, 3] }"), "22:8", {"particle", "'gas'"}},
    {"jitter of spacings",
     load("{ kind = \"fill\", spacing = 0.1, jitter = 3 }"),
     "22:49",
     {"jitter", "between 0 and 1"}},
    {"jitter at random", load("{ kind = \"random\", jitter = 0.1 }\nnumber = 9"), "22:27", {"unknown key 'jitter'"}},
    // Formulas.
    {"unknown name", formula("1 + 0.1*sin(pi*X)"), "24:48", {"unknown name 'X'", "velocity", "did you mean 'x'?"}},
    {"unknown function",
     formula("1 + sine(x)"),
     "24:37",
     {"specific_energy", "unknown function 'sine'", "did you mean 'sin'?"}},
    {"open parenthesis", formula("(1 + x"), "24:33", {"not closed"}},
    {"an empty formula", formula(""), "24:33", {"empty"}},
    {"a name that is not known yet", formula("1/pressure"), "24:35", {"'pressure' is not known"}},
    {"a formula of itself", formula("1 + specific_energy"), "24:32", {"'specific_energy' is not known yet"}},
    {"a formula further right",
     formula("1 + velocity.y^2"),
     "24:32",
     {"'velocity.y' is not known yet", "further left"}},
    {"no number",
     formula("sqrt(x - 1)"),
     "24:32",
     {"the formula gives", "nan for particle 0 at (0.05, 0.05)", "finite"}},
    {"a density below zero",
     with("density = 1\n", "", with("specific_energy = ", "density = \"x - 1\", specific_energy = ")),
     "23:24",
     {"density", "-0.95", "positive"}},
    {"formulas as a text",
     with("formulas = { specific_energy = \"1 + 0.1*sin(pi*x)\", velocity = [\"y*(1 - y)\", 0] }", "formulas = \"x\""),
     "24:12",
     {"formulas: a table is needed"}},
    {"unknown field",
     with("specific_energy =", "specific_enery ="),
     "24:14",
     {"unknown key 'specific_enery' in formulas", "did you mean 'specific_energy'?"}},
    {"a formula for two components",
     with("[\"y*(1 - y)\", 0]", "\"y\""),
     "24:64",
     {"velocity: 2 formulas are needed", "the text 'y'"}},
    {"three formulas for two components",
     with("[\"y*(1 - y)\", 0]", "[0, 0, 0]"),
     "24:64",
     {"2 formulas are needed", "an array of 3"}},
    {"a table as a formula", with("\"1 + 0.1*sin(pi*x)\"", "{ a = 1 }"), "24:32", {"formula in quotes", "a table"}},
    {"a value and a formula",
     with("density = 1\n", "density = 1\nspecific_energy = 1\n"),
     "25:14",
     {"'specific_energy'", "leave one out"}},
    {"positions by a formula", with("specific_energy = \"", "position = \""), "24:14", {"unknown key 'position'"}},
    {"density of some, from masses",
     with("velocity = [0, 0]", "density = 2", with("density = 1", "mass = 0.01")),
     "27:11",
     {"density", "'mass'"}},
    {"negative mass of some", with("velocity = [0, 0]", "mass = -2"), "27:8", {"mass", "positive"}},
    {"where and particles",
     with("where = \"x < 0.5\"", "where = \"x < 0.5\"\nparticles = [0]"),
     "26:9",
     {"'particles'", "leave one out"}},
    {"where what", with("x < 0.5", "x <"), "26:13", {"where", "ends where"}},
    {"where as a number of the command line",
     good,
     "--set ensembles.0.set.0.where=x <",
     {"where", "ends where", "(at '')"},
     {{"ensembles.0.set.0.where=x <"}, {}, {}, {}}},
    // Pictures and diagnoses.
    {"unknown field of a map", picture("map", "y = \"presure\"\n"), "36:5", {"presure", "did you mean 'pressure'?"}},
    {"map with levels", picture("map", "levels = 3\n"), "36:1", {"unknown key 'levels'", "'map'"}},
    {"no levels", picture("contours", "levels = 0\n"), "36:10", {"levels", "between 1 and 1000"}},
    {"an empty array of levels", picture("contours", "levels = []\n"), "36:10", {"levels", "without any"}},
    {"levels that fall", picture("bands", "levels = [1, 0.5]\n"), "36:14", {"levels: 0.5 must be above 1"}},
    {"ends of bands", picture("bands", "low = 1\n"), "36:1", {"unknown key 'low'", "'bands'"}},
    {"unknown weight of a map", picture("map", "weight = \"gauss\"\n"), "36:10", {"unknown weight 'gauss'", "lucy"}},
    {"range of a map", picture("map", "range = 0\n"), "36:9", {"range", "positive"}},
    {"range of a map between walls",
     picture("map", "range = 1.5\n"),
     "36:9",
     {"range: 1.5", "mirror axis y", "at most 1"}},
    {"range of an entropy between walls", entropy("range = 1.5\n"), "36:9", {"range: 1.5", "mirror axis y"}},
    {"heat flux between walls without temperatures",
     good + "[[diagnoses]]\nkind = \"heat-flux\"\nconductivity = 1\n",
     "35:8",
     {"heat flux along y", "walls of different temperatures"}},
    {"cells of a map", picture("map", "cells = 1\n"), "36:9", {"cells", "between 2 and 4000"}},
    {"slice of a map in 2D", picture("map", "slice = \"x\"\n"), "36:9", {"slice", "in 2D the whole is shown"}},
    {"colour of a map", picture("map", "colour = \"speed\"\n"), "36:1", {"unknown key 'colour'", "cells"}},
    {"unknown weight of an entropy", entropy("weight = \"gauss\"\n"), "36:10", {"unknown weight 'gauss'"}},
    {"gamma of an entropy", entropy("gamma = 1\n"), "36:9", {"gamma", "above 1"}},
    {"range of an entropy", entropy("range = -1\n"), "36:9", {"range", "positive"}},
    // Laws.
    {"pairs of smooth particles",
     with("law = \"uniform-gravity\"", "law = \"lennard-jones\""),
     "29:7",
     {"'lennard-jones' acts between pairs", "'material'"}},
    {"a field on what has no charge",
     with("law = \"uniform-gravity\"", "law = \"uniform-electric-field\"", with("acceleration", "field")),
     "29:7",
     {"needs a charge; class Smooth has none"}},
    {"gravity on some",
     with("on = \"gas\"", "on = \"gas\"\nparticles = [0]"),
     "31:13",
     {"'uniform-gravity' acts on all smooth particles"}},
    {"reversible",
     with("class = \"Smooth\"", "class = \"Smooth\"\nintegrator = \"reversible-leap-frog\""),
     "11:1",
     {"reversible", "depend on velocities"}},
};

TEST(SmoothMistakes, TheGoodScenarioHasNone) {
  for (std::string const& more :
       {picture("map", "y = \"velocity.x\"\nlow = -1\nhigh = 1\nweight = \"wendland\"\nrange = 0.2\ncells = 50\n"),
        picture("contours", "levels = 5\n"), picture("bands", "y = \"pressure\"\nlevels = [0.4, 0.5]\n"),
        entropy("weight = \"lucy\"\nrange = 0.2\ngamma = 1.4\n")})
    for (auto const& line : mistakes_of(more)) ADD_FAILURE() << line;
  for (auto const& line : mistakes_of(good)) ADD_FAILURE() << line;
  for (auto const& line : mistakes_of(solid("{ kind = \"ideal-gas\", gamma = 1.4, elastic = { shear_modulus = 1 } }")))
    ADD_FAILURE() << line;
}

class SmoothMistakesTable : public testing::TestWithParam<Mistake> {};

TEST_P(SmoothMistakesTable, IsToldInOneLine) { test::expect_one_line(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Scenario, SmoothMistakesTable, testing::ValuesIn(rows), mistake_name);

TEST(SmoothMistakes, OfAnyMissingLineAreTold) { test::expect_mistakes_of_what_is_missing(good, 400, 10); }

// With the box, the class or the material unknown, what else is wrong is told all the same, and nothing that is right.
TEST(SmoothMistakes, OfOneTableHideNoOthers) {
  auto lines = mistakes_of(
      with("gamma = 1.4", "gamma = 1", with("low = [0, 0]", "low = [5, 0]", with("\"wendland\"", "\"x\""))));
  ASSERT_EQ(lines.size(), 3U) << testing::PrintToString(lines);
  EXPECT_EQ(lines[0].find("test.toml:5:8: "), 0U) << lines[0];
  EXPECT_EQ(lines[1].find("test.toml:15:10: "), 0U) << lines[1];
  EXPECT_EQ(lines[2].find("test.toml:23:42: "), 0U) << lines[2];
  lines = mistakes_of(with("1 + 0.1*sin", "1 + 0.1*sni", with("\"ideal-gas\"", "\"ideal\"")));
  ASSERT_EQ(lines.size(), 2U) << testing::PrintToString(lines);
}

TEST(SmoothMistakes, OfTablesInFilesHaveTheFilesPlace) {
  std::string const folder = testing::TempDir(), path = folder + "/boltzmann_smooth_mistakes.toml";
  std::ofstream(path) << material("{ kind = \"table\", file = \"boltzmann_smooth_mistakes.txt\" }");
  std::ofstream(folder + "/boltzmann_smooth_mistakes.txt") << "1 0.5\n2 1.5\n";
  auto const scenario = load_scenario(path);
  EXPECT_EQ(parse_scenario(scenario->resolved, "elsewhere.toml")->ensembles[0]->size(), 200U);
  std::ofstream(folder + "/boltzmann_smooth_mistakes.txt") << "1 0.5\n2 x\n";
  try {
    load_scenario(path);
    FAIL();
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("boltzmann_smooth_mistakes.txt:2: 'x' is not a finite number"),
              std::string::npos)
        << error.what();
  }
  std::filesystem::remove(path);
  std::filesystem::remove(folder + "/boltzmann_smooth_mistakes.txt");
}

}  // namespace
}  // namespace boltzmann::smooth_mistakes_test
