// The schema of scenarios: a validator of JSON Schema takes what is shipped and finds what is wrong, and every key that
// a table tells of is one that the reader knows.
#include <boltzmann/core/error.hpp>
#include <boltzmann/scenario/scenario.hpp>
#include <boltzmann/scenario/schema.hpp>
#include <boltzmann/scenario/tables.hpp>
#include <tests/bzm/command.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <map>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace boltzmann::schema_test {
namespace {

TEST(Schema, TakesWhatIsShippedAndFindsWhatIsWrong) {
  test::Folder const folder;
  test::write_text(folder / "schema.json", scenario_schema());
  std::string command =
      "/usr/bin/python3 " BOLTZMANN_SOURCE "/tests/scenario/schema_check.py " + (folder / "schema.json").string();
  for (auto const& name : shipped_scenarios()) command += " " BOLTZMANN_SOURCE "/scenarios/" + name + ".toml";
  EXPECT_EQ(std::system(command.c_str()), 0) << "(python3-jsonschema is needed)";
}

/// What the reader says is allowed in a table with a key that there is not.
std::set<std::string> allowed_in(std::string const& scenario) {
  std::string told;
  most_names = 1000;
  try {
    parse_scenario(scenario, "table.toml");
  } catch (Error const& error) {
    told = error.what();
  }
  std::string const before = "unknown key 'nonsense' in ";
  auto const line = told.find(before);
  EXPECT_NE(line, std::string::npos) << told;
  if (line == std::string::npos) return {};
  auto const start = told.find("allowed are ", line) + 12,
             end = std::min(told.find(';', start), told.find('\n', start));
  std::istringstream words(told.substr(start, end - start));
  std::set<std::string> all;
  for (std::string word; words >> word;) {
    if (word.back() == ',') word.pop_back();
    all.insert(word);
  }
  return all;
}

TEST(Tables, TellOfTheKeysThatAreRead) {
  std::string const units = "[units]\nbase = \"reduced\"\n", box = "[box]\nlow = [0, 0]\nhigh = [9, 9]\n",
                    mirror = "boundary = \"mirror\"\n", run = "[run]\nstep = 0.1\nsteps = 1\n",
                    wrong = "nonsense = 1\n";
  auto const ensemble = [](std::string const& name) {
    return "[[ensembles]]\nname = \"a\"\nclass = \"" + name +
           "\"\nload = { kind = \"positions\", positions = [[1, 1], [2, 2]] }\n";
  };
  std::string const start = units + box + run, atoms = ensemble("Newton");
  std::map<std::string, std::vector<std::string>> const texts{
      {"box", {units + box + wrong + run + atoms}},
      {"units",
       {"[units]\nbase = \"custom\"\n" + wrong + box + run + atoms,
        "[units]\nbase = \"plasma\"\n" + wrong + box + run + atoms,
        "[units]\nbase = \"lennard-jones\"\n" + wrong + box + run + atoms}},
      {"box.regions",
       {units + box + "[[box.regions]]\nlow = [1, 1]\nhigh = [2, 2]\nside = \"keep-out\"\n" + wrong + run + atoms}},
      {"ensembles.set", {start + atoms + "[[ensembles.set]]\nparticles = \"all\"\n" + wrong}},
      {"sweep", {start + atoms + "[sweep]\nseeds = 2\n" + wrong}},
      {"sweep.pictures", {start + atoms + "[sweep]\nseeds = 2\n[[sweep.pictures]]\ny = \"step\"\n" + wrong}},
      {"box.walls", {units + box + mirror + "[[box.walls]]\naxis = \"x\"\nend = \"low\"\n" + wrong + run + atoms}},
      {"run", {start + wrong + atoms}},
      {"mesh",
       {start + "[mesh]\nlaw = \"coulomb\"\nk = 1\ncells = 8\n" + wrong + ensemble("Coulomb"),
        start + "[mesh]\nlaw = \"coulomb\"\nk = 1\naccuracy = 0.01\n" + wrong + ensemble("Coulomb"),
        start + "[mesh]\nlaw = \"gravity\"\nG = 1\ncells = 8\n" + wrong + ensemble("Kepler")}},
      {"multipole",
       {start + "[multipole]\nlaw = \"coulomb\"\nk = 1\n" + wrong + ensemble("Coulomb"),
        start + "[multipole]\nlaw = \"gravity\"\nG = 1\n" + wrong + ensemble("Kepler"),
        start + "[multipole]\nlaw = \"biot-savart\"\n" + wrong + ensemble("Vortex")}},
      {"cylinder_flow", {start + "[cylinder_flow]\nradius = 1\n" + wrong + ensemble("Tracer")}},
      {"dye", {start + ensemble("Tracer") + "[[dye]]\non = \"a\"\nfrom = [1, 1]\n" + wrong}},
      {"embedded_atoms",
       {start + "[embedded_atoms]\npotential = \"sutton-chen\"\n" + wrong + atoms,
        start + "[embedded_atoms]\npotential = \"gupta\"\n" + wrong + atoms,
        start + "[embedded_atoms]\npotential = \"formulas\"\n" + wrong + atoms,
        start + "[embedded_atoms]\npotential = \"file\"\n" + wrong + atoms}},
      {"stillinger_weber", {start + "[stillinger_weber]\n" + wrong + atoms}},
      {"smooth", {start + "[smooth]\n" + wrong + ensemble("Smooth")}},
      {"smooth.rezone", {start + "[[smooth.rezone]]\nevery = 1\n" + wrong + ensemble("Smooth")}},
      {"barostat",
       {start + atoms + "[barostat]\npressure = 1\ntemperature = 1\ncompressibility = 1\nrate = 1\n" + wrong}},
      {"events", {start + atoms + "[[events]]\nat = 1\nscale = 2\n" + wrong}},
      {"relaxation", {start + "[relaxation]\nevery = 1\n" + wrong + atoms}},
      {"minimise", {start + "[minimise]\n" + wrong + atoms}},
      {"equilibrate", {start + "[equilibrate]\ntemperature = 1\nrate = 1\ntime = 1\n" + wrong + atoms}},
      {"classes", {start + "[[classes]]\nname = \"A\"\nbase = \"Newton\"\n" + wrong + atoms}},
      {"classes.fields",
       {start + "[[classes]]\nname = \"A\"\nbase = \"Newton\"\n[[classes.fields]]\nname = \"b\"\nneighbours = 1\n" +
        wrong + atoms}},
      {"ensembles",
       {start + atoms + wrong, start + ensemble("Meso") + wrong, start + "[smooth]\n" + ensemble("Smooth") + wrong}},
      {"bodies",
       {start + atoms + "[[bodies]]\nshape = \"circle\"\nname = \"b\"\nradius = 1\n" + wrong,
        start + atoms + "[[bodies]]\nshape = \"ellipse\"\nname = \"b\"\nsemi_axes = [2, 1]\n" + wrong,
        start + atoms + "[[bodies]]\nshape = \"naca\"\nname = \"b\"\nnaca = \"0012\"\nchord = 1\n" + wrong,
        start + atoms + "[[bodies]]\nshape = \"polygon\"\nname = \"b\"\npoints = [[0, 0], [1, 0], [0, 1]]\n" + wrong,
        start + atoms + "[[bodies]]\nshape = \"file\"\nname = \"b\"\npath = \"none.txt\"\n" + wrong}},
      {"influences",
       {start + atoms + "[[influences]]\nlaw = \"lennard-jones\"\non = \"a\"\ndepth = 1\nr0 = 1\n" + wrong,
        start + atoms +
            "[[influences]]\nlaw = \"lennard-jones\"\non = \"a\"\ndepth = 1\nr0 = 1\nat_cutoff = \"switch\"\n" + wrong,
        start + atoms + "[[influences]]\nlaw = \"drag\"\non = \"a\"\nfriction = 1\n" + wrong}},
      {"rigid_bonds", {start + atoms + "[[rigid_bonds]]\non = \"a\"\npairs = [[0, 1]]\nlength = 1.4\n" + wrong}},
      {"remesh", {start + ensemble("Vortex") + "[[remesh]]\nevery = 1\nspacing = 1\n" + wrong}},
      {"outflow", {start + ensemble("Vortex") + "[[outflow]]\nfrom = [1, 0]\ndirection = [1, 0]\n" + wrong}},
      {"split_cores", {start + ensemble("Spreading") + "[[split_cores]]\nevery = 1\nabove = 1\n" + wrong}},
      {"output", {start + "[output]\n" + wrong + atoms}}};
  // Beside the keys: fields of the classes, parameters of the laws.
  std::set<std::string> const others{"mass",     "velocity",    "specific_energy", "range",    "depth",
                                     "r0",       "sigma",       "epsilon",         "friction", "temperature",
                                     "pressure", "sound_speed", "position"};
  for (auto const& table : scenario_tables()) {
    ASSERT_TRUE(texts.contains(table.name)) << table.name;
    std::set<std::string> read;
    for (auto const& text : texts.at(table.name)) read.merge(allowed_in(text));
    auto const keys = table.options->keys();
    for (auto const& key : keys) EXPECT_TRUE(read.contains(key)) << table.heading << " is told to have " << key;
    for (auto const& key : read)
      EXPECT_TRUE(std::find(keys.begin(), keys.end(), key) != keys.end() || others.contains(key))
          << table.heading << " has " << key << ", which its table does not tell";
  }
}

}  // namespace
}  // namespace boltzmann::schema_test
