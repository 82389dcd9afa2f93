// Mistakes in scenarios: one table of what users get wrong, and what they are told.
#include <boltzmann/scenario/scenario.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <ostream>
#include <string>
#include <vector>

namespace boltzmann {
namespace {

// A scenario without mistakes; the numbers on the right are those of the lines.
std::string const good =
    "title = \"a test\"\n"                                                                                // 1
    "[units]\n"                                                                                           // 2
    "base = \"custom\"\n"                                                                                 // 3
    "length = \"1 angstrom\"\n"                                                                           // 4
    "mass = \"1 amu\"\n"                                                                                  // 5
    "time = \"1 ps\"\n"                                                                                   // 6
    "[box]\n"                                                                                             // 7
    "low = [0, 0]\n"                                                                                      // 8
    "high = [\"20 angstrom\", 20]\n"                                                                      // 9
    "boundary = \"periodic\"\n"                                                                           // 10
    "[run]\n"                                                                                             // 11
    "step = 0.01\n"                                                                                       // 12
    "steps = 20\n"                                                                                        // 13
    "cutoff = 6\n"                                                                                        // 14
    "[[ensembles]]\n"                                                                                     // 15
    "name = \"atoms\"\n"                                                                                  // 16
    "class = \"Newton\"\n"                                                                                // 17
    "integrator = \"leap-frog\"\n"                                                                        // 18
    "mass = \"40 amu\"\n"                                                                                 // 19
    "load = { kind = \"block\", lattice = \"square\", spacing = 4, counts = [4, 4], origin = [2, 2] }\n"  // 20
    "colour = \"red\"\n"                                                                                  // 21
    "[[ensembles.set]]\n"                                                                                 // 22
    "particles = [3]\n"                                                                                   // 23
    "velocity = [0.1, 0.2]\n"                                                                             // 24
    "[[influences]]\n"                                                                                    // 25
    "law = \"lennard-jones\"\n"                                                                           // 26
    "on = \"atoms\"\n"                                                                                    // 27
    "r0 = 4\n"                                                                                            // 28
    "depth = \"0.01 eV\"\n"                                                                               // 29
    "[[diagnoses]]\n"                                                                                     // 30
    "kind = \"energies\"\n"                                                                               // 31
    "[output]\n"                                                                                          // 32
    "diagnoses = 5\n"                                                                                     // 33
    "[[output.pictures]]\n"                                                                               // 34
    "colour = \"speed\"\n"                                                                                // 35
    "file = \"picture.png\"\n";                                                                           // 36

/// The scenario with one piece replaced by another; further pairs are replaced after it.
std::string with(std::string const& old, std::string const& now, std::string text = good) {
  auto const at = text.find(old);
  if (at == std::string::npos) throw std::logic_error("the test's scenario has no '" + old + "'");
  return text.replace(at, old.size(), now);
}

std::string const block = "{ kind = \"block\", lattice = \"square\", spacing = 4, counts = [4, 4], origin = [2, 2] }";
std::string load(std::string const& table) { return with(block, table); }
/// With a second ensemble and more at the end.
std::string plus(std::string const& more) { return good + more; }
std::string const vortices =
    "[[ensembles]]\n"                                                  // 37
    "name = \"vortices\"\n"                                            // 38
    "class = \"Vortex\"\n"                                             // 39
    "load = { kind = \"positions\", positions = [[1, 1], [2, 3]] }\n"  // 40
    "vorticity = 1\n";                                                 // 41

struct Row {
  std::string name, text, place;
  std::vector<std::string> parts;
  Overrides overrides = {};
};

std::ostream& operator<<(std::ostream& out, Row const& row) { return out << row.name; }

Overrides set(std::string const& assignment) { return {{assignment}, {}, {}, {}}; }

std::vector<Row> const rows{
    // Not TOML.
    {"empty file", "", "1:1", {"empty", "[box]"}},
    {"blank file", "\n  \n", "1:1", {"empty"}},
    {"not UTF-8", "title = \"ab\"\nx = \"\xff\"\n", "2:6", {"0xff", "UTF-8"}},
    {"overlong UTF-8", "a = \"\xc0\x80\"\n", "1:6", {"0xc0", "UTF-8"}},
    {"no value", with("step = 0.01", "step = "), "12:8", {"not TOML", "expected value"}},
    {"no quotes", with("base = \"custom\"", "base = custom"), "3:8", {"quotes"}},
    {"unclosed bracket", with("low = [0, 0]", "low = [0, 0"), "9:1", {"not TOML"}},
    {"duplicate key", with("steps = 20", "step = 20"), "13:8", {"duplicate key 'step'"}},
    {"duplicate table", plus("[run]\n"), "37:1", {"duplicate table 'run'"}},
    {"huge integer", with("steps = 20", "steps = 99999999999999999999"), "13:29", {"64 bits"}},
    // Keys and tables.
    {"unknown key",
     with("step = 0.01", "step = 0.01\nsede = 3"),
     "13:1",
     {"unknown key 'sede' in [run]", "allowed are step, steps, seed", "did you mean 'seed'?"}},
    {"unknown table", plus("[putput]\nx = 1\n"), "37:2", {"unknown table 'putput'", "did you mean 'output'?"}},
    {"unknown key of a law",
     with("r0 = 4", "r0 = 4\nsigma = 1"),
     "29:1",
     {"unknown key 'sigma'", "'lennard-jones'", "depth"}},
    {"unknown field", with("mass = \"40 amu\"", "mass = 40\ncharge = 1"), "20:1", {"unknown key 'charge'", "velocity"}},
    {"unknown key of a loader", load("{ kind = \"random\", spacing = 1 }"), "20:27", {"unknown key 'spacing' in load"}},
    {"unknown key of a diagnosis",
     with("kind = \"energies\"", "kind = \"energies\"\nlabel = \"x\""),
     "32:1",
     {"unknown key 'label'", "'energies'"}},
    {"missing step", with("step = 0.01\n", ""), "11:1", {"[run] has no 'step'", "step = 0.01"}},
    {"missing box",
     with("[box]\nlow = [0, 0]\nhigh = [\"20 angstrom\", 20]\nboundary = \"periodic\"\n", ""),
     "1:1",
     {"no [box]"}},
    {"missing ensembles", "[box]\nlow = [0]\nhigh = [1]\n[run]\nstep = 1\nsteps = 1\n", "1:1", {"no [[ensembles]]"}},
    {"missing class", with("class = \"Newton\"\n", ""), "15:1", {"no 'class'", "Newton"}},
    {"missing parameter", with("r0 = 4\n", ""), "25:1", {"'lennard-jones' needs 'r0'", "distance of the minimum"}},
    {"missing load", with("load = " + block + "\n", ""), "15:1", {"no 'load'"}},
    {"single bracket", with("[[influences]]", "[influences]"), "25:1", {"[[influences]]", "two brackets"}},
    {"double bracket", with("[run]", "[[run]]"), "11:1", {"[run]"}},
    // Types.
    {"text for a number of steps", with("steps = 20", "steps = \"many\""), "13:9", {"whole number", "'many'"}},
    {"fraction of a step", with("steps = 20", "steps = 2.5"), "13:9", {"whole number", "2.5"}},
    {"number for a text", with("name = \"atoms\"", "name = 7"), "16:8", {"text is needed", "7"}},
    {"array for a quantity", with("step = 0.01", "step = [1]"), "12:8", {"step", "an array"}},
    {"text for a flag",
     with("colour = \"red\"", "remove_drift = \"yes\"\ntemperature = 3"),
     "21:16",
     {"true or false"}},
    {"scalar for a vector", with("velocity = [0.1, 0.2]", "velocity = 3"), "24:12", {"array of 2 numbers"}},
    {"table for a number", with("r0 = 4", "r0 = { a = 1 }"), "28:6", {"a table"}},
    {"load is a text", with(block, "\"block\""), "20:8", {"load: a table is needed"}},
    // Units.
    {"wrong dimension",
     with("mass = \"40 amu\"", "mass = \"2.551 angstrom\""),
     "19:8",
     {"'2.551 angstrom' is a length, a mass is needed", "kg"}},
    {"unknown unit", with("\"20 angstrom\"", "\"20 angstom\""), "9:9", {"angstom", "did you mean 'angstrom'?"}},
    {"unit without a number", with("\"0.01 eV\"", "\"eV\""), "29:9", {"depth"}},
    {"time in lengths", with("step = 0.01", "step = \"0.01 nm\""), "12:8", {"length", "time"}},
    {"unit in a reduced base",
     with("base = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"\n", "base = \"reduced\"\n",
          with("mass = \"40 amu\"", "mass = 40", with("\"0.01 eV\"", "1"))),
     "6:9",
     {"20 angstrom"}},
    {"unknown base",
     with("base = \"custom\"", "base = \"costum\""),
     "3:8",
     {"unknown base 'costum'", "lennard-jones", "did you mean 'custom'?"}},
    {"base without its time", with("time = \"1 ps\"\n", ""), "2:1", {"no 'time'"}},
    {"base of length zero", with("\"1 angstrom\"", "\"0 angstrom\""), "2:1", {"positive"}},
    // Ranges.
    {"negative steps", with("steps = 20", "steps = -1"), "13:9", {"-1", "zero or more"}},
    {"zero step", with("step = 0.01", "step = 0"), "12:8", {"step", "positive"}},
    {"step is not a number", with("step = 0.01", "step = nan"), "12:8", {"finite"}},
    {"infinite step", with("step = 0.01", "step = inf"), "12:8", {"finite"}},
    {"negative seed", with("cutoff = 6", "cutoff = 6\nseed = -3"), "15:8", {"seed", "-3", "zero or more"}},
    {"negative cut-off", with("cutoff = 6", "cutoff = -6"), "14:10", {"cutoff", "positive"}},
    {"massless", with("mass = \"40 amu\"", "mass = 0"), "19:8", {"mass", "positive"}},
    {"range of a parameter", with("r0 = 4", "r0 = -4"), "28:6", {"r0", "-4", "positive"}},
    {"too many", load("{ kind = \"random\" }\nnumber = 2000000000"), "21:10", {"2000000000", "GiB", "1000000000"}},
    {"too many sites",
     load("{ kind = \"block\", lattice = \"square\", spacing = 4, counts = [1000000, 1000000] }"),
     "20:8",
     {"1000000000000 particles", "GiB"}},
    {"no particles", load("{ kind = \"random\" }\nnumber = 0"), "21:10", {"number", "1 or more"}},
    {"negative temperature",
     with("colour = \"red\"", "temperature = \"-3 K\""),
     "21:15",
     {"temperature", "zero or more"}},
    {"negative interval", with("diagnoses = 5", "diagnoses = -5"), "33:13", {"-5", "zero or more"}},
    // Words.
    {"unknown law",
     with("law = \"lennard-jones\"", "law = \"lennard-jons\""),
     "26:7",
     {"unknown law 'lennard-jons'", "morse", "did you mean 'lennard-jones'?"}},
    {"unknown class",
     with("class = \"Newton\"", "class = \"Newtn\""),
     "17:9",
     {"unknown class 'Newtn'", "Coulomb", "did you mean 'Newton'?"}},
    {"unknown integrator",
     with("\"leap-frog\"", "\"leapfrog\""),
     "18:14",
     {"unknown integrator 'leapfrog'", "rk4", "did you mean 'leap-frog'?"}},
    {"unknown loader", load("{ kind = \"blck\" }"), "20:17", {"'blck'", "random", "did you mean 'block'?"}},
    {"unknown lattice",
     load("{ kind = \"block\", lattice = \"square2\", spacing = 4, counts = [4, 4] }"),
     "20:36",
     {"unknown lattice", "triangular", "did you mean 'square'?"}},
    {"unknown diagnosis",
     with("\"energies\"", "\"energy\""),
     "31:8",
     {"unknown diagnosis 'energy'", "temperature", "did you mean 'energies'?"}},
    {"unknown colour", with("\"red\"", "\"rad\""), "21:10", {"rad", "red"}},
    {"unknown colour of a picture", with("\"speed\"", "\"sped\""), "35:10", {"sped", "did you mean 'speed'?"}},
    {"unknown boundary",
     with("\"periodic\"", "\"periodical\""),
     "10:12",
     {"unknown boundary 'periodical'", "bounded", "did you mean 'periodic'?"}},
    {"unknown ensemble",
     with("on = \"atoms\"", "on = \"atom\""),
     "27:6",
     {"no ensemble 'atom'", "did you mean 'atoms'?"}},
    {"unknown drawing",
     with("colour = \"speed\"", "drawing = \"cartesean\""),
     "35:11",
     {"unknown drawing", "phase-space", "did you mean 'cartesian'?"}},
    {"unknown column",
     with("colour = \"speed\"", "drawing = \"time-series\"\ny = \"kinetic enrgy\""),
     "36:5",
     {"kinetic enrgy", "did you mean 'kinetic energy'?"}},
    {"unknown kind of picture", with("picture.png", "picture.gif"), "36:8", {"picture.gif", ".svg"}},
    // Names.
    {"two ensembles of one name",
     plus("[[ensembles]]\nname = \"atoms\"\nclass = \"Newton\"\n"
          "load = { kind = \"positions\", positions = [[1, 1]] }\n"),
     "38:8",
     {"'atoms' already", "line 15"}},
    {"two columns of one name", plus("[[diagnoses]]\nkind = \"energies\"\n"), "38:8", {"column", "kinetic energy"}},
    {"two pictures of one name",
     plus("[[output.pictures]]\nfile = \"picture.png\"\n"),
     "38:8",
     {"'picture.png' already"}},
    {"on whom", with("on = \"atoms\"\n", ""), "25:1", {"on whom", "between", "one_way"}},
    {"on and between",
     with("on = \"atoms\"", "on = \"atoms\"\nbetween = [\"atoms\", \"atoms\"]"),
     "28:11",
     {"one of 'on', 'between' and 'one_way'"}},
    {"between one", with("on = \"atoms\"", "between = [\"atoms\"]"), "27:11", {"two ensembles", "of 1"}},
    {"between itself",
     with("on = \"atoms\"", "between = [\"atoms\", \"atoms\"]"),
     "27:21",
     {"twice", "on = \"atoms\""}},
    // Shapes.
    {"three lengths in two dimensions",
     with("velocity = [0.1, 0.2]", "velocity = [0.1, 0.2, 0.3]"),
     "24:12",
     {"velocity", "3 components", "2 are needed"}},
    {"edges of different dimension", with("low = [0, 0]", "low = [0, 0, 0]"), "9:8", {"high", "2 components", "3"}},
    {"four dimensions", with("low = [0, 0]", "low = [0, 0, 0, 0]"), "8:7", {"1, 2 or 3"}},
    {"counts of another dimension",
     load("{ kind = \"block\", lattice = \"square\", spacing = 4, counts = [4] }"),
     "20:68",
     {"counts", "array of 2", "of 1"}},
    {"one value for each, but not for all",
     with("mass = \"40 amu\"", "mass = [1, 2, 3]"),
     "19:8",
     {"3 values for 16 particles", "one for each"}},
    {"boundaries of another dimension",
     with("\"periodic\"", "[\"periodic\", \"open\", \"open\"]"),
     "10:12",
     {"3 words for 2 axes"}},
    {"upside down", with("low = [0, 0]", "low = [30, 0]"), "9:8", {"low edge 30"}},
    {"an empty list",
     with("title = \"a test\"", "ensembles = []", good.substr(0, good.find("[[ensembles]]"))),
     "1:13",
     {"no [[ensembles]]"}},
    {"class in another dimension",
     "[box]\nlow = [0]\nhigh = [1]\n[run]\nstep = 1\nsteps = 1\n[[ensembles]]\nname = \"v\"\nclass = \"Vortex\"\n"
     "load = { kind = \"positions\", positions = [[0.5]] }\n",
     "9:9",
     {"Vortex", "2D or 3D", "1 dimension"}},
    {"lattice in another dimension",
     load("{ kind = \"block\", lattice = \"fcc\", spacing = 1, counts = [2, 2] }"),
     "20:8",
     {"fcc", "3D"}},
    {"number and places differ", with("mass = \"40 amu\"", "mass = 40\nnumber = 15"), "20:10", {"15", "16"}},
    {"random without a number", load("{ kind = \"random\" }"), "20:8", {"needs 'number'"}},
    // The box.
    {"cut-off longer than a periodic axis",
     with("cutoff = 6", "cutoff = 21"),
     "14:10",
     {"21", "periodic axis x", "20"}},
    {"a law's cut-off longer than a periodic axis",
     with("r0 = 4", "r0 = 4\ncutoff = 30"),
     "29:10",
     {"30", "periodic axis x"}},
    {"no cut-off on a periodic axis", with("cutoff = 6\n", ""), "24:1", {"periodic", "cut-off", "20"}},
    {"outside a bounded box",
     with("\"periodic\"", "\"bounded\"", with("origin = [2, 2]", "origin = [12, 2]")),
     "20:8",
     {"particle 3 of 'atoms' is outside the box"}},
    {"inside a region that keeps out",
     with("[run]", "[[box.regions]]\nlow = [1, 1]\nhigh = [3, 3]\nside = \"keep-out\"\n[run]"),
     "24:8",
     {"particle 0", "keeps particles out"}},
    {"region without a side",
     with("[run]", "[[box.regions]]\nlow = [1, 1]\nhigh = [1.5, 3]\n[run]"),
     "11:1",
     {"'side'"}},
    {"too full", load("{ kind = \"random\", minimum_distance = 10 }\nnumber = 100"), "20:8", {"100"}},
    {"two particles at one place",
     load("{ kind = \"positions\", positions = [[1, 1], [5, 5], [1, 1], [9, 9]] }"),
     "20:8",
     {"particle 0", "particle 2", "same place"}},
    // What does not go together.
    {"a law that needs a charge",
     with("law = \"lennard-jones\"", "law = \"coulomb\"", with("r0 = 4\ndepth = \"0.01 eV\"\n", "")),
     "26:7",
     {"law 'coulomb' needs a charge; class Newton has none; classes with one: Coulomb"}},
    {"a force on vortices",
     plus(vortices + "[[influences]]\nlaw = \"spring\"\nstiffness = 1\non = \"vortices\"\n"),
     "43:7",
     {"'spring' gives a force", "Vortex", "flow"}},
    {"a flow on atoms",
     plus("[[influences]]\nlaw = \"uniform-flow\"\nvelocity = [1, 0]\non = \"atoms\"\n"),
     "38:7",
     {"'uniform-flow'", "Newton", "forces"}},
    {"a law of another space",
     plus("[[influences]]\nlaw = \"pendulum-gravity\"\nacceleration = 1\non = \"atoms\"\n"),
     "38:7",
     {"1D only", "is 2D"}},
    {"leap-frog for vortices",
     plus(with("class = \"Vortex\"", "class = \"Vortex\"\nintegrator = \"leap-frog\"", vortices)),
     "40:14",
     {"Vortex", "no velocity", "rk4"}},
    {"random walk of atoms", with("\"leap-frog\"", "\"random-walk\""), "18:14", {"no viscosity"}},
    {"external law between",
     plus("[[influences]]\nlaw = \"drag\"\nfriction = 1\non = \"atoms\"\nbetween = 3\n"),
     "41:1",
     {"unknown key 'between'"}},
    {"external law on nobody", plus("[[influences]]\nlaw = \"drag\"\nfriction = 1\n"), "37:1", {"'drag'", "on = "}},
    {"velocity and temperature",
     with("colour = \"red\"", "temperature = \"300 K\"\nvelocity = [0, 0]"),
     "22:12",
     {"'temperature' gives the velocities", "drift"}},
    {"positions as a field", with("colour = \"red\"", "position = [1, 1]"), "21:1", {"positions are loaded", "load"}},
    // Particles by number.
    {"no such particle", with("particles = [3]", "particles = [16]"), "23:14", {"no particle 16", "0 to 15"}},
    {"particles by a word",
     with("particles = [3]", "particles = \"edges\""),
     "23:13",
     {"'edges'", "did you mean 'edge'?"}},
    {"edge without margin", with("particles = [3]", "particles = \"edge\""), "23:13", {"margin"}},
    {"set on nobody", with("particles = [3]\n", ""), "22:1", {"no 'particles'"}},
    {"connection out of range",
     with("r0 = 4", "r0 = 4\nconnect = [[0, 16, 1]]"),
     "29:12",
     {"no particle 16", "0 to 15"}},
    {"connection backwards", with("r0 = 4", "r0 = 4\nconnect = [[9, 3, 1]]"), "29:12", {"9 back to 3"}},
    {"connection without interval", with("r0 = 4", "r0 = 4\nconnect = [[3, 9, 0]]"), "29:19", {"connect", "1"}},
    {"connection of one number", with("r0 = 4", "r0 = 4\nconnect = [3, 9]"), "29:12", {"[[first, last, interval]]"}},
    {"file that is not there", load("{ kind = \"file\", path = \"no/such.xyz\" }"), "20:32", {"no/such.xyz"}},
    // The command line.
    {"override of a wrong value", good, "--set run.step=-1", {"step", "-1", "positive"}, set("run.step=-1")},
    {"override of an unknown key",
     good,
     "--set run.stpe=1",
     {"unknown key 'stpe'", "did you mean 'step'?"},
     set("run.stpe=1")},
    {"override without a value", good, "--set run.step", {"key=value"}, set("run.step")},
    {"override of an unknown ensemble",
     good,
     "--set ensembles.atom.mass=1",
     {"no 'atom'", "did you mean 'atoms'?"},
     set("ensembles.atom.mass=1")},
    {"override of an ensemble out of range", good, "--set ensembles.1.mass=1", {"no '1'"}, set("ensembles.1.mass=1")},
    {"override into a number", good, "--set run.step.x=1", {"run.step", "no 'x'"}, set("run.step.x=1")},
    {"override with a wrong unit",
     good,
     "--set ensembles.0.mass=3 nm",
     {"length", "mass"},
     set("ensembles.0.mass=3 nm")},
    {"negative steps on the command line", good, "--steps=-5", {"steps", "zero or more"}, {{}, -5, {}, {}}},
};

std::vector<std::string> mistakes_of(std::string const& text, Overrides const& overrides = {}) {
  try {
    parse_scenario(text, "test.toml", overrides);
  } catch (ScenarioErrors const& errors) {
    return errors.lines;
  }
  return {};
}

TEST(Mistakes, TheGoodScenarioHasNone) {
  for (auto const& line : mistakes_of(good)) ADD_FAILURE() << line;
}

TEST(Mistakes, TheGoodScenarioWithVorticesHasNone) {
  for (auto const& line : mistakes_of(good + vortices)) ADD_FAILURE() << line;
}

class MistakesTable : public testing::TestWithParam<Row> {};

TEST_P(MistakesTable, IsToldInOneLine) {
  Row const& row = GetParam();
  auto const lines = mistakes_of(row.text, row.overrides);
  ASSERT_EQ(lines.size(), 1U) << testing::PrintToString(lines);
  std::string const place = row.place.front() == '-' ? row.place + ": " : "test.toml:" + row.place + ": ";
  EXPECT_EQ(lines[0].substr(0, place.size()), place) << lines[0];
  for (auto const& part : row.parts)
    EXPECT_NE(lines[0].find(part), std::string::npos) << part << "\nis not in\n" << lines[0];
  EXPECT_EQ(lines[0].find('\n'), std::string::npos);
}

INSTANTIATE_TEST_SUITE_P(Scenario, MistakesTable, testing::ValuesIn(rows), [](auto const& info) {
  std::string name;
  for (char const c : info.param.name)
    if (std::isalnum(static_cast<unsigned char>(c))) name += c;
  return name + std::to_string(info.index);
});

TEST(Mistakes, AreAllToldInTheOrderOfTheFile) {
  std::string text = with("base = \"custom\"", "base = \"custom\"\nlenght = 1");  // 4:1
  text = with("step = 0.01", "step = -1", text);                                  // 13:8
  text = with("class = \"Newton\"", "class = \"Newtn\"", text);                   // 18:9
  text = with("law = \"lennard-jones\"", "law = \"lennard\"", text);              // 27:7
  text = with("kind = \"energies\"", "kind = \"energy\"", text);                  // 32:8
  auto const lines = mistakes_of(text);
  ASSERT_EQ(lines.size(), 5U) << testing::PrintToString(lines);
  std::vector<std::string> const places{"4:1", "13:8", "18:9", "27:7", "32:8"};
  for (std::size_t i = 0; i < 5; ++i) EXPECT_EQ(lines[i].find("test.toml:" + places[i] + ": "), 0U) << lines[i];
  try {
    parse_scenario(text, "test.toml");
    FAIL();
  } catch (Error const& error) {
    EXPECT_EQ(std::count(error.what(), error.what() + std::string(error.what()).size(), '\n'), 4);
  }
}

// Whatever is missing or cut off: mistakes in one go, nothing else.
TEST(Mistakes, OfAnyMissingLineAreTold) {
  std::size_t told = 0, fine = 0;
  auto const attempt = [&](std::string const& text) {
    try {
      parse_scenario(text, "test.toml");
      ++fine;
    } catch (ScenarioErrors const& errors) {
      ++told;
      EXPECT_FALSE(errors.lines.empty());
      for (auto const& line : errors.lines) EXPECT_EQ(line.find("test.toml:"), 0U) << line;
    }
  };
  std::string const text = good + vortices;
  for (std::size_t begin = 0; begin < text.size();) {
    std::size_t const end = text.find('\n', begin) + 1;
    attempt(text.substr(0, begin) + text.substr(end));
    begin = end;
  }
  for (std::size_t size = 0; size < text.size(); ++size) attempt(text.substr(0, size));
  EXPECT_GT(told, 500U);
  EXPECT_GT(fine, 10U);
}

TEST(Mistakes, OfTheFileSystem) {
  auto const message = [](std::string const& path) -> std::string {
    try {
      load_scenario(path);
    } catch (Error const& error) {
      return error.what();
    }
    return "";
  };
  std::string const folder = testing::TempDir();
  EXPECT_NE(message(folder).find("is a directory"), std::string::npos);
  EXPECT_NE(message(folder + "/no-such-file.toml").find("No such file"), std::string::npos);
  try {
    find_scenario("coper");
    FAIL();
  } catch (Error const& error) {
    EXPECT_NE(std::string(error.what()).find("did you mean 'copper'?"), std::string::npos) << error.what();
  }
  EXPECT_THROW(find_scenario(""), Error);
  EXPECT_THROW(find_scenario(folder), Error);
  // Paths of other files are relative to the scenario.
  std::string const path = folder + "/boltzmann_mistakes_test.toml";
  std::ofstream(path) << load("{ kind = \"file\", path = \"boltzmann_mistakes_test.xyz\" }");
  std::ofstream(folder + "/boltzmann_mistakes_test.xyz") << "4\n\nCu 1 1 0\nCu 5 1 0\nCu 9 1 0\nCu 13 1 0\n";
  auto const scenario = load_scenario(path);
  EXPECT_EQ(scenario->ensembles[0]->size(), 4U);
  EXPECT_EQ(scenario->ensembles[0]->row(2)[0], 9);
  EXPECT_EQ(parse_scenario(scenario->resolved, "elsewhere.toml")->ensembles[0]->size(), 4U);
  std::filesystem::remove(path);
  std::filesystem::remove(folder + "/boltzmann_mistakes_test.xyz");
}

}  // namespace
}  // namespace boltzmann
