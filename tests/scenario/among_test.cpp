// Laws among several species: the same as a table of [[influences]] for each pair, mixed as Lorentz and Berthelot do.
#include <tests/scenario/mistakes.hpp>

#include <cmath>

namespace boltzmann::among_test {
namespace {

using test::Mistake;

std::string const gas =
    "[units]\nbase = \"reduced\"\n"                                                                         // 1 2
    "[box]\nlow = [0, 0]\nhigh = [20, 20]\nboundary = \"periodic\"\n"                                       // 3 to 6
    "[run]\nstep = 0.002\nsteps = 20\ncutoff = 3\n"                                                         // 7 to 10
    "[[ensembles]]\nname = \"a\"\nclass = \"Newton\"\nmass = 1\ntemperature = 1\n"                          // 11 to 15
    "load = { kind = \"block\", lattice = \"square\", spacing = 1.2, counts = [8, 4], origin = [0, 0] }\n"  // 16
    "[[ensembles]]\nname = \"b\"\nclass = \"Newton\"\nmass = 2\ntemperature = 1\n"                          // 17 to 21
    "load = { kind = \"block\", lattice = \"square\", spacing = 1.2, counts = [8, 4], origin = [0, 6] }\n"  // 22
    "[[ensembles]]\nname = \"c-d\"\nclass = \"Newton\"\nmass = 3\ntemperature = 1\n"                        // 23 to 27
    "load = { kind = \"block\", lattice = \"square\", spacing = 1.2, counts = [8, 4], origin = [0, 12] }\n";  // 28

std::string const among = "[[influences]]\nlaw = \"lennard-jones\"\namong = [\"a\", \"b\", \"c-d\"]\n";  // 29 to 31

std::vector<double> end_of(std::string const& text) {
  auto const run = parse_scenario(text, "test.toml");
  run->simulation->run(20);
  std::vector<double> rows;
  for (auto const& ensemble : run->ensembles)
    rows.insert(rows.end(), ensemble->row(0), ensemble->row(0) + ensemble->size() * ensemble->stride());
  return rows;
}

std::string pair(std::string const& on, double depth, double r0) {
  return "[[influences]]\nlaw = \"lennard-jones\"\n" + on + "\ndepth = " + std::to_string(depth) +
         "\nr0 = " + std::to_string(r0) + "\n";
}

TEST(Among, IsATableForEachPair) {
  std::string const each = gas + pair("on = \"a\"", 1, 1) + pair("on = \"b\"", 4, 1.25) +
                           pair("on = \"c-d\"", 2, 1.125) + pair("between = [\"a\", \"b\"]", 2, 1.125) +
                           pair("between = [\"a\", \"c-d\"]", 1.5, 1.0625) +
                           pair("between = [\"b\", \"c-d\"]", 3, 1.1875);
  // Means that are in the tables, the other way round, too, or are mixed.
  EXPECT_EQ(end_of(each), end_of(gas + among +
                                 "depth = { a = 1, b = 4, \"c-d\" = 2, \"a-c-d\" = 1.5, \"c-d-b\" = 3 }\n"
                                 "r0 = { a = 1, b = 1.25, \"c-d\" = 1.125 }\n"
                                 "mixing = { depth = \"geometric\", r0 = \"arithmetic\" }\n"));
  EXPECT_EQ(
      end_of(each),
      end_of(gas +
             "[[influences]]\nlaw = \"lennard-jones\"\namong = [\"a\", \"b\", \"c-d\"]\n"
             "depth = { a = 1, b = 4, \"c-d\" = 2, \"b-a\" = 2, \"a-c-d\" = 1.5, \"b-c-d\" = 3 }\n"
             "r0 = { a = 1, b = 1.25, \"c-d\" = 1.125, \"a-b\" = 1.125, \"a-c-d\" = 1.0625, \"b-c-d\" = 1.1875 }\n"));
}

TEST(Among, SharesWhatIsOneNumber) {
  EXPECT_EQ(end_of(gas + among + "depth = 1\nr0 = 1\n"), end_of(gas + among +
                                                                "depth = { a = 1, b = 1, \"c-d\" = 1 }\nr0 = 1\n"
                                                                "mixing = { depth = \"geometric\" }\n"));
}

TEST(Among, EachPairMayHaveItsCutoff) {
  auto const with = [](std::string const& on, double depth, double cutoff) {
    return pair(on, depth, 1) + "cutoff = " + std::to_string(cutoff) + "\n";
  };
  std::string const each = gas + with("on = \"a\"", 1, 2.5) + with("on = \"b\"", 2, 1.5) + with("on = \"c-d\"", 1, 2) +
                           with("between = [\"a\", \"b\"]", 1, 3) + with("between = [\"a\", \"c-d\"]", 1, 2.25) +
                           with("between = [\"b\", \"c-d\"]", 1, 1.75);
  std::string const depths = "depth = { a = 1, b = 2, \"c-d\" = 1, \"a-b\" = 1, \"a-c-d\" = 1, \"b-c-d\" = 1 }\n";
  EXPECT_EQ(end_of(each), end_of(gas + among + depths +
                                 "r0 = 1\ncutoff = { a = 2.5, b = 1.5, \"c-d\" = 2, \"a-b\" = 3, \"b-c-d\" = 1.75 }\n"
                                 "mixing.cutoff = \"arithmetic\"\n"));
  EXPECT_NE(end_of(each), end_of(gas + among + depths + "r0 = 1\ncutoff = 2.5\n"));
}

TEST(Among, TypedLawsHaveTablesToo) {
  std::string const typed =
      "[[influences]]\nenergy = \"depth*((r0/r)^12 - 2*(r0/r)^6)\"\namong = [\"a\", \"b\", \"c-d\"]\n";
  EXPECT_EQ(end_of(gas + typed + "parameters = { depth = 1, r0 = 1 }\n"),
            end_of(gas + typed +
                   "parameters = { depth = { a = 1, b = 1, \"c-d\" = 1 }, r0 = 1 }\n"
                   "mixing = { depth = \"arithmetic\" }\n"));
  EXPECT_NE(end_of(gas + typed + "parameters = { depth = 1, r0 = 1 }\n"),
            end_of(gas + typed +
                   "parameters = { depth = { a = 1, b = 2, \"c-d\" = 1 }, r0 = 1 }\n"
                   "mixing = { depth = \"arithmetic\" }\n"));
}

TEST(Among, MixesQuantitiesInAnyUnits) {
  std::string text = gas;
  text = test::replaced(text, "base = \"reduced\"",
                        "base = \"custom\"\nlength = \"1 angstrom\"\nmass = \"1 amu\"\ntime = \"1 ps\"");
  auto const with = [&](std::string const& depth) { return text + among + depth + "r0 = 1\n"; };
  EXPECT_EQ(
      end_of(with("depth = { a = \"1 meV\", b = \"0.004 eV\", \"c-d\" = \"1 meV\", \"a-b\" = \"2 meV\", "
                  "\"b-c-d\" = \"2 meV\", \"a-c-d\" = \"1 meV\" }\n")),
      end_of(with("depth = { a = \"1 meV\", b = \"4 meV\", \"c-d\" = \"1 meV\" }\nmixing.depth = \"geometric\"\n")));
}

class AmongMistakes : public testing::TestWithParam<Mistake> {};
TEST_P(AmongMistakes, AreOneLine) { test::expect_one_line(GetParam()); }

std::string const right = "depth = 1\nr0 = 1\n";
INSTANTIATE_TEST_SUITE_P(
    All, AmongMistakes,
    testing::Values(
        Mistake{"missing pair",
                gas + among + "depth = { a = 1, b = 2, \"c-d\" = 3, \"a-b\" = 1, \"a-c-d\" = 1 }\nr0 = 1\n",
                "32:9",
                {"depth: it has none for \"b-c-d\"", "mixing"}},
        Mistake{"missing species",
                gas + among + "depth = { a = 1, b = 2 }\nr0 = 1\nmixing.depth = \"geometric\"\n",
                "32:9",
                {"depth: it has none for 'c-d'"}},
        Mistake{
            "unknown species",
            gas + among + "depth = { a = 1, b = 2, \"c-e\" = 2, \"c-d\" = 2 }\nr0 = 1\nmixing.depth = \"geometric\"\n",
            "32:25",
            {"there are a, b, c-d", "did you mean 'c-d'?"}},
        Mistake{"unknown rule",
                gas + among + "depth = { a = 1, b = 2, \"c-d\" = 2 }\nr0 = 1\nmixing.depth = \"geometrical\"\n",
                "34:16",
                {"mixing.depth", "did you mean 'geometric'?"}},
        Mistake{"rule of what is one number",
                gas + among + right + "mixing.depth = \"geometric\"\n",
                "34:16",
                {"mixing.depth: there is no parameter depth that is a table by names"}},
        Mistake{
            "signs differ",
            gas + among + "depth = 1\nr0 = { a = 1, b = -1, \"c-d\" = 1, \"b-c-d\" = 1 }\nmixing.r0 = \"geometric\"\n",
            "33:19",
            {"r0: ", "have no geometric mean"}},
        Mistake{"also on", gas + among + right + "on = \"a\"\n", "34:1", {"on: 'among' already chooses the ensembles"}},
        Mistake{"unknown ensemble",
                gas + "[[influences]]\nlaw = \"lennard-jones\"\namong = [\"a\", \"bb\"]\n" + right,
                "31:15",
                {"there is no ensemble 'bb'", "did you mean 'b'?"}},
        Mistake{
            "mixing of nobody",
            gas + "[[influences]]\nlaw = \"lennard-jones\"\non = \"a\"\n" + right + "mixing.depth = \"geometric\"\n",
            "34:1",
            {"mixing: it belongs to 'among'"}},
        Mistake{"twice",
                gas + "[[influences]]\nlaw = \"lennard-jones\"\namong = [\"a\", \"a\"]\n" + right,
                "31:15",
                {"'a' twice"}},
        Mistake{"no list",
                gas + "[[influences]]\nlaw = \"lennard-jones\"\namong = \"a\"\n" + right,
                "31:9",
                {"the names of ensembles are needed"}},
        Mistake{"a mistake of each pair is told once",
                gas + among + "depth = 1\nr0 = 1\nrange = 2\n",
                "34:1",
                {"unknown key 'range'"}},
        Mistake{"out of range",
                gas + among + "depth = 1\nr0 = { a = 1, b = 0, \"c-d\" = 1 }\nmixing.r0 = \"arithmetic\"\n",
                "33:19",
                {"r0: 0 is out of range"}}),
    test::mistake_name);

}  // namespace
}  // namespace boltzmann::among_test
