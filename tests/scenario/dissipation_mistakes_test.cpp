// Mistakes in scenarios with friction and noise: what users get wrong, and what they are told.
#include "mistakes.hpp"

#include <gtest/gtest.h>

#include <string>
#include <utility>
#include <vector>

namespace boltzmann::dissipation_mistakes_test {
namespace {

using test::Mistake;
using test::mistake_name;

// A scenario without mistakes; the numbers on the right are those of the lines.
std::string const good =
    "[units]\n"                                                                      // 1
    "base = \"custom\"\n"                                                            // 2
    "length = \"1 angstrom\"\n"                                                      // 3
    "mass = \"1 amu\"\n"                                                             // 4
    "time = \"1 ps\"\n"                                                              // 5
    "[box]\n"                                                                        // 6
    "low = [0, 0]\n"                                                                 // 7
    "high = [\"40 angstrom\", \"40 angstrom\"]\n"                                    // 8
    "boundary = [\"open\", \"periodic\"]\n"                                          // 9
    "[run]\n"                                                                        // 10
    "step = \"2 fs\"\n"                                                              // 11
    "steps = 3\n"                                                                    // 12
    "[[ensembles]]\n"                                                                // 13
    "name = \"polymer\"\n"                                                           // 14
    "class = \"Meso\"\n"                                                             // 15
    "mass = \"64.03 amu\"\n"                                                         // 16
    "load = { kind = \"positions\", positions = [[10, 10], [15, 10], [20, 10]] }\n"  // 17
    "heat_capacity = \"16 kB\"\n"                                                    // 18
    "internal_energy = { temperature = \"300 K\" }\n"                                // 19
    "[[ensembles]]\n"                                                                // 20
    "name = \"water\"\n"                                                             // 21
    "class = \"Newton\"\n"                                                           // 22
    "mass = \"18 amu\"\n"                                                            // 23
    "load = { kind = \"positions\", positions = [[30, 10], [35, 10]] }\n"            // 24
    "[[dissipation]]\n"                                                              // 25
    "kind = \"dpd\"\n"                                                               // 26
    "on = \"polymer\"\n"                                                             // 27
    "convention = \"constant-friction\"\n"                                           // 28
    "friction = \"1.5e-14 kg/s\"\n"                                                  // 29
    "range = \"15 angstrom\"\n"                                                      // 30
    "exponent = 2\n"                                                                 // 31
    "projected = false\n"                                                            // 32
    "[[dissipation]]\n"                                                              // 33
    "kind = \"langevin\"\n"                                                          // 34
    "on = \"water\"\n"                                                               // 35
    "temperature = \"300 K\"\n"                                                      // 36
    "rate = \"5 1/ps\"\n"                                                            // 37
    "[equilibrate]\n"                                                                // 38
    "temperature = \"300 K\"\n"                                                      // 39
    "rate = \"5 1/ps\"\n"                                                            // 40
    "time = \"0.1 ps\"\n";                                                           // 41

std::string with(std::string const& old, std::string const& now, std::string text = good) {
  return test::replaced(std::move(text), old, now);
}
/// The first dissipation: its line 31 is another.
std::string first(std::string const& line) { return with("exponent = 2", line); }
/// The rest stands from line 42 on.
std::string and_then(std::string const& rest) { return good + rest; }
std::string capacity(std::string const& value) { return with("\"16 kB\"", value); }
std::string convention(std::string const& word, std::string const& line = "exponent = 2") {
  return with("\"constant-friction\"", "\"" + word + "\"", first(line));
}
std::string const second =
    "[[dissipation]]\nkind = \"dpd\"\non = \"water\"\nconvention = \"fixed-temperature\"\ntemperature = \"300 K\"\n"
    "friction = \"1e-14 kg/s\"\nrange = \"15 angstrom\"\n";

std::vector<Mistake> const rows{
    // Friction and its weight as formulas.
    {"weight that is a length",
     first("weight = \"r\""),
     "31:11",
     {"weight: a pure number is needed; this is a length"}},
    {"weight with a slip", first("weight = \"1 - q/range\""), "31:15", {"weight", "unknown name 'q'"}},
    {"weight below zero",
     first("weight = \"1 - 2*r/range\""),
     "31:11",
     {"weight: the weight must be zero or more and finite", "at r = 0.501 range"}},
    {"weight that is infinite", first("weight = \"range/r\""), "31:11", {"at r = 0 range it is inf"}},
    {"weight and exponent", first("exponent = 2\nweight = \"1\""), "31:12", {"exponent", "'weight' also defines chi"}},
    {"weight that is a number", first("weight = 1"), "31:10", {"weight", "text"}},
    {"parameters of no formula", first("parameters = { a = 1 }"), "31:14", {"parameters", "formulas use them"}},
    {"parameter with a name that is taken",
     first("weight = \"1\"\nparameters = { range = 1 }"),
     "32:16",
     {"parameters.range", "'range' means something else"}},
    {"friction of another dimension",
     with("\"1.5e-14 kg/s\"", "\"1 kg*(1 - r/range)\""),
     "29:13",
     {"friction: a friction constant is needed; this is a mass"}},
    {"friction of the temperature at constant noise",
     with("\"1.5e-14 kg/s\"", "\"1e-14 kg/s*T/(300 K)\"", convention("constant-noise", "temperature = \"300 K\"")),
     "29:13",
     {"friction: friction may depend on T with convention \"constant-friction\"; with \"constant-noise\" noise is"}},
    {"friction of one internal energy",
     with("\"1.5e-14 kg/s\"", "\"1e-14 kg/s*p.internal_energy/(1 eV)\""),
     "29:24",
     {"friction", "unknown name 'p"}},
    // State laws.
    {"heat capacity without a number", capacity("true"), "18:17", {"heat_capacity", "true"}},
    {"heat capacity that is an energy", capacity("\"16 eV\""), "18:17", {"is an energy", "heat capacity"}},
    {"heat capacity below zero", capacity("\"-1 kB\""), "18:17", {"heat_capacity", "positive"}},
    {"heat capacity of what has none",
     with("mass = \"18 amu\"", "mass = \"18 amu\"\nheat_capacity = \"3 kB\""),
     "24:17",
     {"heat_capacity", "class Newton", "classes with one: Meso"}},
    {"heat capacity of nothing", capacity("{ }"), "18:17", {"'file' or 'formula'"}},
    {"heat capacity twice", capacity("{ file = \"a\", formula = \"kB\" }"), "18:41", {"'file' or 'formula'"}},
    {"no such file", capacity("{ file = \"/nowhere/cv.csv\" }"), "18:26", {"/nowhere/cv.csv", "can't open"}},
    {"formula without its ends", capacity("{ formula = \"kB\", from = \"1 K\" }"), "18:17", {"no 'to'"}},
    {"formula from top to bottom",
     capacity("{ formula = \"kB\", from = \"9 K\", to = \"8 K\" }"),
     "18:54",
     {"to: 8", "above from = 9"}},
    {"formula with a slip",
     capacity("{ formula = \"3*kB + t\", from = \"1 K\", to = \"9 K\" }"),
     "18:37",
     {"unknown name 't'", "did you mean 'T'?"}},
    {"formula of another dimension",
     capacity("{ formula = \"kB*T\", from = \"1 K\", to = \"9 K\" }"),
     "18:30",
     {"formula: a heat capacity is needed; this is an energy"}},
    {"formula below zero",
     capacity("{ formula = \"kB*(5 - T/(1 K))\", from = \"1 K\", to = \"9 K\" }"),
     "18:29",
     {"heat capacity"}},
    {"internal temperature without heat capacity",
     with("heat_capacity = \"16 kB\"\n", ""),
     "18:19",
     {"internal_energy", "'heat_capacity'", "\"16 kB\""}},
    {"internal temperature below zero", with("\"300 K\" }", "\"-3 K\" }"), "19:35", {"temperature", "positive"}},
    {"internal temperature of nothing", with("{ temperature = \"300 K\" }", "{ }"), "19:19", {"no 'temperature'"}},
    {"internal energy twice",
     with("heat_capacity = \"16 kB\"", "heat_capacity = \"16 kB\"\nformulas = { internal_energy = \"1\" }"),
     "19:14",
     {"internal_energy", "leave one out"}},
    {"temperature by formula",
     with("heat_capacity = \"16 kB\"", "heat_capacity = \"16 kB\"\nformulas = { temperature = \"1\" }"),
     "19:28",
     {"temperature", "internal_energy and heat_capacity"}},
    // Dissipation.
    {"dissipation without a kind", with("kind = \"dpd\"\n", ""), "25:1", {"no 'kind'", "kind = \"dpd\""}},
    {"unknown dissipation",
     with("\"dpd\"", "\"dbd\""),
     "26:8",
     {"unknown dissipation 'dbd'", "dpd, langevin, velocity-rescaling, nose-hoover", "did you mean 'dpd'?"}},
    {"dissipation as a table",
     "[dissipation]\nkind = \"langevin\"\n" + good.substr(0, good.find("[[dissipation]]")),
     "1:1",
     {"[[dissipation]]"}},
    {"dissipation on nobody", with("on = \"polymer\"\n", ""), "25:1", {"on = \"atoms\"", "between"}},
    {"dissipation on a stranger", with("on = \"polymer\"", "on = \"polimer\""), "27:6", {"'polimer'", "did you mean"}},
    {"dissipation on and between", first("between = [\"polymer\", \"water\"]"), "31:11", {"between", "leave one out"}},
    {"between one", with("on = \"polymer\"", "between = [\"polymer\"]"), "27:11", {"two ensembles", "an array of 1"}},
    {"between oneself",
     with("on = \"polymer\"", "between = [\"polymer\", \"polymer\"]"),
     "27:23",
     {"'polymer' twice", "on = \"polymer\""}},
    {"unknown key", first("exponant = 2"), "31:1", {"unknown key 'exponant'", "did you mean 'exponent'?"}},
    {"unknown convention",
     convention("constant-frictions"),
     "28:14",
     {"unknown convention", "fixed-temperature, constant-noise", "did you mean 'constant-friction'?"}},
    {"no convention", with("convention = \"constant-friction\"\n", ""), "25:1", {"no 'convention'"}},
    {"no friction", with("friction = \"1.5e-14 kg/s\"\n", ""), "25:1", {"no 'friction'", "kg/s"}},
    {"friction of another kind", with("1.5e-14 kg/s", "1.5e-14 kg"), "29:12", {"is a mass", "friction"}},
    {"negative friction", with("1.5e-14 kg/s", "-1 kg/s"), "29:12", {"friction", "zero or more"}},
    {"no range", with("range = \"15 angstrom\"\n", ""), "25:1", {"no 'range'"}},
    {"range of nothing", with("15 angstrom", "0 angstrom"), "30:9", {"range", "positive"}},
    {"range over half of the box",
     with("15 angstrom", "21 angstrom"),
     "30:9",
     {"range: 21", "half of the periodic axis y, 20"}},
    {"negative exponent", first("exponent = -1"), "31:12", {"exponent", "zero or more"}},
    {"projected as a number", with("projected = false", "projected = 0"), "32:13", {"true or false"}},
    {"temperature that is not used", first("temperature = \"300 K\""), "31:15", {"temperature", "leave it out"}},
    {"no temperature", convention("constant-noise"), "25:1", {"no 'temperature'", "\"300 K\""}},
    {"conduction at a fixed temperature",
     convention("fixed-temperature", "temperature = \"300 K\"\nconduction = 1"),
     "32:14",
     {"conduction", "fixed-temperature"}},
    {"particles without internal energy",
     with("on = \"polymer\"", "on = \"water\""),
     "28:14",
     {"class Newton ('water')", "class Meso", "\"fixed-temperature\""}},
    {"between with one that has no internal energy",
     with("on = \"polymer\"", "between = [\"polymer\", \"water\"]"),
     "28:14",
     {"class Newton ('water')"}},
    {"particles without heat capacity",
     with("internal_energy = { temperature = \"300 K\" }\n", "internal_energy = \"1 eV\"\n",
          with("heat_capacity = \"16 kB\"\n", "")),
     "27:14",
     {"give 'polymer' a heat_capacity", "\"16 kB\""}},
    {"particles without energy",
     with("internal_energy = { temperature = \"300 K\" }\n", ""),
     "13:1",
     {"particle 0 of 'polymer' is 0", "internal_energy = { temperature = \"300 K\" }"}},
    {"another integrator",
     with("heat_capacity", "integrator = \"rk4\"\nheat_capacity"),
     "28:6",
     {"'polymer'", "\"leap-frog\", not \"rk4\""}},
    {"frozen particles",
     with("[[ensembles]]\nname = \"water\"",
          "[[ensembles.set]]\nparticles = [1]\nfreeze = true\n[[ensembles]]\nname = \"water\""),
     "30:6",
     {"'polymer'", "frozen", "use a heat bath"}},
    {"two at once",
     and_then(test::replaced(second, "\"water\"", "\"polymer\"")),
     "44:6",
     {"dpd dissipation of 'polymer' already, in line 27"}},
    {"two baths at once",
     and_then("[[dissipation]]\nkind = \"langevin\"\non = \"water\"\ntemperature = \"3 K\"\nrate = \"1 1/ps\"\n"),
     "44:6",
     {"langevin dissipation of 'water' already, in line 35"}},
    {"unknown method", first("method = \"splitting\""), "31:10", {"unknown method", "simultaneous, shardlow"}},
    {"metropolis of all at once", first("metropolis = true"), "31:14", {"metropolis", "shardlow"}},
    {"corrector of one by one",
     first("corrector = true\nmethod = \"shardlow\""),
     "31:13",
     {"corrector", "simultaneous"}},
    {"metropolis without internal energies",
     with("on = \"polymer\"", "on = \"water\"",
          convention("fixed-temperature", "temperature = \"300 K\"\nmethod = \"shardlow\"\nmetropolis = true")),
     "28:14",
     {"'metropolis'", "fixed-temperature"}},
    {"a method in the second",
     and_then(second + "method = \"simultaneous\"\n"),
     "49:10",
     {"method", "set it in the first", "line 25"}},
    // Heat baths and equilibrations.
    {"bath between two",
     with("on = \"water\"", "on = \"water\"\nbetween = [\"water\", \"polymer\"]"),
     "36:1",
     {"unknown key 'between'"}},
    {"bath without rate", with("rate = \"5 1/ps\"\n[equilibrate]", "[equilibrate]"), "33:1", {"no 'rate'"}},
    {"rate that is a time", with("\"5 1/ps\"", "\"5 ps\""), "37:8", {"is a time", "frequency"}},
    {"rate of zero", with("\"5 1/ps\"", "0"), "37:8", {"rate", "positive"}},
    {"equilibration without time", with("time = \"0.1 ps\"\n", ""), "38:1", {"[equilibrate] has no 'time'"}},
    {"equilibration for steps", and_then("steps = 100\n"), "42:1", {"unknown key 'steps' in [equilibrate]"}},
    {"equilibration for ever", with("\"0.1 ps\"", "\"1e9 yr\""), "41:8", {"time", "steps"}},
    {"equilibration of a stranger", and_then("on = \"foam\"\n"), "42:6", {"there is no ensemble 'foam'"}},
    {"equilibration of the unmoved",
     with("mass = \"18 amu\"", "mass = \"18 amu\"\nintegrator = \"deactivate\"",
          good.substr(0, good.find("[[dissipation]]\nkind = \"langevin\"")) + good.substr(good.find("[equilibrate]")) +
              "on = [\"polymer\", \"water\"]\n"),
     "38:18",
     {"'water'", "\"leap-frog\", not \"deactivate\""}},
};

class DissipationMistakes : public testing::TestWithParam<Mistake> {};

TEST_P(DissipationMistakes, AreToldInOneLine) { test::expect_one_line(GetParam()); }

INSTANTIATE_TEST_SUITE_P(Scenario, DissipationMistakes, testing::ValuesIn(rows), mistake_name);

TEST(DissipationMistakesInAll, TheScenarioHasNone) { EXPECT_NO_THROW(parse_scenario(good, "test.toml")); }

TEST(DissipationMistakesInAll, OfAnyMissingLineAreTold) { test::expect_mistakes_of_what_is_missing(good, 400, 10); }

TEST(DissipationMistakesInAll, SmoothParticlesAndMeshesHaveNone) {
  std::string const head =
      "[units]\nbase = \"reduced\"\n[box]\nlow = [0, 0]\nhigh = [4, 4]\nboundary = \"periodic\"\n[run]\nstep = 0.01\n"
      "steps = 1\n";
  std::string const friction =
      "[[dissipation]]\nkind = \"dpd\"\non = \"a\"\nconvention = \"fixed-temperature\"\ntemperature = 1\nfriction = "
      "1\nrange = 1\n";
  auto lines = test::mistakes_of(head +
                                 "[smooth]\n[[ensembles]]\nname = \"a\"\nclass = \"Smooth\"\nrange = 0.5\ndensity = 1\n"
                                 "load = { kind = \"fill\", spacing = 0.2 }\nmaterial = { kind = \"ideal-gas\", gamma "
                                 "= 1.4 }\nformulas = { specific_energy = \"1\" }\n" +
                                 friction + "[equilibrate]\ntemperature = 1\nrate = 1\ntime = 1\n");
  ASSERT_EQ(lines.size(), 2U) << testing::PrintToString(lines);
  EXPECT_NE(lines[0].find("viscosity and the conductivity of their material"), std::string::npos) << lines[0];
  EXPECT_NE(lines[1].find("[equilibrate]"), std::string::npos) << lines[1];
  lines = test::mistakes_of(head +
                            "[mesh]\ncells = [8, 8]\nlaw = \"coulomb\"\nk = 1\n[[ensembles]]\nname = \"a\"\nclass = "
                            "\"Coulomb\"\nmass = 1\ncharge = 1\nnumber = 9\nload = { kind = \"random\" }\n" +
                            friction);
  ASSERT_FALSE(lines.empty());
  EXPECT_NE(testing::PrintToString(lines).find("a scenario with a [mesh] has no neighbour lists"), std::string::npos)
      << testing::PrintToString(lines);
}

}  // namespace
}  // namespace boltzmann::dissipation_mistakes_test
